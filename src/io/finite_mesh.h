// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Vertices of meshes whose numbers are infinite or NaN, in files that programs wrote.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "math/vec.h"

namespace lanthorn {

template <class Vector>
bool is_finite(const Vector& v) {
  for (int k = 0; k < Vector::length(); ++k)
    if (!std::isfinite(v[k])) return false;
  return true;
}

/// Removes the cells (triangles, quads, lines) with a corner that is not finite. Returns the number removed.
template <class Cell>
std::size_t erase_not_finite(std::vector<Cell>& cells, const std::vector<Point>& positions) {
  return std::erase_if(cells, [&](const Cell& cell) {
    return std::any_of(cell.begin(), cell.end(), [&](auto corner) { return !is_finite(positions[corner]); });
  });
}

/// Replaces values that are not finite. Returns the number replaced.
template <class Vector>
std::size_t replace_not_finite(std::vector<Vector>& values, const Vector& by) {
  std::size_t replaced = 0;
  for (Vector& v : values) {
    if (is_finite(v)) continue;
    v = by;
    ++replaced;
  }
  return replaced;
}

}  // namespace lanthorn
