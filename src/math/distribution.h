// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Tabulated distributions over [0,1) and [0,1)², and over indices. Sums are taken in double precision.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "math/vec.h"

namespace lanthorn {

/// Density on [0,1) that is constant in each of n equal cells.
class PiecewiseConstant1d {
 public:
  struct Sample {
    float x = 0;  ///< in [0,1)
    std::size_t cell = 0;
    float pdf = 0;  ///< per unit of x
  };

  PiecewiseConstant1d() = default;
  /// Values must be finite and >= 0; at least one value.
  explicit PiecewiseConstant1d(std::span<const float> values);

  /// Returns nullopt if all values are 0.
  std::optional<Sample> sample(float u) const;
  float pdf(float x) const;
  /// Mean of the values = integral over [0,1).
  float integral() const { return integral_; }
  std::size_t size() const { return values_.size(); }

 private:
  std::vector<float> values_;
  std::vector<float> cdf_;  ///< at the right edge of each cell; the last is 1
  float integral_ = 0;
};

/// Density on [0,1)² that is constant in each cell of a grid: a marginal over rows (y) and one conditional density per
/// row.
class PiecewiseConstant2d {
 public:
  struct Sample {
    Vec2 at{0};            ///< in [0,1)²
    std::size_t cell = 0;  ///< row * width + column
    float pdf = 0;         ///< per unit area of the square
  };

  PiecewiseConstant2d() = default;
  /// Row by row; values must be finite and >= 0; width * height of them.
  PiecewiseConstant2d(std::vector<float> values, std::size_t width, std::size_t height);

  /// u.x picks the column, u.y the row. Returns nullopt if all values are 0.
  std::optional<Sample> sample(const Vec2& u) const;
  /// Inverse of `sample`: the u in [0,1)² that maps to this point.
  Vec2 invert(const Vec2& at) const;
  float pdf(const Vec2& at) const;
  float pdf_of_cell(std::size_t cell) const { return integral_ > 0 ? values_[cell] / integral_ : 0; }
  std::size_t cell(const Vec2& at) const;
  float integral() const { return integral_; }

 private:
  std::size_t width_ = 0, height_ = 0;
  std::vector<float> values_;
  std::vector<float> conditional_;  ///< per row, the distribution function at the right edge of each cell
  std::vector<float> marginal_;     ///< at the lower edge of each row
  float integral_ = 0;
};

/// Discrete distribution with constant-time sampling (Walker 1974; Vose 1991).
class AliasTable {
 public:
  struct Sample {
    std::size_t index = 0;
    float pmf = 0;
    float u = 0;  ///< remainder of the random number: uniform in [0,1), independent of index
  };

  AliasTable() = default;
  /// Weights must be finite and >= 0.
  explicit AliasTable(std::span<const float> weights);

  /// Returns nullopt if all weights are 0.
  std::optional<Sample> sample(float u) const;
  float pmf(std::size_t index) const { return bins_[index].pmf; }
  std::size_t size() const { return bins_.size(); }

 private:
  struct Bin {
    float threshold = 0;  ///< below it the bin's own index is drawn, above it the alias
    float pmf = 0;
    std::uint32_t alias = 0;
  };
  std::vector<Bin> bins_;
  bool empty_ = true;
};

}  // namespace lanthorn
