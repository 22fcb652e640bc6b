// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/vcm/uniformity_tests.h"

#include <algorithm>
#include <numeric>

#include "lanthorn/error.h"

namespace lanthorn {

UniformityTests::UniformityTests(const PixelWindow& window)
    : width_(window.width()), height_(window.height()), passed_(index(0, height_)), counts_(passed_.size()) {}

void UniformityTests::end_pass() {
  ++passes_counted_;
  for (unsigned t = 0; t < tests; ++t) {
    if (passes_counted_ != pass_of_test(t)) continue;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x)
        if (test(x, y)) passed_[index(x, y)] |= static_cast<std::uint8_t>(1u << t);
  }
  if (are_done()) counts_ = std::vector<Counts>();
}

// Returns whether the pixel passes. If it fails, its disc will be smaller, and the counts start again at zero.
bool UniformityTests::test(int x, int y) {
  constexpr std::uint32_t fewest = 2 * disc_sectors;
  auto& photons = counts_[index(x, y)].photons;
  SectorCounts counts;
  std::copy(photons.begin(), photons.end(), counts.begin());
  const std::uint32_t total = std::accumulate(counts.begin(), counts.end(), std::uint32_t{0});
  if (total < fewest) return is_clear_around(x, y);
  if (!rejects_uniformity(counts, static_cast<float>(total))) return true;
  std::fill(photons.begin(), photons.end(), 0);
  return false;
}

// The eye paths of a pixel may miss obstacles near its surface, so the obstacles that neighbouring pixels found count,
// too.
bool UniformityTests::is_clear_around(int x, int y) const {
  for (int j = std::max(0, y - 1); j <= std::min(height_ - 1, y + 1); ++j)
    for (int i = std::max(0, x - 1); i <= std::min(width_ - 1, x + 1); ++i)
      if (counts_[index(i, j)].is_obstructed) return false;
  return true;
}

std::vector<std::byte> UniformityTests::save() const {
  const auto bytes = std::as_bytes(std::span(passed_));
  return {bytes.begin(), bytes.end()};
}

void UniformityTests::load(std::span<const std::byte> results) {
  if (results.size() != passed_.size()) throw Error("damaged: its radii do not match the picture's pixels");
  std::transform(results.begin(), results.end(), passed_.begin(), std::to_integer<std::uint8_t>);
  if (std::any_of(passed_.begin(), passed_.end(), [](std::uint8_t p) { return p >= histories; }))
    throw Error("damaged: its radii are not those of this render");
  passes_counted_ = counted_passes;
  counts_ = std::vector<Counts>();
}

}  // namespace lanthorn
