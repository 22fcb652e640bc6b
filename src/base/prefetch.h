// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Functions that only prefetch must be inlined: GCC considers them to have no effect and removes their calls.

#include <cstddef>

namespace lanthorn {

/// Prefetches an object that will be read soon.
template <class T>
[[gnu::always_inline]] inline void prefetch(const T& item) {
  for (std::size_t line = 0; line < sizeof(T); line += 64)
    __builtin_prefetch(reinterpret_cast<const char*>(&item) + line);
}

/// Prefetches `bytes` (at least 1) that will be modified soon.
[[gnu::always_inline]] inline void prefetch_to_write(const void* from, std::size_t bytes) {
  const char* const first = static_cast<const char*>(from);
  for (std::size_t line = 0; line < bytes; line += 64) __builtin_prefetch(first + line, 1);
  __builtin_prefetch(first + bytes - 1, 1);
}

}  // namespace lanthorn
