// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "film/pixel_window.h"
#include "math/vec.h"
#include "photon/gather/disc_tests.h"

namespace lanthorn {

/// Tests each pixel several times: are the photons around the first merges of its eye paths uniformly distributed? The
/// photons of the first passes are counted. With too few photons the test is meaningless, because these may be bright
/// ones that have leaked in, for example under a door. The pixel then passes if the discs of the merges around it are
/// flat and unobstructed.
class UniformityTests {
  struct Counts {
    std::array<std::atomic<std::uint32_t>, disc_sectors> photons{};
    std::atomic<bool> is_obstructed{false};
  };

 public:
  static constexpr std::size_t bytes_per_pixel = sizeof(Counts) + sizeof(std::uint8_t);
  static constexpr std::uint32_t counted_passes = 16;  ///< whose photons are counted
  static constexpr unsigned tests = 5;
  static constexpr unsigned histories = 1u << tests;  ///< of a pixel: each test passed or failed
  /// The first pass whose radii depend on test `t`; the test counts the photons of all passes before it.
  static constexpr std::uint32_t pass_of_test(unsigned t) { return 1u << t; }

  explicit UniformityTests(const PixelWindow& window);

  /// Passes, from the first on, whose photons have been counted.
  std::uint32_t passes_counted() const { return passes_counted_; }
  bool are_done() const { return passes_counted_ == counted_passes; }
  /// Counts a photon of pass `passes_counted()` in the disc of a merge. `offset`: from its centre, in the frame of the
  /// surface; `u`: squared distance, divided by the squared distance of the edge. Threads may call it at the same time.
  void count(std::uint32_t pixel, const Vec3& offset, float u) {
    counts_[pixel].photons[sector_of(offset, u > 0.5f)].fetch_add(1, std::memory_order_relaxed);
  }
  /// True if merges of pass `passes_counted()` look for obstacles: only once, because the rays are expensive.
  bool seeks_obstacles() const { return passes_counted_ == 0; }
  /// Notes that the disc of a merge is not flat and unobstructed. Threads may call it at the same time.
  void note_obstacle(std::uint32_t pixel) { counts_[pixel].is_obstructed.store(true, std::memory_order_relaxed); }
  /// Call when all photons of the pass have been counted.
  void end_pass();

  /// Bit t: whether the pixel has passed test t; 0 for tests that have not been made yet.
  std::uint8_t passed(std::uint32_t pixel) const { return passed_[pixel]; }
  std::size_t pixel_count() const { return passed_.size(); }

  /// The results, one byte a pixel. Precondition: are_done().
  std::vector<std::byte> save() const;
  /// Takes what `save` returned. Throws Error if that is impossible.
  void load(std::span<const std::byte> results);

 private:
  bool test(int x, int y);
  bool is_clear_around(int x, int y) const;
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_, height_;
  std::vector<std::uint8_t> passed_;
  std::vector<Counts> counts_;  // by pixel; empty once the tests are done
  std::uint32_t passes_counted_ = 0;
};

}  // namespace lanthorn
