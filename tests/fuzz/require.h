// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <cstdlib>

namespace lanthorn::fuzz {

/// Fails as a crash for the fuzzer.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "inconsistent: %s\n", what);
  std::abort();
}

}  // namespace lanthorn::fuzz
