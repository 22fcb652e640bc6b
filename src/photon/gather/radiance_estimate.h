// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The radiance estimate from the nearest photons of a map (Jensen 2001, section 7.2).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "index/point_index.h"
#include "path/vertex.h"
#include "path/walk.h"
#include "photon/gather/kernels.h"
#include "photon/gather/photon_hit.h"
#include "photon/photon_map.h"
#include "spectrum/wavelengths.h"
#include "surface/bsdf.h"

namespace lanthorn {

/// The photons that an estimate uses.
struct EstimateSettings {
  static constexpr std::size_t most_nearest = 256;
  Kernel kernel;
  std::size_t nearest = 50;  ///< number of nearest photons, at most `most_nearest`; 0: all within `radius`
  float radius = 0;          ///< largest distance, metres
  float differential = 0;    ///< threshold of differential checking (settled_count); 0: off
};

/// Result of a density estimate.
struct DensityEstimate {
  Spectrum light;           ///< sum of the photons' light per m²
  float radius = 0;         ///< of the disc, m
  std::size_t photons = 0;  ///< number of photons in the disc
};

/// The nearest photons of an estimate, in the form that `gather_disc` takes.
struct ChosenNearest {
  std::span<const Neighbour> nearest;  ///< the farthest one first
  std::size_t wanted = 0;              ///< number that bounds the disc
};

/// Differential checking (Jensen 1996, "Global Illumination using Photon Maps"): the number of nearest photons that an
/// estimate should use. `nearest` is sorted by distance; its slots index `light`. The function evaluates the estimate
/// of a constant kernel while it adds photons from the nearest on. Where the estimate has grown monotonically, or
/// fallen monotonically, by more than the share `threshold` since some photon, the disc has reached an area of
/// different light and is cut at that photon. At least `least_checked` photons remain. Noise can cut a disc too, more
/// often for lower thresholds.
inline std::size_t settled_count(std::span<const Neighbour> nearest, std::span<const Spectrum> light, float threshold) {
  constexpr std::size_t least_checked = 8;
  // Light per area of the disc up to each photon, without that photon.
  float sum = 0, previous = 0;
  struct Run {
    std::size_t begin = 0;
    float from = 0;
    bool grows = false;
  } run;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const float estimate = nearest[i].dist2 > 0 ? sum / nearest[i].dist2 : 0.0f;
    sum += sum_of(light[nearest[i].slot]);
    const bool grows = estimate > previous;
    if (i < least_checked)
      run = {i, estimate, grows};
    else if (grows != run.grows)
      run = {i - 1, previous, grows};
    if (std::fabs(estimate - run.from) > threshold * run.from && run.from > 0) return run.begin + 1;
    previous = estimate;
  }
  return nearest.size();
}

/// The `wanted` nearest of the photons found, in any order. Differential checking may choose fewer.
inline ChosenNearest choose_nearest(std::span<Neighbour> found, std::size_t wanted, std::span<const Spectrum> light,
                                    float differential) {
  if (found.size() > wanted) {
    std::nth_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(wanted - 1), found.end());
    found = found.first(wanted);
  }
  if (differential > 0) {
    std::sort(found.begin(), found.end());
    const std::size_t settled = settled_count(found, light, differential);
    if (settled < found.size()) found = found.first(wanted = settled);
  }
  if (!found.empty()) std::iter_swap(found.begin(), std::max_element(found.begin(), found.end()));
  return {found, wanted};
}

