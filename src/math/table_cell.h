// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

namespace lanthorn {

/// The nodes of a table between which a value lies: `low` and the next one. `fraction` in [0,1]: position between them.
struct TableCell {
  std::size_t low = 0;
  float fraction = 0;
};

/// The cell of x in [0, 1] in a table of at least two equidistant nodes, of which the first is at 0 and the last at 1.
inline TableCell table_cell(float x, std::size_t nodes) {
  const float scaled = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(nodes - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(scaled), nodes - 2);
  return {low, scaled - static_cast<float>(low)};
}

}  // namespace lanthorn
