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

// Those of the passes that are in this half.
Passes passes_in(const Passes& passes, FilmHalf half) {
  Passes own;
  for (const PassRange& range : passes)
    for (std::uint64_t begin = range.begin, end = begin; begin < range.end; begin = end) {
      end = std::min(range.end, end_of_net(begin));
      if (half_of_pass(begin) == half) own.push_back({begin, end});
    }
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

// Adds layers of colours.
void add_layers(Image& image, const std::vector<std::pair<std::string, const Image*>>& layers) {
  const std::size_t before = image.channel_count(), after = before + 3 * layers.size();
  std::vector<float> pixels(image.pixels.size() / before * after);
  for (std::size_t i = 0; i * before < image.pixels.size(); ++i) {
    float* out = std::copy_n(&image.pixels[i * before], before, &pixels[i * after]);
    for (const auto& [name, layer] : layers) out = std::copy_n(&layer->pixels[i * 3], 3, out);
  }
  for (const auto& [name, layer] : layers)
    for (const char* component : {".R", ".G", ".B"}) image.channels.push_back(name + component);
  image.pixels = std::move(pixels);
}

}  // namespace

MeasuredPicture measured_picture_of(const RenderState& state, const Film& film, const Passes& passes) {
  Image image = film.resolve(passes_or_one(passes), colour_balance(state, passes));
  MeasuredError error = measure_error(state, film, passes, *select_layer(image, "color"));
  std::vector<std::pair<std::string, const Image*>> layers{{"error", &error.standard_error}};
  if (film.contents().bias) layers.emplace_back("bias", &error.bias);
  add_layers(image, layers);
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

ErrorEstimate estimate_error(const RenderState& state) {
  Image color = state.film.resolve_color(passes_or_one(state.passes), colour_balance(state));
  return measure_error(state, state.film, state.passes, std::move(color)).estimate;
}

}  // namespace lanthorn
