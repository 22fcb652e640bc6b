// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/vcm/effort.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace lanthorn {

Effort::Effort(std::uint64_t light_paths, const PixelWindow& window, int columns, std::vector<PlaceEffort> blocks,
               EffortReport report)
    : light_paths_(light_paths),
      window_(window),
      columns_(columns),
      rows_(static_cast<int>(blocks.size()) / columns),
      blocks_(std::move(blocks)),
      report_(report) {}

std::size_t Effort::block_of(const Vec2& raster) const {
  const auto index = [](float x, int pixels, int blocks) {
    return std::clamp(static_cast<int>(x * static_cast<float>(blocks) / static_cast<float>(pixels)), 0, blocks - 1);
  };
  const Vec2 at = raster - window_.corner();
  const int row = index(at.y, window_.height(), rows_), column = index(at.x, window_.width(), columns_);
  const int block = row * columns_ + column;
  return static_cast<std::size_t>(block);
}

std::string Effort::describe() const {
  if (light_paths_ == 0) return "no light needs light paths: path tracing";
  const auto percent = [](double share) { return fmt::format("{:.0f} %", 100 * share); };
  return fmt::format(
      "light paths find {} of the light: {:.2g} of them a pixel, merged in {} and connected in {} of the picture",
      percent(report_.light_by_light_paths), report_.light_paths_per_pixel, percent(report_.merged_part),
      percent(report_.connected_part));
}

}  // namespace lanthorn
