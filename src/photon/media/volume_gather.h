// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Density estimates of the light that media scatter towards the eye.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/parameters.h"
#include "path/coherence.h"
#include "path/path_context.h"
#include "path/vertex.h"
#include "photon/gather/kernels.h"
#include "photon/gather/photon_gather.h"
#include "photon/media/volume_map.h"

namespace lanthorn {

/// Estimators of multiple scattering and of caustics in media (Jarosz, Nowrouzezahrai, Sadeghi & Jensen 2011, table 1).
enum class VolumeEstimator : std::uint8_t {
  path,               ///< none: eye paths alone
  point,              ///< photons in a ball around a point of the eye path (Jensen & Christensen 1998)
  beam,               ///< photons in a cylinder around the eye path's flight (Jarosz, Zwicker & Jensen 2008)
  photon_beam,        ///< photons' flights around a point of the eye path
  beams,              ///< photons' flights that pass the eye path's flight
  short_photon_beam,  ///< as photon_beam, with flights that end where they scatter
  short_beams
};
inline constexpr std::size_t volume_estimator_count = 7;

/// The parameter "volume".
inline ParameterInfo volume_info() {
  return {"volume", "beam",
          "light that media scatter more than once, and caustics in media: by photons around the eye's rays (beam) or "
          "around points on them (point), by photons' flights around rays (beams) or points (photon-beam), or by eye "
          "paths alone (path); short-beams and short-photon-beam: flights end where they scatter, for dense media"};
}
VolumeEstimator volume_estimator(const Parameters& parameters);
/// The parameter "volume" of methods that join estimators: one of `known` or several, joined by "+"; none for "path".
/// Throws Error for other text.
std::vector<VolumeEstimator> volume_estimators(const Parameters& parameters, std::span<const VolumeEstimator> known);

/// Dimensions of the estimator's kernel; 0 for `path`.
constexpr int kernel_dimensions(VolumeEstimator estimator) {
  switch (estimator) {
    case VolumeEstimator::path:
      return 0;
    case VolumeEstimator::point:
      return 3;
    case VolumeEstimator::beam:
    case VolumeEstimator::photon_beam:
    case VolumeEstimator::short_photon_beam:
      return 2;
    case VolumeEstimator::beams:
    case VolumeEstimator::short_beams:
      return 1;
  }
  return 0;
}
/// True if the estimate is at the point where the eye path scatters, false if along its whole flight.
constexpr bool is_at_point(VolumeEstimator estimator) {
  return estimator == VolumeEstimator::point || estimator == VolumeEstimator::photon_beam ||
         estimator == VolumeEstimator::short_photon_beam;
}
constexpr MediumRecords records_for(VolumeEstimator estimator) {
  switch (estimator) {
    case VolumeEstimator::path:
      return MediumRecords::none;
    case VolumeEstimator::point:
    case VolumeEstimator::beam:
      return MediumRecords::points;
    case VolumeEstimator::photon_beam:
    case VolumeEstimator::beams:
      return MediumRecords::beams;
    case VolumeEstimator::short_photon_beam:
    case VolumeEstimator::short_beams:
      return MediumRecords::short_beams;
  }
  return MediumRecords::none;
}

/// Share of a medium's light, besides single scattering, that photons estimate at an eye vertex; the walk finds the
/// rest. 1 if the medium scatters evenly, less for narrow phase functions, as for narrow lobes of surfaces.
inline float gather_probability(const HenyeyGreenstein& hg) { return spread_of_phase(hg); }

/// Kernels of several sizes whose estimates are compared.
struct KernelLadder {
  std::span<const KernelIn> kernels;  ///< the widest first: that of the gather
  /// m. Photons at distance t from the eye have weight t² / (t² + near²): a photon closer than its kernel is wide
  /// covers the whole picture, and a few of them would dominate.
  float near = 0;
};

/// Estimates from a pass's photons in media. Photons that a delta light has sent through mirrors and clear glass alone
/// count in full, because no walk can find their light; all other photons are multiplied by `gather_probability`.
class VolumeGather {
 public:
  /// `chunks`: the records that the estimator needs, in path order. `radius`: of the equivalent box kernel, m.
  VolumeGather(VolumeEstimator estimator, const Kernel& kernel, float radius,
               std::span<const std::vector<MediumPhoton>> chunks, ColorMode mode)
      : estimator_(estimator),
        kernel_(kernel_dimensions(estimator), kernel, radius),
        are_short_(records_for(estimator) == MediumRecords::short_beams),
        map_(chunks, records_for(estimator), mode, kernel_.support()) {}

  /// Radiance that the medium scatters towards the eye along the way to the next surface, times the walk's beta. Black
  /// for estimators at points.
  GatheredLight along(const PathContext& path, const FlownSegment& flight) const;
  /// Radiance that the medium scatters towards the eye at the vertex, times the walk's beta. Black for estimators along
  /// flights.
  GatheredLight at(const PathContext& path, const MediumVertex& vertex) const;
  /// Adds the same estimate by each of the kernels to `sums`, summed over wavelengths, and returns the number of
  /// photons. `flown`: from the eye to the flight's start or to the vertex, m.
  std::size_t compare_along(const PathContext& path, const FlownSegment& flight, float flown,
                            const KernelLadder& ladder, std::span<float> sums) const;
  std::size_t compare_at(const PathContext& path, const MediumVertex& vertex, float flown, const KernelLadder& ladder,
                         std::span<float> sums) const;
  /// Radius of the equivalent box kernel, m.
  float radius() const { return kernel_.radius(); }
  std::size_t memory_bytes() const { return map_.memory_bytes(); }

 private:
  template <class Take>
  void for_each_along(const PathContext& path, const FlownSegment& flight, Take&& take) const;
  template <class Take>
  void for_each_at(const PathContext& path, const MediumVertex& vertex, Take&& take) const;
  // Fraction of a beam's flux that is left at its point s (m). `key`: of the eye's ray.
  Spectrum left(const PathContext& path, const Medium& medium, const VolumeMap::Beams& beams, std::uint32_t slot,
                float s, std::uint64_t key) const;

  VolumeEstimator estimator_;
  KernelIn kernel_;
  bool are_short_;  ///< beams end where they scatter
  VolumeMap map_;
};

}  // namespace lanthorn
