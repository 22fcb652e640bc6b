// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "film/error_estimate.h"
#include "lanthorn/image.h"
#include "path/path_draw.h"
#include "spectrum/cie.h"

namespace lanthorn {

namespace {

using Passes = std::vector<PassRange>;

std::uint64_t passes_or_one(const Passes& passes) { return std::max<std::uint64_t>(1, pass_count(passes)); }

// The passes that belong to this half.
Passes passes_in(const Passes& passes, FilmHalf half) {
  Passes own;
  for (const PassRange& range : passes)
    for (std::uint64_t pass = range.begin; pass < range.end; ++pass)
      if (half_of_pass(pass) == half) own.push_back({pass, pass + 1});
  return own;
}

// The part of a picture of the film that is shown.
Image shown(const ShownPart& part, Image image) {
  if (image.pixels.empty()) return image;
  Image out(part.width, part.height, std::move(image.channels));
  out.window = part.window;
  if (out.pixels.size() == image.pixels.size()) {
    out.pixels = std::move(image.pixels);
    return out;
  }
  const std::size_t row = static_cast<std::size_t>(part.width) * out.channel_count();
  const std::size_t all = static_cast<std::size_t>(image.width) * out.channel_count();
  for (int y = 0; y < part.height; ++y) {
    const std::size_t from =
        static_cast<std::size_t>(part.y + y) * all + static_cast<std::size_t>(part.x) * out.channel_count();
    std::copy_n(image.pixels.begin() + static_cast<std::ptrdiff_t>(from), row,
                out.pixels.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * row));
  }
  return out;
}

// `color`: of all passes and of the same part.
MeasuredError measure_error(const RenderState& state, const Film& film, const ShownPart& part, const Passes& passes,
                            Image color) {
  PictureHalves pictures{.picture = std::move(color)};
  for (const FilmHalf half : {FilmHalf::first, FilmHalf::second}) {
    const auto h = static_cast<std::size_t>(half);
    const Passes own = passes_in(passes, half);
    pictures.passes[h] = pass_count(own);
    HalfPicture resolved = film.resolve_half(half, pictures.passes[h], colour_balance(state, own));
    pictures.halves[h] = {shown(part, std::move(resolved.color)), shown(part, std::move(resolved.bias))};
  }
  MeasuredError measured = lanthorn::measure_error(pictures);
  if (state.record.bias_not_measured)
    measured.estimate.doubt = fmt::format("the bias of {} is not measured", state.integrator);
  return measured;
}

// The picture with `prefix` before the name of each channel.
Image prefixed(const std::string& prefix, Image image) {
  for (std::string& channel : image.channels) channel.insert(0, prefix);
  return image;
}

// For each layer but `samples`, the first half of the passes minus the picture; for `samples`, that half's share.
Image noise_of(const Image& picture, Image first_half) {
  const std::size_t channels = first_half.channel_count(), samples = channels - 1;
  std::vector<std::size_t> from;
  for (const std::string& channel : first_half.channels) from.push_back(*picture.find_channel(channel));
  for (std::size_t i = 0; i * channels < first_half.pixels.size(); ++i) {
    float* const noise = &first_half.pixels[i * channels];
    const float* const all = &picture.pixels[i * picture.channel_count()];
    for (std::size_t c = 0; c < samples; ++c) noise[c] -= all[from[c]];
    noise[samples] = all[from[samples]] != 0 ? noise[samples] / all[from[samples]] : 0.0f;
  }
  first_half.channels[samples] = "share";
  return first_half;
}

// The first half's bias minus the picture's, in layers `noise.bias`.
Image noise_of_bias(const Image& picture, Image first_half) {
  const std::size_t channels = first_half.channel_count();
  for (std::size_t c = 0; c < channels; ++c) {
    const std::size_t all = *picture.find_channel(first_half.channels[c]);
    for (std::size_t i = 0; i * channels < first_half.pixels.size(); ++i)
      first_half.pixels[i * channels + c] -= picture.pixels[i * picture.channel_count() + all];
  }
  return prefixed("noise.", std::move(first_half));
}

// The film's colour of the illuminant D65, estimated with four wavelengths. Its mean over wavelengths is (1, 1, 1).
Rgb white_of(const Wavelengths& w) {
  Spectrum light;
  for (int i = 0; i < 4; ++i) light[i] = illuminant_d65.at(w.lambda[static_cast<unsigned>(i)]);
  return w.to_rgb(light);
}

MeasuredPicture measured_part(const RenderState& state, const Film& film, const ShownPart& part, const Passes& passes) {
  Image image = shown(part, film.resolve(passes_or_one(passes), colour_balance(state, passes)));
  MeasuredError error = measure_error(state, film, part, passes, *select_layer(image, "color"));
  image = with_layers(image, prefixed("error.", std::move(error.standard_error)));
  if (film.contents().bias) image = with_layers(image, prefixed("bias.", std::move(error.bias)));
  return {std::move(image), std::move(error.estimate)};
}

// `picture`: of the same part.
Image part_with_noise(const RenderState& state, const ShownPart& part, const Image& picture) {
  const Passes first = passes_in(state.passes, FilmHalf::first);
  const Rgb balance = colour_balance(state, first);
  Image half = shown(part, state.film.resolve_first_half(pass_count(first), balance));
  Image noisy = with_layers(picture, prefixed("noise.", noise_of(picture, std::move(half))));
  if (!picture.find_channel("bias.R")) return noisy;
  const HalfPicture own = state.film.resolve_half(FilmHalf::first, pass_count(first), balance);
  return with_layers(noisy, noise_of_bias(picture, prefixed("bias.", smoothed_bias(shown(part, own.bias)))));
}

}  // namespace

