// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace lanthorn {

/// Records that light paths leave in scattering media.
enum class MediumRecords : std::uint8_t {
  none,
  points,  ///< photons where they scatter
  beams,   ///< their flights up to the next surface, as far as they could scatter
  /// Their flights up to where they scatter. On grids, where the probability of passing a point is unknown, as `beams`.
  short_beams
};

/// Share of a pass's light paths whose flights are kept as beams. A beam is found all along its length, so that a
/// thousand beams do the work of hundreds of thousands of points; more beams cost more than they gain.
inline float share_of_beams(std::uint64_t light_paths) {
  constexpr double wanted = 1024;
  return light_paths == 0 ? 1.0f : static_cast<float>(std::min(1.0, wanted / static_cast<double>(light_paths)));
}

}  // namespace lanthorn
