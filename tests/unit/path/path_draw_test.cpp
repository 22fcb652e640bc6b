// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/path_draw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace lanthorn {
namespace {

std::vector<float> begins(std::uint64_t seed, std::uint32_t first, std::uint32_t count, float length) {
  std::vector<float> result;
  for (std::uint32_t pass = first; pass < first + count; ++pass) {
    const ShutterPart part = shutter_part(seed, pass);
    EXPECT_EQ(part.length, length);
    result.push_back(part.begin);
  }
  std::sort(result.begin(), result.end());
  return result;
}

TEST(ShutterPart, SixteenPassesCoverTheIntervalAndTheNextInQuarters) {
  for (const std::uint64_t seed : {0, 7}) {
    const std::vector<float> first = begins(seed, 0, 16, 1.0f / 16), next = begins(seed, 16, 64, 1.0f / 64);
    for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(first[i], static_cast<float>(i) / 16);
    for (std::size_t i = 0; i < 64; ++i) EXPECT_EQ(next[i], static_cast<float>(i) / 64);
  }
}

TEST(ShutterPart, FewPassesAreSpreadOverTheInterval) {
  const std::vector<float> first = begins(3, 0, 4, 1.0f / 16);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(static_cast<std::size_t>(4 * first[i]), i);
}

}  // namespace
}  // namespace lanthorn
