// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "math/vec.h"

namespace lanthorn {

/// Density on any window of [0,1)², proportional to a function that is constant in each cell of a grid. Sampled from a
/// table of the function's integrals over all rectangles that start at the origin (Bitterli, Novák & Jarosz 2015,
/// "Portal-Masked Environment Map Sampling", §4.2).
class WindowedPiecewiseConstant2d {
 public:
  struct Window {
    Vec2 min{0}, max{1};
  };
  struct Sample {
    Vec2 at{0};
    float pdf = 0;  ///< per unit area of the square
  };

  WindowedPiecewiseConstant2d() = default;
  /// Row by row; values must be finite and >= 0; width * height of them.
  WindowedPiecewiseConstant2d(std::span<const float> values, std::size_t width, std::size_t height);

  /// Returns nullopt if the function is 0 in the whole window.
  std::optional<Sample> sample(const Vec2& u, const Window& window) const;
  /// `at` must lie in the window.
  float pdf(const Vec2& at, const Window& window) const;

 private:
  struct Inverse {
    double x = 0;  ///< in cells
    std::size_t cell = 0;
  };

  /// Integral of the function over the rectangle from the origin to (x, y), in cells.
  double integral(double x, double y) const;
  double integral(const Window& window) const;
  template <class Integral>
  static Inverse invert(double low, double high, std::size_t cells, double target, const Integral& integral);
  float value(std::size_t column, std::size_t row) const { return values_[row * width_ + column]; }
  double at_corner(std::size_t column, std::size_t row) const { return sums_[row * (width_ + 1) + column]; }

  std::size_t width_ = 0, height_ = 0;
  std::vector<float> values_;
  std::vector<double> sums_;  // at the corners of the cells
};

}  // namespace lanthorn
