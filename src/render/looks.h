// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace lanthorn {

/// A number of passes after which the render looks at the picture's error.
struct Look {
  std::uint64_t passes = 4;
  unsigned number = 0;  ///< counts from the first look

  /// Comes after an eighth more passes; more frequent looks would seldom end a render earlier.
  Look next() const {
    constexpr std::uint64_t share = 8;
    return {passes + std::max<std::uint64_t>(1, passes / share), number + 1};
  }
};

/// The first look after more than `passes` passes.
inline Look next_look(std::uint64_t passes) {
  Look look;
  while (look.passes <= passes) look = look.next();
  return look;
}

/// Whether the render looks after this number of passes: `is_costly` looks are every third one, so each comes after
/// about 1.4 times as many passes as the one before. It depends on the passes alone, so that resumed renders end after
/// the same pass.
inline bool is_look(std::uint64_t passes, bool is_costly) {
  if (passes == 0) return false;
  const Look look = next_look(passes - 1);
  return look.passes == passes && (!is_costly || look.number % 3 == 0);
}

}  // namespace lanthorn
