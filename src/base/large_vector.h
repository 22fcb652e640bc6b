// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace lanthorn {

/// Allocates large blocks in 2 MiB pages where the system has them: fewer page faults and TLB misses.
template <class T>
struct LargePageAllocator {
  using value_type = T;  // NOLINT(readability-identifier-naming): the standard's name
  static constexpr std::size_t page = std::size_t{2} << 20;

  LargePageAllocator() = default;
  template <class U>
  LargePageAllocator(const LargePageAllocator<U>&) {}

  T* allocate(std::size_t count) {
    const std::size_t alignment = alignment_of(count);
    void* const memory = ::operator new(count * sizeof(T), std::align_val_t(alignment));
#ifdef __linux__
    if (alignment == page) madvise(memory, count * sizeof(T), MADV_HUGEPAGE);  // a hint that the system may ignore
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) { ::operator delete(memory, std::align_val_t(alignment_of(count))); }

  friend bool operator==(const LargePageAllocator&, const LargePageAllocator&) { return true; }

 private:
  static std::size_t alignment_of(std::size_t count) { return count * sizeof(T) >= 2 * page ? page : alignof(T); }
};

/// For arrays of many megabytes.
template <class T>
using LargeVector = std::vector<T, LargePageAllocator<T>>;

}  // namespace lanthorn