/// Density of the photons' light at a point. `bring(photon, reach)` returns the light of one photon, W or W/sr; nullopt
/// if the photon does not belong to the surface although it is within `reach` (m), see `lies_on`. Such photons are left
/// out of the sum, of the number of photons and of the search for the radius. The dark side of a thin wall stays dark,
/// and corners are not darkened. `note(position, light, radius)` is called for each photon of the sum, with the
/// disc's radius (m).
template <class Map, class Bring, class Note>
DensityEstimate estimate_density(const Map& map, const Point& p, const EstimateSettings& settings, Bring&& bring,
                                 Note&& note) {
  constexpr std::size_t most = EstimateSettings::most_nearest;
  DensityEstimate result;
  if (settings.nearest == 0) {
    result.radius = settings.kernel.support(settings.radius);
    const float support2 = sqr(result.radius);
    map.for_each_near(p, result.radius, [&](const auto& photon, float dist2) {
      const std::optional<Spectrum> light = bring(photon, result.radius);
      if (!light) return;
      note(photon.position(), *light, result.radius);
      result.light += *light * settings.kernel.weight(dist2, support2);
      ++result.photons;
    });
    return result;
  }

  // If some of the nearest photons belong to other surfaces, the query is repeated with more photons.
  const std::size_t wanted = std::min(settings.nearest, most);
  std::array<Neighbour, most> memory, accepted;
  std::array<Spectrum, most> light;
  std::array<std::uint32_t, most> slots;
  for (std::size_t asked = wanted;; asked = std::min(2 * asked, most)) {
    const std::span<const Neighbour> found = map.nearest(p, settings.radius, std::span(memory).first(asked));
    const bool has_all = found.size() < asked;
    const float reach = has_all ? settings.radius : std::sqrt(found.front().dist2);
    std::size_t count = 0;
    for (const Neighbour& n : found)
      if (const std::optional<Spectrum> brought = bring(map[n.slot], reach)) {
        light[count] = *brought;
        slots[count] = n.slot;
        accepted[count] = {n.dist2, static_cast<std::uint32_t>(count)};
        ++count;
      }
    if (count < wanted && !has_all && asked < most) continue;

    const ChosenNearest chosen = choose_nearest(std::span(accepted).first(count), wanted, light, settings.differential);
    const std::optional<GatherDisc> disc = gather_disc(chosen.nearest, chosen.wanted, reach);
    if (!disc) return result;
    result.radius = std::sqrt(disc->support2);
    result.photons = disc->counted.size();
    for (const Neighbour& n : disc->counted) {
      note(map[slots[n.slot]].position(), light[n.slot], result.radius);
      result.light += light[n.slot] * settings.kernel.weight(n.dist2, disc->support2);
    }
    return result;
  }
}
template <class Map, class Bring>
DensityEstimate estimate_density(const Map& map, const Point& p, const EstimateSettings& settings, Bring&& bring) {
  return estimate_density(map, p, settings, bring, [](const Point&, const Spectrum&, float) {});
}

/// Factor of a photon's light where an eye path reads the global map: the part that `split` leaves to photons. Direct
/// light comes from the map only if all light does; otherwise next-event estimation and the walk find it.
struct MapShare {
  LobeSplit split = LobeSplit::all_wide();

  float operator()(const PhotonFlags& flags, float pdf) const {
    if (flags.direct) return split.is_all_wide() ? 1.0f : 0.0f;
    return flags.from_delta_light ? 1.0f : split.wide(pdf);
  }
};

/// Light of a photon that the vertex scatters to the eye, W/sr, without the eye path's beta. Nullopt if the photon does
/// not belong to the surface (`estimate_density`). `weigh(flags, pdf)` is a factor of the photon's light, 0 for photons
/// whose light another technique finds; `pdf`: density with which the closure samples the photon's direction, 1/sr.
/// Photons of paths that would be too long get factor 0, too.
template <class Ref, class Weigh>
std::optional<Spectrum> reflected_light(const Ref& photon, const GatherVertex& vertex, float reach,
                                        const Wavelengths& w, Weigh&& weigh) {
  const SurfacePoint& at = vertex.vertex().at;
  if (!lies_on(photon, at.position, at.normal, reach) || !may_have_normal(photon, at.normal)) return {};
  const std::optional<PhotonHit> hit = vertex.scatter(photon.wi());
  if (!hit) return {};
  const PhotonFlags flags = photon.flags();
  const float factor = vertex.admits(flags) ? weigh(flags, hit->pdf) : 0.0f;
  const Spectrum light = hit->f * photon.power() * (factor * hit->ratio);
  return vertex.is_dispersed(flags.dispersed) ? light * w.dispersed : light;
}

/// Radiance from photons that the vertex scatters to the eye, W/(m² sr), without the eye path's beta.
template <class Map, class Weigh>
DensityEstimate estimate_radiance(const Map& map, const SurfaceVertex& vertex, const EstimateSettings& settings,
                                  const Wavelengths& w, Weigh&& weigh) {
  const GatherVertex gather(vertex);
  return estimate_density(map, vertex.at.position, settings, [&](const auto& photon, float reach) {
    return reflected_light(photon, gather, reach, w, weigh);
  });
}

}  // namespace lanthorn
