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
#include "photon/gather/disc_tests.h"
#include "photon/gather/radiance_estimate.h"
#include "photon/incidence.h"
#include "photon/photon.h"

namespace lanthorn {

/// Irradiance precomputed at a subset of a map's photons, so that gather rays that end on diffuse surfaces look it up
/// instead of computing an estimate each (Christensen 1999, "Faster Photon Map Global Illumination"). Immutable.
///
/// Records lie where photons are, so the record nearest to a dark point is often a bright one: beyond the edge of a
/// patch of light, every point would get the light of the edge, up to the largest radius. A photon therefore becomes a
/// record only if the light in the disc of its estimate is even (DiscEvenness), and the record holds for points in the
/// middle of that disc. All other points need an estimate of their own.
class IrradiancePhotons {
 public:
  /// One photon in `stride` is a candidate for a record.
  static constexpr std::size_t stride = 4;

  /// Whether estimates with these settings have enough photons for records.
  static bool has_records_for(const EstimateSettings& settings) {
    return settings.nearest == 0 || settings.nearest > DiscEvenness::fewest;
  }

  /// `chunks` are the photons from which `map` was built. Each estimate uses the photons that are available to eye
  /// paths with one scattering. Its record stores the largest number of eye scatterings for which all of these photons
  /// may be used.
  template <class Map>
  static IrradiancePhotons build(const Map& map, std::span<const std::vector<Photon>> chunks,
                                 const EstimateSettings& settings, const Wavelengths& w) {
    std::vector<Record> candidates;
    std::size_t number = 0;
    for (const std::vector<Photon>& chunk : chunks)
      for (const Photon& photon : chunk) {
        if (number++ % stride != 0) continue;
        Record& record = candidates.emplace_back();
        record.position = photon.position;
        record.normal = dot(photon.wi, photon.normal) < 0 ? -photon.normal : photon.normal;
      }
    in_order_of_index(candidates);  // so that consecutive estimates read the same parts of the map
    constexpr std::size_t chunk_records = 1024;
    parallel_chunks(candidates.size(), chunk_records, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) estimate(map, settings, w, candidates[i]);
    });
    std::erase_if(candidates, [](const Record& record) { return !(record.reach > 0); });
    IrradiancePhotons result;
    result.index_ = in_order_of_index(candidates);
    result.records_ = std::move(candidates);
    return result;
  }

  /// Irradiance, W/m², of the nearest record that holds at `p` and whose normal agrees with `normal` (unit, on the side
  /// of the eye). Empty if there is none within `radius` (m), or if an eye path of that many scatterings may not use
  /// all of its photons, or may use others, too: records leave out photons for eye paths without scatterings.
  std::optional<Spectrum> find(const Point& p, const Normal& normal, float radius, int scatterings) const {
    // The nearest one nearly always fits, and a query for more takes longer.
    for (const std::size_t candidates : {std::size_t{1}, most_candidates})
      if (const Record* record = nearest(p, normal, radius, candidates)) {
        if (scatterings < 1 || scatterings > record->scatterings) return {};
        return record->irradiance;
      }
    return {};
  }

  std::size_t size() const { return records_.size(); }
  std::size_t memory_bytes() const { return index_.memory_bytes() + records_.size() * sizeof(Record); }

 private:
  static constexpr std::size_t most_candidates = 8;

  struct Record {
    Point position{0};
    float reach = 0;                                    ///< m, from its position: where it holds; 0: nowhere
    Normal normal{0};                                   ///< on the illuminated side
    int scatterings = std::numeric_limits<int>::max();  ///< largest number for eye paths that may use all its photons
    Spectrum irradiance;
  };

  /// Sorts the records into the order of the slots of the index that is returned.
  static BucketKdTree in_order_of_index(std::vector<Record>& records) {
    std::vector<Point> positions(records.size());
    std::transform(records.begin(), records.end(), positions.begin(), [](const Record& r) { return r.position; });
    IndexBuild<BucketKdTree> built = BucketKdTree::build(positions);
    std::vector<Record> sorted(records.size());
    for (std::size_t slot = 0; slot < sorted.size(); ++slot) sorted[slot] = records[built.order[slot]];
    records = std::move(sorted);
    return std::move(built.index);
  }

  const Record* nearest(const Point& p, const Normal& normal, float radius, std::size_t candidates) const {
    constexpr float least_cosine = 0.9f;
    std::array<Neighbour, most_candidates> memory;
    const std::span<const Neighbour> found = index_.nearest(p, radius, std::span(memory).first(candidates));
    const Neighbour* best = nullptr;
    for (const Neighbour& n : found) {
      const Record& record = records_[n.slot];
      const bool fits = n.dist2 <= sqr(record.reach) && dot(record.normal, normal) >= least_cosine &&
                        is_in_disc(dot(record.position - p, normal), radius);
      if (fits && (best == nullptr || n < *best)) best = &n;
    }
    return best == nullptr ? nullptr : &records_[best->slot];
  }

  // Computes the irradiance and the reach of a record whose position and normal are set.
  template <class Map>
  static void estimate(const Map& map, const EstimateSettings& settings, const Wavelengths& w, Record& record) {
    const Point& p = record.position;
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
    DiscEvenness evenness(normal);
    const DensityEstimate estimate = estimate_density(
        map, p, settings, bring,
        [&](const Point& at, const Spectrum& light, float radius) { evenness.add((at - p) / radius, sum_of(light)); });
    record.irradiance = estimate.light;
    record.reach = evenness.is_even() ? estimate.radius / 2 : 0.0f;
  }

  BucketKdTree index_;
  std::vector<Record> records_;
};

}  // namespace lanthorn
