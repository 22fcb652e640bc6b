// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "film/plane.h"

#include <cmath>

namespace lanthorn {

Plane box_filtered(const Plane& plane, int radius) {
  const int width = plane.width(), height = plane.height();
  Plane rows(width, height), out(width, height);
  plane.for_each_row([&](int y) {
    const float* in = plane.row(y);
    float* sums = rows.row(y);
    // Step by step, so that vector instructions sum up many pixels at a time.
    for (int step = -radius; step <= radius; ++step)
      for (int x = std::max(0, -step), end = std::min(width, width - step); x < end; ++x) sums[x] += in[x + step];
    for (int x = 0; x < width; ++x)
      sums[x] /= static_cast<float>(std::min(width, x + radius + 1) - std::max(0, x - radius));
  });
  plane.for_each_row([&](int y) {
    const int begin = std::max(0, y - radius), end = std::min(height, y + radius + 1);
    float* sums = out.row(y);
    for (int j = begin; j < end; ++j) {
      const float* in = rows.row(j);
      for (int x = 0; x < width; ++x) sums[x] += in[x];
    }
    const float share = 1 / static_cast<float>(end - begin);
    for (int x = 0; x < width; ++x) sums[x] *= share;
  });
  return out;
}

Plane halved(const Plane& plane) {
  const int width = (plane.width() + 1) / 2, height = (plane.height() + 1) / 2;
  Plane out(width, height);
  out.for_each_row([&](int y) {
    const float* upper = plane.row(2 * y);
    const float* lower = plane.row(std::min(2 * y + 1, plane.height() - 1));
    float* to = out.row(y);
    for (int x = 0; x < width; ++x) {
      const int left = 2 * x, right = std::min(left + 1, plane.width() - 1);
      to[x] = 0.25f * (upper[left] + upper[right] + lower[left] + lower[right]);
    }
  });
  return out;
}

namespace {

// Position of pixel x between the pixels of the picture of half the size.
struct Between {
  int low, high;
  float share;  // weight of `high`
  Between(int x, int count) {
    const float at = (static_cast<float>(x) - 0.5f) / 2;
    const float floor = std::floor(at);
    share = at - floor;
    low = std::clamp(static_cast<int>(floor), 0, count - 1);
    high = std::clamp(static_cast<int>(floor) + 1, 0, count - 1);
  }
};

}  // namespace

Plane doubled(const Plane& plane, int width, int height) {
  Plane out(width, height);
  out.for_each_row([&](int y) {
    const Between v(y, plane.height());
    const float *upper = plane.row(v.low), *lower = plane.row(v.high);
    float* to = out.row(y);
    for (int x = 0; x < width; ++x) {
      const Between u(x, plane.width());
      const auto across = [&](const float* row) { return row[u.low] + u.share * (row[u.high] - row[u.low]); };
      const float top = across(upper);
      to[x] = top + v.share * (across(lower) - top);
    }
  });
  return out;
}

}  // namespace lanthorn
