// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/parallel.h"

namespace lanthorn::denoising {

/// A number for each pixel, rows from the top.
class Plane {
 public:
  Plane() = default;
  Plane(int width, int height, float value = 0)
      : width_(width),
        height_(height),
        values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value) {}

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }
  float* row(int y) { return values_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  const float* row(int y) const { return values_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  float& operator[](std::size_t i) { return values_[i]; }
  float operator[](std::size_t i) const { return values_[i]; }

  /// Calls `body(y)` for all rows, on any thread.
  template <class Body>
  void for_each_row(Body&& body) const {
    constexpr std::size_t rows_per_task = 16;
    parallel_chunks(static_cast<std::size_t>(height_), rows_per_task,
                    [&](std::size_t, std::size_t begin, std::size_t end) {
                      for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
                    });
  }
  /// Sets each pixel to `value(i)`.
  template <class Value>
  void fill(Value&& value) {
    for_each_row([&](int y) {
      const auto w = static_cast<std::size_t>(width_);
      for (std::size_t i = static_cast<std::size_t>(y) * w, end = i + w; i < end; ++i) values_[i] = value(i);
    });
  }
  template <class Value>
  static Plane of(int width, int height, Value&& value) {
    Plane plane(width, height);
    plane.fill(value);
    return plane;
  }

 private:
  int width_ = 0, height_ = 0;
  std::vector<float> values_;
};

/// Means over squares of (2 radius + 1)² pixels, clipped to the picture.
Plane box_filtered(const Plane& plane, int radius);
/// Half the width and height, rounded up: means of 2 x 2 pixels.
Plane halved(const Plane& plane);
/// Bilinear upsampling from half the size to this one.
Plane doubled(const Plane& plane, int width, int height);

}  // namespace lanthorn::denoising
