// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <gtest/gtest.h>
#include <immintrin.h>
#include <tbb/parallel_for.h>

#include <limits>
#include <thread>
#include <vector>

namespace lanthorn::parallel_test {
namespace {

constexpr unsigned flush_to_zero = _MM_FLUSH_ZERO_ON | 0x40;  // and denormals are flushed to zero

// Halves of the smallest normal number.
std::vector<float> denormal_numbers() {
  std::vector<float> numbers(1000, std::numeric_limits<float>::min());
  parallel_chunks(numbers.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
    volatile float half = 0.5f;
    numbers[i] *= half;
  });
  return numbers;
}

// Embree turns on flushing while it builds a scene, which may be the first work of a thread in TBB.
TEST(Parallel, LoopsKeepDenormalNumbersThoughTheFirstOfTheirThreadDidNot) {
  std::thread([] {
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | flush_to_zero);
    tbb::parallel_for(0, 1000, [](int) {});
    _mm_setcsr(before);
    EXPECT_EQ(denormal_numbers(), std::vector<float>(1000, std::numeric_limits<float>::min() / 2));
  }).join();
}

}  // namespace
}  // namespace lanthorn::parallel_test
