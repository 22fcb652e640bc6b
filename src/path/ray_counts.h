// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lanthorn {

/// Rays traced; kept per chunk of work and summed, so that counting costs nothing.
struct RayCounts {
  std::uint64_t walk = 0;    ///< nearest-hit rays
  std::uint64_t shadow = 0;  ///< occlusion rays
  std::uint64_t spared = 0;  ///< occlusion rays that shadow photons have made needless

  RayCounts& operator+=(const RayCounts& o) {
    walk += o.walk;
    shadow += o.shadow;
    spared += o.spared;
    return *this;
  }
};

}  // namespace lanthorn
