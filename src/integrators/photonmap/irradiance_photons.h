// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "index/bucket_kdtree.h"
#include "photon/gather/radiance_estimate.h"
#include "photon/incidence.h"
#include "photon/photon.h"

namespace lanthorn {

/// Irradiance precomputed at a subset of a map's photons, so that gather rays that end on diffuse surfaces look it up
/// instead of computing an estimate each (Christensen 1999, "Faster Photon Map Global Illumination"). Immutable.
class IrradiancePhotons {
 public:
  /// One photon in `stride` has a record.
  static constexpr std::size_t stride = 4;

  /// `chunks` are the photons from which `map` was built. Each estimate uses the photons that are available to eye
  /// paths with one scattering. Its record stores the largest number of eye scatterings for which all of these photons
  /// may be used.
  template <class Map>
  static IrradiancePhotons build(const Map& map, std::span<const std::vector<Photon>> chunks,
                                 const EstimateSettings& settings, const Wavelengths& w) {
    IrradiancePhotons result;
    std::vector<Point> positions;
    std::vector<Record> records;
    std::size_t number = 0;
    for (const std::vector<Photon>& chunk : chunks)
      for (const Photon& photon : chunk) {
        if (number++ % stride != 0) continue;
        positions.push_back(photon.position);
        records.emplace_back().normal = dot(photon.wi, photon.normal) < 0 ? -photon.normal : photon.normal;
      }
    IndexBuild<BucketKdTree> built = BucketKdTree::build(positions);
    result.index_ = std::move(built.index);
    result.records_.resize(records.size());
    // In the order of the slots, so that consecutive estimates read the same parts of the map.
    constexpr std::size_t chunk_records = 1024;
    parallel_chunks(records.size(), chunk_records, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t slot = begin; slot < end; ++slot) {
        Record& record = result.records_[slot];
        record = records[built.order[slot]];
        estimate(map, result.index_.position(static_cast<std::uint32_t>(slot)), settings, w, record);
      }
    });
    return result;
  }

  /// Irradiance, W/m², of the nearest record within `radius` (m) whose normal agrees with `normal` (unit, on the side
  /// of the eye). Empty if there is none, or if an eye path of that many scatterings may not use all of its photons.
  std::optional<Spectrum> find(const Point& p, const Normal& normal, float radius, int scatterings) const {
    // The nearest one nearly always fits, and a query for more takes longer.
    for (const std::size_t candidates : {std::size_t{1}, most_candidates})
      if (const Record* record = nearest(p, normal, radius, candidates)) {
        if (scatterings > record->scatterings) return {};
        return record->irradiance;
      }
    return {};
  }

  std::size_t size() const { return records_.size(); }
  std::size_t memory_bytes() const { return index_.memory_bytes() + records_.size() * sizeof(Record); }

 private:
  static constexpr std::size_t most_candidates = 8;

  struct Record {
    Normal normal{0};                                   ///< on the illuminated side
    int scatterings = std::numeric_limits<int>::max();  ///< largest number for eye paths that may use all its photons
    Spectrum irradiance;
  };

  const Record* nearest(const Point& p, const Normal& normal, float radius, std::size_t candidates) const {
    constexpr float least_cosine = 0.9f;
    std::array<Neighbour, most_candidates> memory;
    const std::span<const Neighbour> found = index_.nearest(p, radius, std::span(memory).first(candidates));
    const Neighbour* best = nullptr;
    for (const Neighbour& n : found) {
      const bool fits = dot(records_[n.slot].normal, normal) >= least_cosine &&
                        is_in_disc(dot(index_.position(n.slot) - p, normal), radius);
      if (fits && (best == nullptr || n < *best)) best = &n;
    }
    return best == nullptr ? nullptr : &records_[best->slot];
  }

  // Computes the irradiance of a record whose normal is set.
  template <class Map>
  static void estimate(const Map& map, const Point& p, const EstimateSettings& settings, const Wavelengths& w,
                       Record& record) {
    const Normal& normal = record.normal;
    const auto bring = [&](const auto& photon, float reach) -> std::optional<Spectrum> {
      if (!lies_on(photon, p, normal, reach) || !may_have_normal(photon, normal)) return {};
      const float cos = dot(photon.wi(), normal);
      if (!(cos > 0)) return {};
      const PhotonFlags flags = photon.flags();
      if (flags.eye_scatterings < 1) return Spectrum();
      record.scatterings = std::min(record.scatterings, flags.eye_scatterings);
      const Spectrum light = photon.power() * incidence_ratio(cos, cos);
      return flags.dispersed ? light * w.dispersed : light;
    };
    record.irradiance = estimate_density(map, p, settings, bring).light;
  }

  BucketKdTree index_;
  std::vector<Record> records_;
};

}  // namespace lanthorn
