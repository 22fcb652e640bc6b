// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The pilot's measurements of all candidates of `auto`.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "camera/view.h"
#include "integrators/auto/moments.h"
#include "path/eye_pass.h"

namespace lanthorn {

/// Candidate numbers of light paths per pass, as multiples of the settings' number.
inline constexpr std::array light_path_choices{0.25f, 0.5f, 1.0f, 2.0f, 4.0f};

/// Sums over the eye paths of a block of pixels.
struct EffortBlock {
  struct Moments {
    double second = 0;                    ///< E[X²]
    double of_eye_path = 0;               ///< E[E[X | eye path]²]
    double square = 0;                    ///< E[X]² of the pixels: products of two passes
    double squares = 0, all_squares = 0;  ///< as of PathMoments::Estimate

    /// Second moment of paths that the candidate finds too rarely for the pilot to meet them. The factor 3: merges use
    /// densities of paths that are displaced within the radius, which makes `all_squares` somewhat larger than
    /// `squares` even if nothing is rare.
    double rare() const { return std::max(0.0, all_squares - 3 * squares); }
  };
  std::vector<Moments> moments;  ///< by candidate
  double light = 0, from_light_paths = 0, caustic = 0;
  double paths = 0, pixels = 0;
  EyeWork work, short_work;
};

/// The pilot's pixels, one in each cell, and blocks of cells.
class PilotGrid {
 public:
  static constexpr int most_cells = 96;      ///< along a side of the film
  static constexpr int cells_per_block = 4;  ///< along a side of a block

  explicit PilotGrid(const PixelWindow& window) : window_(window) {
    const auto along = [](int pixels) { return std::max(1, std::min(most_cells, pixels) / cells_per_block); };
    columns_ = along(window.width());
    rows_ = along(window.height());
  }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  std::size_t block_count() const { return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_); }
  PixelWindow cells() const { return {0, 0, columns_ * cells_per_block, rows_ * cells_per_block}; }
  /// The pixel in the middle of a cell.
  PixelPlace pixel_of(const PixelPlace& cell) const {
    const auto middle = [](int i, int pixels, int cells) { return (2 * i + 1) * pixels / (2 * cells); };
    const int x = middle(cell.x, window_.width(), columns_ * cells_per_block);
    const int y = middle(cell.y, window_.height(), rows_ * cells_per_block);
    return {window_.x0 + x, window_.y0 + y, static_cast<std::uint32_t>(y * window_.width() + x)};
  }

 private:
  PixelWindow window_;
  int columns_, rows_;
};

struct EffortMeasurement {
  explicit EffortMeasurement(const PixelWindow& window) : grid(window), blocks(grid.block_count()) {}

  PilotGrid grid;
  float scale = 1;                          ///< the settings' number of light paths over the pilot's
  std::vector<EffortCandidate> candidates;  ///< path tracing first
  std::vector<EffortBlock> blocks;
  double light_rays = 0, light_vertices = 0, light_paths = 0;
};

}  // namespace lanthorn
