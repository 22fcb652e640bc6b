// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace lanthorn {

/// What light paths leave in media that scatter.
enum class MediumRecords : std::uint8_t {
  none,
  points,  ///< photons where they scatter
  beams,   ///< their flights, up to the next surface: of each, all of the medium that it could scatter in
  /// Their flights, up to where they scatter. On grids, where no probability of passing a point is known, as `beams`.
  short_beams
};

/// Share of a pass's light paths whose flights are kept as beams: a beam is found all along its way, so that a thousand
/// do what hundreds of thousands of points do, and more of them cost more than they bring.
inline float share_of_beams(std::uint64_t light_paths) {
  constexpr double wanted = 1024;
  return light_paths == 0 ? 1.0f : static_cast<float>(std::min(1.0, wanted / static_cast<double>(light_paths)));
}

}  // namespace lanthorn
