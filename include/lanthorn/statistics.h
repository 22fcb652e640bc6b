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

/// Parts of a pass; the same for all methods, so that their timings compare.
enum class Phase : std::uint8_t { photons, build, eye };
inline constexpr std::size_t phase_count = 3;
const char* phase_name(Phase phase);

/// Paths that start at one end (eye or light), and how much of them the limit of scattering events cut off.
struct PathEnds {
  static constexpr double unit = 1 << 20;  ///< of `cut`, a whole number so that sums do not depend on their order

  std::uint64_t paths = 0;
  std::uint64_t cut = 0;  ///< throughput that reached the limit, relative to that at the path's start, times `unit`

  /// The share of all throughput that reached the limit. The share of light that is missing may be smaller, if surfaces
  /// would have absorbed the rest, or larger, if only long paths reach a light.
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
  PathEnds eye, light;       ///< paths from the camera and from lights; 0 if the method chooses lengths

  RayCounts& operator+=(const RayCounts& o) {
    walk += o.walk;
    shadow += o.shadow;
    spared += o.spared;
    eye += o.eye;
    light += o.light;
    return *this;
  }
};

/// Time of one stage of the frames that make up a pass, for methods that draw with OpenGL.
struct StageSeconds {
  std::string name;
  double seconds = 0;
};

/// A picture of fewer pixels that takes the place of a first pass, enlarged.
struct CoarsePicture {
  int width = 0, height = 0;  ///< pixels, of the part that is shown
  double pass_seconds = 0;    ///< guess of the duration of a pass of the whole picture
};

/// Sums over the passes of one call of `Session::render`.
struct RenderStatistics {
  std::uint64_t passes = 0;
  std::uint64_t passes_elsewhere = 0;               ///< included in `passes`, but not gathered from the team yet
  double seconds = 0;                               ///< wall clock, including the preparation
  double prepare_seconds = 0;                       ///< pilot passes
  std::array<double, phase_count> phase_seconds{};  ///< by Phase
  double first_pass_seconds = 0;                    ///< from the call to the end of the first pass
  RayCounts rays;
  std::uint64_t light_paths = 0, photons_stored = 0;
  std::size_t photon_map_bytes = 0;  ///< of the largest map
  std::uint64_t cache_records = 0, cache_misses = 0;
  std::vector<StageSeconds> stages;               ///< of frames; first on the GPU, then on the CPU
  std::vector<std::uint64_t> photons_per_bounce;  ///< of frames; [i]: photons after i + 1 bounces
  float radius = 0;                               ///< of the last pass, metres; 0 if the method has none
  float volume_radius = 0;                        ///< the same in media; the largest, if there are several estimators
  /// Estimate for the picture after `error_passes` passes; nullopt before the first. Estimates take at most 1 % of the
  /// time, unless `StopRule::noise` requires them.
  std::optional<ErrorEstimate> error{};
  std::uint64_t error_passes = 0;
  /// The limit of the stop rule did not allow a pass: the picture is coarse, and `passes` are its passes.
  std::optional<CoarsePicture> coarse{};
  bool out_of_memory = false;  ///< a pass needed more memory than is available and was abandoned
};

}  // namespace lanthorn
