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

/// Memory in pages of 2 MiB where there is much of it and the system has them: it is given out, and addresses are
/// looked up, by the page.
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
    if (alignment == page) madvise(memory, count * sizeof(T), MADV_HUGEPAGE);  // a wish: it may be refused
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
