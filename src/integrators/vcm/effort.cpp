// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/vcm/effort.h"

#include <algorithm>
#include <utility>

namespace lanthorn {

Effort::Effort(std::uint64_t light_paths, const PixelWindow& window, int columns, std::vector<PlaceEffort> blocks)
    : light_paths_(light_paths),
      window_(window),
      columns_(columns),
      rows_(static_cast<int>(blocks.size()) / columns),
      blocks_(std::move(blocks)) {}

std::size_t Effort::block_of(const Vec2& raster) const {
  const auto index = [](float x, int pixels, int blocks) {
    return std::clamp(static_cast<int>(x * static_cast<float>(blocks) / static_cast<float>(pixels)), 0, blocks - 1);
  };
  const Vec2 at = raster - window_.corner();
  const int row = index(at.y, window_.height(), rows_), column = index(at.x, window_.width(), columns_);
  const int block = row * columns_ + column;
  return static_cast<std::size_t>(block);
}

}  // namespace lanthorn
