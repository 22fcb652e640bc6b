// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/windowed_distribution.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lanthorn {
namespace {

std::size_t cell_of(double x, std::size_t cells) { return std::min(static_cast<std::size_t>(x), cells - 1); }

}  // namespace

WindowedPiecewiseConstant2d::WindowedPiecewiseConstant2d(std::span<const float> values, std::size_t width,
                                                         std::size_t height)
    : width_(width), height_(height), values_(values.begin(), values.end()), sums_((width + 1) * (height + 1)) {
  assert(!values.empty() && values.size() == width * height);
  for (std::size_t y = 0; y < height; ++y) {
    double row = 0;
    for (std::size_t x = 0; x < width; ++x) {
      row += static_cast<double>(value(x, y));
      sums_[(y + 1) * (width + 1) + x + 1] = at_corner(x + 1, y) + row;
    }
  }
}

// Bilinear between the corners of a cell, because the function is constant in the cell.
double WindowedPiecewiseConstant2d::integral(double x, double y) const {
  const std::size_t column = cell_of(x, width_), row = cell_of(y, height_);
  const double fx = x - static_cast<double>(column), fy = y - static_cast<double>(row);
  return (1 - fy) * ((1 - fx) * at_corner(column, row) + fx * at_corner(column + 1, row)) +
         fy * ((1 - fx) * at_corner(column, row + 1) + fx * at_corner(column + 1, row + 1));
}

double WindowedPiecewiseConstant2d::integral(const Window& window) const {
  const auto w = static_cast<double>(width_), h = static_cast<double>(height_);
  const double x0 = w * static_cast<double>(window.min.x), x1 = w * static_cast<double>(window.max.x);
  const double y0 = h * static_cast<double>(window.min.y), y1 = h * static_cast<double>(window.max.y);
  return integral(x1, y1) - integral(x0, y1) - integral(x1, y0) + integral(x0, y0);
}

/// Inverse of `integral`, which rises from 0 at `low` and is linear between whole numbers: the place where it reaches
/// `target`.
template <class Integral>
WindowedPiecewiseConstant2d::Inverse WindowedPiecewiseConstant2d::invert(double low, double high, std::size_t cells,
                                                                         double target, const Integral& integral) {
  std::size_t first = cell_of(low, cells), last = cell_of(high, cells);
  while (first < last) {
    const std::size_t middle = (first + last) / 2;
    if (integral(static_cast<double>(middle + 1)) > target)
      last = middle;
    else
      first = middle + 1;
  }
  const double left = std::fmax(low, static_cast<double>(first)),
               right = std::fmin(high, static_cast<double>(first + 1));
  const double before = integral(left), within = integral(right) - before;
  const double x = within > 0 ? left + (right - left) * (target - before) / within : left;
  return {std::clamp(x, left, std::fmax(left, right)), first};
}

std::optional<WindowedPiecewiseConstant2d::Sample> WindowedPiecewiseConstant2d::sample(const Vec2& u,
                                                                                       const Window& window) const {
  const double total = integral(window);
  if (!(total > 0)) return {};
  const auto w = static_cast<double>(width_), h = static_cast<double>(height_);
  const double x0 = w * static_cast<double>(window.min.x), x1 = w * static_cast<double>(window.max.x);
  const double y0 = h * static_cast<double>(window.min.y), y1 = h * static_cast<double>(window.max.y);
  const auto to_column = [&](double x) {
    return (integral(x, y1) - integral(x, y0)) - (integral(x0, y1) - integral(x0, y0));
  };
  const Inverse column = invert(x0, x1, width_, static_cast<double>(u.x) * total, to_column);
  const auto left = static_cast<double>(column.cell);
  const auto in_column = [&](double y) {
    return (integral(left + 1, y) - integral(left, y)) - (integral(left + 1, y0) - integral(left, y0));
  };
  const double column_total = in_column(y1);
  if (!(column_total > 0)) return {};
  const Inverse row = invert(y0, y1, height_, static_cast<double>(u.y) * column_total, in_column);
  const float f = value(column.cell, row.cell);
  if (!(f > 0)) return {};
  return Sample{{static_cast<float>(column.x / w), static_cast<float>(row.x / h)},
                static_cast<float>(static_cast<double>(f) * w * h / total)};
}

float WindowedPiecewiseConstant2d::pdf(const Vec2& at, const Window& window) const {
  const double total = integral(window);
  if (!(total > 0)) return 0;
  const auto w = static_cast<double>(width_), h = static_cast<double>(height_);
  const float f =
      value(cell_of(w * static_cast<double>(at.x), width_), cell_of(h * static_cast<double>(at.y), height_));
  return static_cast<float>(static_cast<double>(f) * w * h / total);
}

}  // namespace lanthorn
