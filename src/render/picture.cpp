// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "film/error_estimate.h"
#include "lanthorn/image.h"
#include "render/colour_balance.h"

namespace lanthorn {

namespace {

using Passes = std::vector<PassRange>;

std::uint64_t count(const Passes& passes) {
  std::uint64_t sum = 0;
  for (const PassRange& range : passes) sum += range.end - range.begin;
  return sum;
}

std::uint64_t passes_or_one(const Passes& passes) { return std::max<std::uint64_t>(1, count(passes)); }

// The passes that belong to this half.
Passes passes_in(const Passes& passes, FilmHalf half) {
  Passes own;
  for (const PassRange& range : passes)
    for (std::uint64_t pass = range.begin; pass < range.end; ++pass)
      if (half_of_pass(pass) == half) own.push_back({pass, pass + 1});
  return own;
}

// `color`: of all passes.
MeasuredError measure_error(const RenderState& state, const Film& film, const Passes& passes, Image color) {
  PictureHalves pictures{.picture = std::move(color)};
  for (const FilmHalf half : {FilmHalf::first, FilmHalf::second}) {
    const auto h = static_cast<std::size_t>(half);
    const Passes own = passes_in(passes, half);
    pictures.passes[h] = count(own);
    pictures.halves[h] = film.resolve_half(half, pictures.passes[h], colour_balance(state, own));
  }
  MeasuredError measured = lanthorn::measure_error(pictures);
  if (nlohmann::json::parse(state.settings).contains("bias_not_measured"))
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

}  // namespace

MeasuredPicture measured_picture_of(const RenderState& state, const Film& film, const Passes& passes) {
  Image image = film.resolve(passes_or_one(passes), colour_balance(state, passes));
  MeasuredError error = measure_error(state, film, passes, *select_layer(image, "color"));
  image = with_layers(image, prefixed("error.", std::move(error.standard_error)));
  if (film.contents().bias) image = with_layers(image, prefixed("bias.", std::move(error.bias)));
  return {std::move(image), std::move(error.estimate)};
}

MeasuredPicture measured_picture_of(const RenderState& state) {
  MeasuredPicture measured = measured_picture_of(state, state.film, state.passes);
  measured.picture.window = window_of(state);
  return measured;
}

Image picture_of(const RenderState& state) { return measured_picture_of(state).picture; }

Image picture_without_error(const RenderState& state) {
  Image image = state.film.resolve(passes_or_one(state.passes), colour_balance(state));
  image.window = window_of(state);
  return image;
}

Image with_noise(const RenderState& state, const Image& picture) {
  const Passes first = passes_in(state.passes, FilmHalf::first);
  Image noise = noise_of(picture, state.film.resolve_first_half(count(first), colour_balance(state, first)));
  return with_layers(picture, prefixed("noise.", std::move(noise)));
}

ErrorEstimate estimate_error(const RenderState& state) {
  Image color = state.film.resolve_color(passes_or_one(state.passes), colour_balance(state));
  return measure_error(state, state.film, state.passes, std::move(color)).estimate;
}

}  // namespace lanthorn
