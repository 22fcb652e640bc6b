// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The number of samples of each technique of vertex connection and merging, by place on the film.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "camera/view.h"
#include "lanthorn/effort_report.h"
#include "math/vec.h"

namespace lanthorn {

/// The effort of every pass: the same for the whole film, or one for each block of pixels.
class Effort {
 public:
  Effort() = default;
  /// Uses all techniques everywhere.
  explicit Effort(std::uint64_t light_paths) : light_paths_(light_paths) {}
  /// One effort per block; blocks divide the window evenly, row by row.
  Effort(std::uint64_t light_paths, const PixelWindow& window, int columns, std::vector<PlaceEffort> blocks)
      : light_paths_(light_paths),
        window_(window),
        columns_(columns),
        rows_(static_cast<int>(blocks.size()) / columns),
        blocks_(std::move(blocks)) {}

  std::uint64_t light_paths() const { return light_paths_; }  ///< of a pass
  PlaceEffort at(const Vec2& raster) const { return blocks_.empty() ? PlaceEffort{} : blocks_[block_of(raster)]; }
  /// Whether light paths are connected to the lens anywhere.
  bool sees() const {
    return blocks_.empty() || std::any_of(blocks_.begin(), blocks_.end(), [](const PlaceEffort& p) { return p.sees; });
  }
  /// Whether photons are merged on surfaces anywhere.
  bool merges() const {
    return blocks_.empty() ||
           std::any_of(blocks_.begin(), blocks_.end(), [](const PlaceEffort& p) { return p.merges; });
  }
  /// Precondition: there are blocks.
  std::size_t block_of(const Vec2& raster) const {
    const auto index = [](float x, int pixels, int blocks) {
      return std::clamp(static_cast<int>(x * static_cast<float>(blocks) / static_cast<float>(pixels)), 0, blocks - 1);
    };
    const Vec2 at = raster - window_.corner();
    const int row = index(at.y, window_.height(), rows_), column = index(at.x, window_.width(), columns_);
    const int block = row * columns_ + column;
    return static_cast<std::size_t>(block);
  }

 private:
  std::uint64_t light_paths_ = 0;
  PixelWindow window_{};
  int columns_ = 0, rows_ = 0;
  std::vector<PlaceEffort> blocks_;
};

}  // namespace lanthorn