MeasuredPicture measured_picture_of(const RenderState& state, const Film& film, const Passes& passes) {
  return measured_part(state, film, shown_part(state), passes);
}

MeasuredPicture measured_picture_of(const RenderState& state) {
  return measured_picture_of(state, state.film, state.passes);
}

Image picture_of(const RenderState& state) { return measured_picture_of(state).picture; }

Image picture_without_error(const RenderState& state) {
  return shown(shown_part(state), state.film.resolve(passes_or_one(state.passes), colour_balance(state)));
}

Image with_noise(const RenderState& state, const Image& picture) {
  return part_with_noise(state, shown_part(state), picture);
}

std::optional<Image> with_margin(const RenderState& state) {
  const ShownPart inner = shown_part(state);
  if (!inner.has_margin(state.film)) return std::nullopt;
  ShownPart all{0, 0, state.film.width(), state.film.height(), inner.window};
  all.window.x -= inner.x;
  all.window.y -= inner.y;
  return part_with_noise(state, all, measured_part(state, state.film, all, state.passes).picture);
}

ErrorEstimate estimate_error(const RenderState& state) {
  const ShownPart part = shown_part(state);
  Image color = shown(part, state.film.resolve_color(passes_or_one(state.passes), colour_balance(state)));
  return measure_error(state, state.film, part, state.passes, std::move(color)).estimate;
}

Rgb colour_balance(const RenderState& state) { return colour_balance(state, state.passes); }

Rgb colour_balance(const RenderState& state, std::span<const PassRange> passes) {
  constexpr std::uint64_t many = 1 << 20;  // as good as all
  const RenderIdentity& render = state.record.identity;
  const std::uint64_t count = pass_count(passes);
  if (!render.wavelength_sets || count == 0 || count > many) return {1, 1, 1};
  const std::uint32_t sets = *render.wavelength_sets;
  std::array<double, 3> sum{};
  for (const PassRange& range : passes)
    for (std::uint64_t set = range.begin * sets; set < range.end * sets; ++set) {
      const PlaceInHalf place = place_in_half(static_cast<std::uint32_t>(set), sets);
      const Rgb white = white_of(wavelengths_of_pass(render.seed, ColorMode::spectral, place, render.heroes_of_paths));
      sum[0] += static_cast<double>(white.r);
      sum[1] += static_cast<double>(white.g);
      sum[2] += static_cast<double>(white.b);
    }
  const auto all = static_cast<double>(count * sets);
  const auto factor = [&](double channel) {
    constexpr double largest = 100;  // bound for wavelengths that all miss a channel
    return static_cast<float>(channel * largest > all ? all / channel : 1.0);
  };
  return {factor(sum[0]), factor(sum[1]), factor(sum[2])};
}

}  // namespace lanthorn
