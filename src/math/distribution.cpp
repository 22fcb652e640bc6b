// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/distribution.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

namespace lanthorn {
namespace {

double sum(std::span<const float> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// The distribution function at the right edge of each cell. From the last positive cell on it is exactly 1, whatever
/// the rounding, so that a search for u < 1 never ends in a cell of density 0. All 0 if the values are all 0.
void accumulate_cdf(std::span<const float> values, double total, std::span<float> cdf) {
  double running = 0;
  std::size_t last_positive = values.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    running += static_cast<double>(values[i]);
    cdf[i] = total > 0 ? static_cast<float>(running / total) : 0.0f;
    if (values[i] > 0) last_positive = i;
  }
  for (std::size_t i = last_positive; i < values.size(); ++i) cdf[i] = 1;
}

struct CellSample {
  std::size_t cell;
  float x;  ///< in [0,1), over all cells
};

CellSample invert_cdf(std::span<const float> cdf, float u) {
  assert(cdf.back() == 1 && u >= 0 && u < 1);
  const auto cell = static_cast<std::size_t>(std::upper_bound(cdf.begin(), cdf.end(), u) - cdf.begin());
  const float low = cell > 0 ? cdf[cell - 1] : 0.0f;
  const float within = (u - low) / (cdf[cell] - low);
  const float x = (static_cast<float>(cell) + within) / static_cast<float>(cdf.size());
  return {cell, std::min(one_minus_epsilon, x)};
}

std::size_t cell_of(float x, std::size_t count) {
  const auto cell = static_cast<std::size_t>(std::max(0.0f, x) * static_cast<float>(count));
  return std::min(cell, count - 1);
}

/// The distribution function at x in [0,1): the inverse of `invert_cdf`.
float value_of_cdf(std::span<const float> cdf, float x) {
  const std::size_t cell = cell_of(x, cdf.size());
  const float low = cell > 0 ? cdf[cell - 1] : 0.0f;
  const float within = x * static_cast<float>(cdf.size()) - static_cast<float>(cell);
  return std::clamp(lerp(within, low, cdf[cell]), 0.0f, one_minus_epsilon);
}

}  // namespace

PiecewiseConstant1d::PiecewiseConstant1d(std::span<const float> values)
    : values_(values.begin(), values.end()), cdf_(values.size()) {
  assert(!values.empty());
  const double total = sum(values);
  accumulate_cdf(values, total, cdf_);
  integral_ = static_cast<float>(total / static_cast<double>(values.size()));
}

std::optional<PiecewiseConstant1d::Sample> PiecewiseConstant1d::sample(float u) const {
  if (!(integral_ > 0)) return {};
  const CellSample s = invert_cdf(cdf_, u);
  return Sample{s.x, s.cell, values_[s.cell] / integral_};
}

float PiecewiseConstant1d::pdf(float x) const {
  return integral_ > 0 ? values_[cell_of(x, values_.size())] / integral_ : 0;
}

PiecewiseConstant2d::PiecewiseConstant2d(std::vector<float> values, std::size_t width, std::size_t height)
    : width_(width), height_(height), values_(std::move(values)), conditional_(values_.size()), marginal_(height) {
  assert(!values_.empty() && values_.size() == width * height);
  std::vector<float> row_sums(height);
  for (std::size_t y = 0; y < height; ++y) {
    const std::span<const float> row = std::span(values_).subspan(y * width, width);
    const double total = sum(row);
    accumulate_cdf(row, total, std::span(conditional_).subspan(y * width, width));
    row_sums[y] = static_cast<float>(total);
  }
  const double total = sum(row_sums);
  accumulate_cdf(row_sums, total, marginal_);
  integral_ = static_cast<float>(total / static_cast<double>(values_.size()));
}

std::optional<PiecewiseConstant2d::Sample> PiecewiseConstant2d::sample(const Vec2& u) const {
  if (!(integral_ > 0)) return {};
  const CellSample row = invert_cdf(marginal_, u.y);
  const CellSample column = invert_cdf(std::span(conditional_).subspan(row.cell * width_, width_), u.x);
  const std::size_t cell = row.cell * width_ + column.cell;
  return Sample{{column.x, row.x}, cell, values_[cell] / integral_};
}

Vec2 PiecewiseConstant2d::invert(const Vec2& at) const {
  const std::size_t row = cell_of(at.y, height_);
  return {value_of_cdf(std::span(conditional_).subspan(row * width_, width_), at.x), value_of_cdf(marginal_, at.y)};
}

std::size_t PiecewiseConstant2d::cell(const Vec2& at) const {
  return cell_of(at.y, height_) * width_ + cell_of(at.x, width_);
}

float PiecewiseConstant2d::pdf(const Vec2& at) const { return integral_ > 0 ? pdf_of_cell(cell(at)) : 0; }

AliasTable::AliasTable(std::span<const float> weights) : bins_(weights.size()) {
  const double total = sum(weights);
  empty_ = !(total > 0);
  if (empty_) return;
  std::vector<double> share(weights.size());  // probability times the number of bins
  std::vector<std::uint32_t> under, over;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double probability = static_cast<double>(weights[i]) / total;
    bins_[i].pmf = static_cast<float>(probability);
    share[i] = probability * static_cast<double>(weights.size());
    (share[i] < 1 ? under : over).push_back(static_cast<std::uint32_t>(i));
  }
  while (!under.empty() && !over.empty()) {
    const std::uint32_t poor = under.back(), rich = over.back();
    under.pop_back();
    bins_[poor].threshold = static_cast<float>(share[poor]);
    bins_[poor].alias = rich;
    share[rich] -= 1 - share[poor];
    if (share[rich] < 1) {
      over.pop_back();
      under.push_back(rich);
    }
  }
  // The remaining bins have share 1 up to rounding. No weight of 0 remains: shares have mean 1, so a share below 1
  // implies a richer bin to pair it with.
  for (const auto& rest : {under, over}) {
    for (const std::uint32_t i : rest) {
      bins_[i].threshold = 1;
      bins_[i].alias = i;
    }
  }
}

std::optional<AliasTable::Sample> AliasTable::sample(float u) const {
  if (empty_) return {};
  // In double precision: in single precision the remainder of u would keep too few bits for large tables.
  const double scaled = static_cast<double>(u) * static_cast<double>(bins_.size());
  const std::size_t bin = std::min(static_cast<std::size_t>(scaled), bins_.size() - 1);
  const auto rest = static_cast<float>(scaled - static_cast<double>(bin));
  const float threshold = bins_[bin].threshold;
  const bool own = rest < threshold;
  const std::size_t index = own ? bin : bins_[bin].alias;
  const float left = own ? rest / threshold : (rest - threshold) / (1 - threshold);
  return Sample{index, bins_[index].pmf, std::min(one_minus_epsilon, left)};
}

}  // namespace lanthorn
