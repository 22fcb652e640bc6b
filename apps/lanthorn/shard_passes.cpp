// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "shards.h"

namespace lanthorn::program {

std::vector<PassRange> split_passes(std::uint64_t passes, std::uint64_t count) {
  std::vector<PassRange> ranges;
  ranges.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) ranges.push_back({passes * i / count, passes * (i + 1) / count});
  return ranges;
}

PassCheck check_passes(const PassRange& expected, const std::vector<PassRange>& passes) {
  std::vector<PassRange> sorted = passes;
  std::sort(sorted.begin(), sorted.end(), [](const PassRange& a, const PassRange& b) { return a.begin < b.begin; });
  PassCheck check;
  std::uint64_t end = expected.begin;  // of the ranges visited so far
  for (const PassRange& range : sorted) {
    if (range.begin > end && end < expected.end) check.missing.push_back({end, std::min(range.begin, expected.end)});
    if (range.begin < end && range.begin >= expected.begin)
      check.doubled.push_back({range.begin, std::min(range.end, end)});
    end = std::max(end, range.end);
  }
  if (end < expected.end) check.missing.push_back({end, expected.end});
  return check;
}

std::string ranges_text(const std::vector<PassRange>& ranges) {
  std::vector<std::string> texts;
  texts.reserve(ranges.size());
  for (const PassRange& range : ranges) texts.push_back(fmt::format("{}:{}", range.begin, range.end));
  return fmt::format("{}", fmt::join(texts, ", "));
}

}  // namespace lanthorn::program
