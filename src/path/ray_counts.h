// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace lanthorn {

/// Numbers of rays traced. Each chunk of work has its own, so that counting needs no synchronisation.
struct RayCounts {
  std::uint64_t walk = 0;    ///< nearest-hit rays
  std::uint64_t shadow = 0;  ///< occlusion rays
  std::uint64_t spared = 0;  ///< occlusion rays that shadow photons have saved

  RayCounts& operator+=(const RayCounts& o) {
    walk += o.walk;
    shadow += o.shadow;
    spared += o.spared;
    return *this;
  }
};

/// A sum to which several threads add.
class SharedRayCounts {
 public:
  void add(const RayCounts& counts) {
    walk_ += counts.walk;
    shadow_ += counts.shadow;
    spared_ += counts.spared;
  }
  RayCounts sum() const { return {walk_, shadow_, spared_}; }

 private:
  std::atomic<std::uint64_t> walk_{0}, shadow_{0}, spared_{0};
};

}  // namespace lanthorn
