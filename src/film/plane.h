// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/parallel.h"

namespace lanthorn {

/// A value for each pixel, rows from the top.
template <class T>
class PixelPlane {
 public:
  PixelPlane() = default;
  PixelPlane(int width, int height, const T& value = T(0))
      : width_(width),
        height_(height),
        values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value) {}

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }
  /// The place of a pixel in row-major order.
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  T* row(int y) { return values_.data() + index(0, y); }
  const T* row(int y) const { return values_.data() + index(0, y); }
  T& operator[](std::size_t i) { return values_[i]; }
  const T& operator[](std::size_t i) const { return values_[i]; }

  /// Calls `body(y)` for all rows, on any thread.
  template <class Body>
  void for_each_row(Body&& body) const {
    constexpr std::size_t rows_per_task = 16;
    parallel_chunks(static_cast<std::size_t>(height_), rows_per_task,
                    [&](std::size_t, std::size_t begin, std::size_t end) {
                      for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
                    });
  }
  /// Calls `body(i)` for the pixels of a row, from the left.
  template <class Body>
  void for_each_in_row(int y, Body&& body) const {
    for (std::size_t i = index(0, y), end = index(0, y + 1); i < end; ++i) body(i);
  }
  /// The same for all pixels; rows on any thread.
  template <class Body>
  void for_each_pixel(Body&& body) const {
    for_each_row([&](int y) { for_each_in_row(y, body); });
  }
  /// Sets each pixel to `value(i)`.
  template <class Value>
  void fill(Value&& value) {
    for_each_pixel([&](std::size_t i) { values_[i] = static_cast<T>(value(i)); });
  }
  template <class Value>
  static PixelPlane of(int width, int height, Value&& value) {
    PixelPlane plane(width, height);
    plane.fill(value);
    return plane;
  }

 private:
  int width_ = 0, height_ = 0;
  std::vector<T> values_;
};
using Plane = PixelPlane<float>;

/// Means over squares of (2 radius + 1)² pixels, clipped to the picture.
Plane box_filtered(const Plane& plane, int radius);
/// Half the width and height, rounded up: means of 2 x 2 pixels.
Plane halved(const Plane& plane);
/// Bilinear upsampling from half the size to this one.
Plane doubled(const Plane& plane, int width, int height);

}  // namespace lanthorn
