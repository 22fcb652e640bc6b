// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// User settings of photon mapping in two passes, and the memory it needs. The method itself is in photonmap.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "integrators/integrator.h"
#include "integrators/photonmap/two_pass.h"
#include "photon/guides/emission_choice.h"

namespace lanthorn {

/// Whether photons or reverse photons are searched for where gather rays end.
enum class Search : std::uint8_t { photons, reverse_photons };

struct PhotonMapSettings {
  TwoPassSettings estimates;            ///< without their largest radius, unless it is given
  std::optional<RadiusRule> reverse;    ///< of the photons that look for reverse photons
  std::optional<float> radius;          ///< the largest of an estimate, m; none: automatic
  std::uint64_t caustic_photons = 0;    ///< light paths for caustics alone
  bool keeps_maps = false;              ///< the maps of the first pass serve all passes
  bool precomputes_irradiance = false;  ///< at photons (Christensen 1999)
  bool guides_gathering = false;        ///< gather rays go where photons came from (Jensen 1995)
  bool spares_shadow_rays = false;      ///< traces none where shadow photons agree (Jensen & Christensen 1995)
  EmissionChoice emission;
  VolumeEstimator volume;
  std::optional<float> volume_radius;  ///< m; none: automatic

  PhotonMapSettings(const Parameters& parameters, Search search);
  MemoryUse memory_use(const RenderSettings& settings) const;
  /// Throws Error for scenes and views that the settings do not support.
  void check(const RenderJob& job) const;
  /// Records of light paths in media; none if a map is shown.
  MediumRecords medium_records() const {
    return estimates.show == Show::image ? records_for(volume) : MediumRecords::none;
  }
  /// True if shadow photons are shown.
  bool shows_shadows() const { return estimates.show == Show::shadow; }
  /// True if a cache of final gathering is filled.
  bool fills_cache() const {
    return estimates.cache && (estimates.show == Show::image || estimates.show == Show::records);
  }
};

std::unique_ptr<Integrator> make_photon_mapper(const PhotonMapSettings& settings);

}  // namespace lanthorn
