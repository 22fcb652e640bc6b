// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace lanthorn {

/// A place in a grid of nodes whose outermost nodes lie on the edges of the unit square: the node below, and the weight
/// of the next one.
struct GridCell {
  std::array<std::size_t, 2> node{};  ///< column, row
  Vec2 t{0};

  /// `at` is clamped to the square. Width and height are at least 2.
  static GridCell find(const Vec2& at, std::size_t width, std::size_t height);
};

/// Weights of up to four functions of a family; >= 0, with sum 1.
struct Blend {
  std::array<std::uint32_t, 4> index{};
  std::array<float, 4> weight{1, 0, 0, 0};
};

/// A family of densities on the unit square, each bilinear between the nodes of a grid, and their weighted means. A
/// mean is sampled without rejection: the marginal in y is inverted, then the conditional in x, both in closed form
/// within a cell (Dupuy & Jakob 2018, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering",
/// §4.4).
class BilinearDistributions {
 public:
  struct Sample {
    Vec2 at{0};     ///< in [0,1]²
    float pdf = 0;  ///< per unit area of the square; 0 where the density is 0
  };

  BilinearDistributions() = default;
  /// `values`: one density after the other, row by row; finite, >= 0 and not all 0 in any density; width and height >=
  /// 2. Each density is normalised separately.
  BilinearDistributions(std::span<const float> values, std::size_t width, std::size_t height);

  /// `u` in [0,1)².
  Sample sample(const Vec2& u, const Blend& blend) const;
  /// The numbers from which `sample` draws `at`, as the result's `at`, and the density there. In a row whose density is
  /// 0, the numbers are arbitrary.
  Sample invert(const Vec2& at, const Blend& blend) const;
  float pdf(const Vec2& at, const Blend& blend) const;

 private:
  /// Marginal distribution function in y at the lower edge of a row.
  float below_row(std::size_t row, const Blend& blend) const { return mix(marginal_, height_, row, blend); }
  /// Integral over x along a row of nodes.
  float row_integral(std::size_t row, const Blend& blend) const {
    return mix(conditional_, width_ * height_, (row + 1) * width_ - 1, blend);
  }
  /// Blended entry of a table that holds `size` entries for each density.
  static float mix(const std::vector<float>& table, std::size_t size, std::size_t at, const Blend& blend);
  /// Blended entry of a table of nodes, interpolated at height `t` between two rows.
  float mix_rows(const std::vector<float>& table, std::size_t column, std::size_t row, float t,
                 const Blend& blend) const;

  std::size_t width_ = 0, height_ = 0;
  std::vector<float> values_;       // per unit area
  std::vector<float> conditional_;  // integral over x up to each node, with y that of its row
  std::vector<float> marginal_;     // by row: integral over all of x and over y up to the row
};

}  // namespace lanthorn
