// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/error_estimate.h"

namespace lanthorn {

/// Parts of a pass, for timing all methods in the same terms.
enum class Phase : std::uint8_t { photons, build, eye };
inline constexpr std::size_t phase_count = 3;
const char* phase_name(Phase phase);

/// Paths from one end, and how much of them the limit of scattering events cut off.
struct PathEnds {
  static constexpr double unit = 1 << 20;  ///< of `cut`: whole numbers, so that sums do not depend on their order

  std::uint64_t paths = 0;
  std::uint64_t cut = 0;  ///< throughput that reached the limit, relative to that of the path's start, times `unit`

  /// The share of all throughput that reached the limit. The share of light that is missing may be less, where surfaces
  /// would have absorbed the rest, and more, where only long paths find light.
  double share() const { return paths > 0 ? static_cast<double>(cut) / unit / static_cast<double>(paths) : 0; }
  PathEnds& operator+=(const PathEnds& o) {
    paths += o.paths;
    cut += o.cut;
    return *this;
  }
};

/// Numbers of rays traced, and of the paths that they belong to.
struct RayCounts {
  std::uint64_t walk = 0;    ///< nearest-hit rays
  std::uint64_t shadow = 0;  ///< occlusion rays
  std::uint64_t spared = 0;  ///< occlusion rays that shadow photons made unnecessary
  PathEnds eye, light;       ///< paths from the camera and from lights; none of methods that choose lengths of paths

  RayCounts& operator+=(const RayCounts& o) {
    walk += o.walk;
    shadow += o.shadow;
    spared += o.spared;
    eye += o.eye;
    light += o.light;
    return *this;
  }
};

/// Time of a part of the frames that a pass is, for methods that draw by OpenGL.
struct StageSeconds {
  std::string name;
  double seconds = 0;
};

/// Sums over the passes of one call of `Session::render`.
struct RenderStatistics {
  std::uint64_t passes = 0;
  std::uint64_t passes_elsewhere = 0;               ///< of these: not gathered yet from the processes of a team
  double seconds = 0;                               ///< wall clock, including the preparation
  double prepare_seconds = 0;                       ///< pilot passes
  std::array<double, phase_count> phase_seconds{};  ///< by Phase
  double first_pass_seconds = 0;                    ///< from the call to the end of the first pass
  RayCounts rays;
  std::uint64_t light_paths = 0, photons_stored = 0;
  std::size_t photon_map_bytes = 0;  ///< largest
  std::uint64_t cache_records = 0, cache_misses = 0;
  std::vector<StageSeconds> stages;               ///< of frames; on the GPU, then on the CPU
  std::vector<std::uint64_t> photons_per_bounce;  ///< of frames; [i]: photons after i + 1 bounces
  float radius = 0;                               ///< of the last pass, metres; 0 if the method has none
  float volume_radius = 0;                        ///< the same in media; of several estimators the widest
  /// Of the picture after `error_passes` passes; none before the first look. Looks cost at most a hundredth of the
  /// time, unless `StopRule::noise` asks for them.
  std::optional<ErrorEstimate> error{};
  std::uint64_t error_passes = 0;
  bool out_of_memory = false;  ///< a pass needed more memory than there is, and was given up
};

}  // namespace lanthorn
