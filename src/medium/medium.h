// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Participating media: a closed set of plain structs, each in its own file, joined into the variant `Medium`.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "medium/heterogeneous.h"
#include "medium/homogeneous.h"

namespace lanthorn {

using Medium = std::variant<HomogeneousMedium, DensityMedium, RgbGridMedium>;

/// Identifies a medium of the scene; vacuum is not in the list of media.
enum class MediumId : std::uint16_t { vacuum = 0 };
/// The id of the medium with this index in the scene's description; no index: vacuum.
inline MediumId medium_id(const std::optional<std::uint32_t>& index) {
  return index ? static_cast<MediumId>(*index + 1) : MediumId::vacuum;
}

/// Media on the two sides of a surface, by its geometric normal, which points to the outside. If both are equal, the
/// surface does not bound a medium: the surrounding medium continues behind it.
struct MediumInterface {
  MediumId inside = MediumId::vacuum, outside = MediumId::vacuum;

  bool is_transition() const { return inside != outside; }
};

/// Transmittance is an unbiased estimate (ratio tracking, Novák et al. 2014); exact if there is a closed form.
Attenuation attenuation(const Medium& medium, const Segment& segment, const Wavelengths& w, HashRng& rng);
inline Spectrum transmittance(const Medium& medium, const Segment& segment, const Wavelengths& w, HashRng& rng) {
  return attenuation(medium, segment, w, rng).transmittance;
}

/// Scattering coefficient at a point, per metre.
Spectrum scattering_at(const Medium& medium, const Point& p, const Wavelengths& w);

// Flight densities as MIS weights use them: from the wavelengths' mean extinction, whichever wavelength a walk used.

/// Extinction of a homogeneous medium, per metre; 0 for media on grids, which MIS weights treat as transparent.
float mean_extinction(const Medium& medium, const Wavelengths& w);
/// Density per metre with which walks scatter at a point that they reach.
float collision_density(const Medium& medium, const Point& p, const Wavelengths& w);

/// Length of the part of the segment, from its origin, on which the medium scatters noticeable light, metres: beyond
/// it, transmittance is lost in single precision.
float scattering_length(const Medium& medium, const Segment& segment, const Wavelengths& w);

/// Lets a walk of throughput `beta` cross the segment or scatter on it; samples free flight.
Flight fly(const Medium& medium, const Segment& segment, const Spectrum& beta, const Wavelengths& w, HashRng& rng);

/// True if the probability with which flights (`fly`) pass a point is known.
inline bool knows_passing(const Medium& medium) { return std::holds_alternative<HomogeneousMedium>(medium); }

/// Transmittance over `distance` (m), divided by the probability that a flight of throughput `beta` passes its end: the
/// flight's remaining flux relative to its start, by wavelength. 1 if all wavelengths are attenuated alike. Nullopt
/// unless `knows_passing`.
std::optional<Spectrum> passing_weight(const Medium& medium, float distance, const Spectrum& beta,
                                       const Wavelengths& w);

/// Volumetric emission of the whole segment as seen from its origin, attenuated on the way, wherever a walk scatters.
/// Unbiased; exact if there is a closed form.
VolumeEmission emission_along(const Medium& medium, const Segment& segment, const Wavelengths& w, HashRng& rng);

/// Emission coefficient at a point: radiance per metre.
Spectrum emission_at(const Medium& medium, const Point& p, const Wavelengths& w);

/// The box outside of which a medium on a grid is empty.
struct MediumBox {
  Bounds box;  ///< in the medium's space
  Transform to_medium;

  /// Volume in the world, m³.
  double volume() const;
};
/// Nullopt for a homogeneous medium, which fills the space that surfaces enclose.
std::optional<MediumBox> box_of(const Medium& medium);

/// False if the medium only absorbs and emits. May be true for a medium on a grid whose values are all 0.
bool scatters(const Medium& medium);

/// Largest single-scattering albedo over the channels of both colour modes; an upper bound for media with RGB grids. 0
/// if the medium does not scatter.
float largest_albedo(const Medium& medium);

/// True if the medium has volumetric emission.
bool is_emissive(const Medium& medium);

/// Phase function of the medium.
const HenyeyGreenstein& phase_of(const Medium& medium);

/// Transmittance from a segment's origin to every point of it: exact if there is a closed form, otherwise an unbiased
/// estimate at each point, by one ratio tracking for all of them.
class TransmittanceCurve {
 public:
  TransmittanceCurve(const Medium& medium, const Segment& segment, const Wavelengths& w, HashRng& rng);

  /// Transmittance from the origin to a finite distance (m).
  Spectrum to(float distance) const;

 private:
  struct Step {
    float distance;
    Spectrum transmittance;  ///< from this distance on
  };

  Spectrum extinction_;      ///< of the closed form, otherwise 0
  std::vector<Step> steps_;  ///< in order
};

}  // namespace lanthorn
