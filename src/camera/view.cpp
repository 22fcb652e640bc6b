// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "camera/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/memory.h"
#include "film/film.h"
#include "lanthorn/error.h"

namespace lanthorn {

namespace {

constexpr int largest_side = 1 << 16;
constexpr std::uint64_t most_pixels = std::uint64_t{1} << 31;  // pixel indices have 32 bits

// The memory that a large picture would need, as text; empty for small pictures.
std::string too_large_for_memory(int width, int height) {
  if (width < largest_side && height < largest_side) return {};
  const double bytes =
      static_cast<double>(width) * height * static_cast<double>(Film::stride({}) * sizeof(std::int64_t));
  return fmt::format("; its sums would take {} of memory", memory_text(bytes));
}

std::array<int, 2> choose_resolution(const description::Film& film, const ViewOptions& options) {
  if (!options.resolution) return {film.width, film.height};
  const int width = options.resolution->front();
  int height = options.resolution->back();
  if (height == 0 && film.width > 0) {
    const double exact = static_cast<double>(width) * film.height / film.width;
    height = static_cast<int>(std::lround(std::clamp(exact, 1.0, 1e9)));
  }
  if (width < 1 || height < 1 || width > largest_side || height > largest_side)
    throw Error(fmt::format("--resolution {}x{}: expected WIDTHxHEIGHT, each from 1 to {}{}", width, height,
                            largest_side, too_large_for_memory(width, height)));
  return {width, height};
}

PixelWindow choose_window(const description::Film& film, const std::array<int, 2>& resolution,
                          const ViewOptions& options) {
  const auto& [width, height] = resolution;
  if (options.crop) {
    const auto& [x0, y0, x1, y1] = *options.crop;
    if (x0 < 0 || y0 < 0 || x1 > width || y1 > height || x0 >= x1 || y0 >= y1)
      throw Error(fmt::format("--crop {},{},{},{}: expected x0,y0,x1,y1 with 0 <= x0 < x1 <= {} and 0 <= y0 < y1 <= {}",
                              x0, y0, x1, y1, width, height));
    return {x0, y0, x1, y1};
  }
  const auto pixel = [](float fraction, int size) {
    return std::clamp(static_cast<int>(std::ceil(fraction * static_cast<float>(size))), 0, size);
  };
  const PixelWindow window{pixel(film.crop[0], width), pixel(film.crop[2], height), pixel(film.crop[1], width),
                           pixel(film.crop[3], height)};
  if (window.width() <= 0 || window.height() <= 0)
    throw Error(fmt::format("{}the crop window of the scene's film contains no pixel of {} x {}",
                            options.resolution ? fmt::format("--resolution {}x{}: ", width, height) : "", width,
                            height));
  return window;
}

// How far the pixel filter extends beyond the centre of a pixel at the film's edge.
Vec2 filter_margin(const description::Filter& filter) {
  return {std::max(0.0f, filter.radius.x), std::max(0.0f, filter.radius.y)};
}

}  // namespace

PixelWindow View::filter_reach() const {
  const Vec2 beyond = filter.radius() - Vec2(0.5f);  // beyond a pixel's edges
  const auto below = [](int edge, float reach) {
    return std::max(0, static_cast<int>(std::floor(static_cast<float>(edge) - reach)));
  };
  const auto above = [](int edge, float reach, int size) {
    return std::min(size, static_cast<int>(std::floor(static_cast<float>(edge) + reach)) + 1);
  };
  return {below(window.x0, beyond.x), below(window.y0, beyond.y), above(window.x1, beyond.x, camera.width()),
          above(window.y1, beyond.y, camera.height())};
}

View make_view(const ViewDescription& description, const ViewOptions& options) {
  const description::Film& film = description.film;
  const std::array<int, 2> resolution = choose_resolution(film, options);
  View view{Camera(description.camera, resolution[0], resolution[1], filter_margin(description.filter)),
            medium_id(description.camera.medium),
            {},
            choose_window(film, resolution, options),
            Filter(filter_shape(description.filter)),
            {},
            film.imaging_ratio};
  view.window = view.crop.grown(std::max(0, options.margin), resolution[0], resolution[1]);
  if (film.white_balance) view.sensor.balance = white_balance(*film.white_balance, film.color_space);
  view.sensor.largest_component = film.largest_component;
  if (options.clamp && !(*options.clamp > 0 && std::isfinite(*options.clamp)))
    throw Error(fmt::format("--clamp {}: expected a number above 0", *options.clamp));
  view.sensor.path_limit = options.clamp;
  const auto pixels =
      static_cast<std::uint64_t>(view.window.width()) * static_cast<std::uint64_t>(view.window.height());
  if (pixels >= most_pixels)
    throw Error(fmt::format("{} x {} pixels are more than {}, the limit of a picture; render parts with --crop",
                            view.window.width(), view.window.height(), most_pixels - 1));
  return view;
}

ViewOptions scaled(ViewOptions options, const description::Film& film, double share) {
  const std::array<int, 2> full = options.resolution.value_or(std::array<int, 2>{film.width, film.height});
  const auto scale = [share](int x) { return static_cast<int>(std::lround(share * x)); };
  options.resolution = {std::max(1, scale(full[0])), std::max(1, scale(full[1]))};
  if (options.crop) {
    const auto& [x0, y0, x1, y1] = *options.crop;
    const auto& [width, height] = *options.resolution;
    const int left = std::min(scale(x0), width - 1), top = std::min(scale(y0), height - 1);
    options.crop = {left, top, std::clamp(scale(x1), left + 1, width), std::clamp(scale(y1), top + 1, height)};
  }
  return options;
}

}  // namespace lanthorn
