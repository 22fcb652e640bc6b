// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "math/vec.h"

namespace lanthorn {

/// Bounding box of the points, computed in parallel; empty if there are none.
inline Bounds bounds_of(std::span<const Point> points) {
  constexpr std::size_t chunk = 1u << 15;
  std::vector<Bounds> parts((points.size() + chunk - 1) / chunk);
  parallel_chunks(points.size(), chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    Bounds b;
    for (std::size_t i = begin; i < end; ++i) b.extend(points[i]);
    parts[c] = b;
  });
  Bounds all;
  for (const Bounds& b : parts) all.extend(b);
  return all;
}

}  // namespace lanthorn
