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

/// Place in a grid of nodes whose outermost lie on the edges of the unit square: the node below, the share of the next.
struct GridCell {
  std::array<std::size_t, 2> node{};  ///< column, row
  Vec2 t{0};

  /// `at` is clamped to the square. Width and height are at least 2.
  static GridCell find(const Vec2& at, std::size_t width, std::size_t height);
};

/// A weighted mean of up to four functions of a family; the weights are >= 0 and add to 1.
struct Blend {
  std::array<std::uint32_t, 4> index{};
  std::array<float, 4> weight{1, 0, 0, 0};
};

/// A family of densities on the unit square, each bilinear between the nodes of a grid, and any mean of them. A mean is
/// sampled without rejection: the marginal in y is inverted, and then the conditional in x, both in closed form within
/// a cell (Dupuy & Jakob 2018, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", §4.4).
class BilinearDistributions {
 public:
  struct Sample {
    Vec2 at{0};     ///< in [0,1]²
    float pdf = 0;  ///< per unit area of the square; 0 where nothing can be drawn
  };

  BilinearDistributions() = default;
  /// One density after the other, row by row; finite, >= 0 and not all 0 in any of them; width and height >= 2. They
  /// are normalised one by one.
  BilinearDistributions(std::span<const float> values, std::size_t width, std::size_t height);

  /// `u` in [0,1)².
  Sample sample(const Vec2& u, const Blend& blend) const;
  /// The numbers from which `sample` draws `at`, as its `at`, and the density there. Where the density of a whole row
  /// is 0, they are arbitrary.
  Sample invert(const Vec2& at, const Blend& blend) const;
  float pdf(const Vec2& at, const Blend& blend) const;

 private:
  /// Up to a row's lower edge.
  float below_row(std::size_t row, const Blend& blend) const { return mix(marginal_, height_, row, blend); }
  /// Over a whole row, of nodes.
  float row_integral(std::size_t row, const Blend& blend) const {
    return mix(conditional_, width_ * height_, (row + 1) * width_ - 1, blend);
  }
  /// The blend of an entry of tables that hold so many for each density.
  static float mix(const std::vector<float>& table, std::size_t size, std::size_t at, const Blend& blend);
  /// Of a table by node, on the line at height `t` between two rows.
  float mix_rows(const std::vector<float>& table, std::size_t column, std::size_t row, float t,
                 const Blend& blend) const;

  std::size_t width_ = 0, height_ = 0;
  std::vector<float> values_;       // per unit area
  std::vector<float> conditional_;  // integral over x up to each node, with y that of its row
  std::vector<float> marginal_;     // by row: integral over all of x and y up to it
};

}  // namespace lanthorn
