// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/bilinear_distribution.h"

#include <algorithm>
#include <cassert>

namespace lanthorn {
namespace {

// Integral over [0, t] of the linear function with value a at 0 and b at 1.
float integral_of_line(float a, float b, float t) { return t * (a + 0.5f * t * (b - a)); }

// Inverse of `integral_of_line`: the t in [0,1] at which it equals `area`.
float invert_line(float a, float b, float area) {
  const float root = a + safe_sqrt(a * a + 2 * (b - a) * area);
  return root > 0 ? std::clamp(2 * area / root, 0.0f, 1.0f) : 0.0f;
}

// The last i in [0, count - 2] with cdf(i) <= target.
template <class Cdf>
std::size_t find_interval(std::size_t count, float target, const Cdf& cdf) {
  std::size_t low = 0, high = count - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (cdf(middle) <= target ? low : high) = middle;
  }
  return low;
}

std::size_t node_below(float x, std::size_t count) {
  return std::min(static_cast<std::size_t>(x), count - 2);  // x in [0, count - 1]
}

}  // namespace

GridCell GridCell::find(const Vec2& at, std::size_t width, std::size_t height) {
  const float x = std::clamp(at.x, 0.0f, 1.0f) * static_cast<float>(width - 1);
  const float y = std::clamp(at.y, 0.0f, 1.0f) * static_cast<float>(height - 1);
  const std::size_t column = node_below(x, width), row = node_below(y, height);
  return {{column, row}, {x - static_cast<float>(column), y - static_cast<float>(row)}};
}

BilinearDistributions::BilinearDistributions(std::span<const float> values, std::size_t width, std::size_t height)
    : width_(width),
      height_(height),
      values_(values.begin(), values.end()),
      conditional_(values.size()),
      marginal_(values.size() / width) {
  assert(width >= 2 && height >= 2 && values.size() % (width * height) == 0);
  const double dx = 1.0 / static_cast<double>(width - 1), dy = 1.0 / static_cast<double>(height - 1);
  std::vector<double> conditional(width * height), marginal(height);
  for (std::size_t first = 0; first < values.size(); first += width * height) {
    const std::span<const float> grid = values.subspan(first, width * height);
    const auto at = [&](std::size_t i) { return static_cast<double>(grid[i]); };
    for (std::size_t i = 0; i < grid.size(); ++i)
      conditional[i] = i % width == 0 ? 0 : conditional[i - 1] + 0.5 * dx * (at(i - 1) + at(i));
    for (std::size_t y = 1; y < height; ++y)
      marginal[y] = marginal[y - 1] + 0.5 * dy * (conditional[y * width - 1] + conditional[(y + 1) * width - 1]);
    const double total = marginal[height - 1];
    assert(total > 0);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      values_[first + i] = static_cast<float>(at(i) / total);
      conditional_[first + i] = static_cast<float>(conditional[i] / total);
    }
    for (std::size_t y = 0; y < height; ++y) marginal_[first / width + y] = static_cast<float>(marginal[y] / total);
  }
}

float BilinearDistributions::mix(const std::vector<float>& table, std::size_t size, std::size_t at,
                                 const Blend& blend) {
  float sum = 0;
  for (std::size_t i = 0; i < blend.index.size(); ++i)
    if (blend.weight[i] > 0) sum += blend.weight[i] * table[blend.index[i] * size + at];
  return sum;
}

float BilinearDistributions::mix_rows(const std::vector<float>& table, std::size_t column, std::size_t row, float t,
                                      const Blend& blend) const {
  const std::size_t size = width_ * height_, at = row * width_ + column;
  return lerp(t, mix(table, size, at, blend), mix(table, size, at + width_, blend));
}

BilinearDistributions::Sample BilinearDistributions::sample(const Vec2& u, const Blend& blend) const {
  const auto rows = static_cast<float>(height_ - 1), columns = static_cast<float>(width_ - 1);
  const std::size_t row = find_interval(height_, u.y, [&](std::size_t y) { return below_row(y, blend); });
  const float low = row_integral(row, blend), high = row_integral(row + 1, blend);
  const float y = invert_line(low, high, rows * (u.y - below_row(row, blend)));

  const float target = u.x * lerp(y, low, high);
  const auto left = [&](std::size_t x) { return mix_rows(conditional_, x, row, y, blend); };
  const std::size_t column = find_interval(width_, target, left);
  const float a = mix_rows(values_, column, row, y, blend), b = mix_rows(values_, column + 1, row, y, blend);
  const float x = invert_line(a, b, columns * (target - left(column)));
  return {{(static_cast<float>(column) + x) / columns, (static_cast<float>(row) + y) / rows}, lerp(x, a, b)};
}

BilinearDistributions::Sample BilinearDistributions::invert(const Vec2& at, const Blend& blend) const {
  const auto rows = static_cast<float>(height_ - 1), columns = static_cast<float>(width_ - 1);
  const GridCell cell = GridCell::find(at, width_, height_);
  const auto [column, row] = cell.node;
  const float low = row_integral(row, blend), high = row_integral(row + 1, blend);
  const float a = mix_rows(values_, column, row, cell.t.y, blend);
  const float b = mix_rows(values_, column + 1, row, cell.t.y, blend);
  const float total = lerp(cell.t.y, low, high);
  const float left = mix_rows(conditional_, column, row, cell.t.y, blend) + integral_of_line(a, b, cell.t.x) / columns;
  const float below = below_row(row, blend) + integral_of_line(low, high, cell.t.y) / rows;
  return {{total > 0 ? std::clamp(left / total, 0.0f, 1.0f) : 0.0f, std::clamp(below, 0.0f, 1.0f)},
          lerp(cell.t.x, a, b)};
}

float BilinearDistributions::pdf(const Vec2& at, const Blend& blend) const {
  const GridCell cell = GridCell::find(at, width_, height_);
  const auto [column, row] = cell.node;
  return lerp(cell.t.x, mix_rows(values_, column, row, cell.t.y, blend),
              mix_rows(values_, column + 1, row, cell.t.y, blend));
}

}  // namespace lanthorn
