// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// User settings of vertex connection and merging and of its two halves, bidirectional path tracing and bidirectional
// photon mapping, with the layers and the memory of each. The method itself is in vcm.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "integrators/integrator.h"
#include "photon/gather/pilot_radius.h"
#include "photon/guides/emission_choice.h"
#include "photon/media/volume_gather.h"

namespace lanthorn {

/// Which techniques a method has besides the eye walk's own hits.
struct VcmSwitches {
  bool connections = true;  ///< next-event estimation and the lens included
  bool merging = true;
};

/// A strategy of bidirectional path tracing: the light walk makes `s` vertices of the path, including the point on the
/// light, and the eye walk makes `t`, including the point on the lens (Veach 1997, section 10.2).
struct Strategy {
  int s = 0, t = 0;

  bool operator==(const Strategy&) const = default;
};

/// The technique that found the light: the parts of the method's decomposition. `hit`: the eye path met a light; `nee`:
/// next-event estimation; `vc`: an eye vertex was connected to one of a light path; `vm`: it was merged with one.
namespace technique {
inline constexpr std::size_t hit = 0, nee = 1, vc = 2, vm = 3, splat = 4;
}  // namespace technique

struct VcmPreparation;
struct VcmSettings;
/// Chooses the numbers of samples, once the rest is prepared: sets `effort`, `remark` and `findings`.
using EffortPlanner = void (*)(const RenderJob& job, const VcmSettings& settings, VcmPreparation& prepared);

struct VcmSettings {
  VcmSwitches switches;
  std::optional<Strategy> only;         ///< all others are left out of the film
  EffortPlanner plan_effort = nullptr;  ///< of `auto`; null: all techniques everywhere
  int roulette_depth = 3;
  // With merging:
  double alpha = 1;  ///< on surfaces r² shrinks by (i + α) / (i + 1) (Knaus & Zwicker 2011)
  RadiusChoice radius;
  EmissionChoice emission = EmissionChoice::power;
  std::array<bool, volume_estimator_count> volume{};  ///< estimators to merge by in media, by VolumeEstimator
  std::optional<float> volume_radius;                 ///< m; empty: automatic

  VcmSettings(const Parameters& parameters, VcmSwitches switches);
  FilmContents film_contents(const Scene& scene) const;
  std::string limitation(const Scene& scene) const;
  MemoryUse memory_use(const RenderSettings& settings) const;
  bool merges_in_media() const {
    return std::any_of(volume.begin(), volume.end(), [](bool used) { return used; });
  }
  bool merges_by(VolumeEstimator estimator) const { return volume[static_cast<std::size_t>(estimator)]; }
};

std::unique_ptr<Integrator> make_vertex_connection_and_merging(const VcmSettings& settings);

}  // namespace lanthorn
