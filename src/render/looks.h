// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace lanthorn {

/// The first number of passes above `passes` after which the render looks at the picture's error. Each look comes after
/// an eighth more passes than the previous one; more frequent looks would seldom end a render earlier.
inline std::uint64_t next_look(std::uint64_t passes) {
  constexpr std::uint64_t first = 4, share = 8;
  std::uint64_t look = first;
  while (look <= passes) look += std::max<std::uint64_t>(1, look / share);
  return look;
}

inline bool is_look(std::uint64_t passes) { return passes > 0 && next_look(passes - 1) == passes; }

}  // namespace lanthorn
