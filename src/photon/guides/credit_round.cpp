// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/guides/credit_round.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "index/bucket_kdtree.h"
#include "path/depth.h"
#include "path/light_pass.h"
#include "photon/gather/kernels.h"

namespace lanthorn {

namespace {

// A round traces as many light paths as a pass, within these limits: enough to learn from, and no more than the cells
// can use.
constexpr std::uint64_t least_of_round = 16384, most_of_round = 65536;

struct PilotPhotonVisitor {
  CreditRound& round;
  bool in_media;

  Continuation operator()(const SurfaceVertex& vertex) const {
    if (has_non_delta(vertex.at.bsdf)) add(vertex.state, vertex.at.position, vertex.at.normal);
    return Continuation::go_on();
  }
  // Photons that have scattered often say little about where they started.
  Continuation operator()(const MediumVertex& vertex) const {
    constexpr int deepest = 16;
    if (in_media && vertex.state.depth <= deepest) add(vertex.state, vertex.position, Normal(0));
    return Continuation::go_on();
  }
  void operator()(const EscapeVertex&) const {}

 private:
  void add(const WalkState& state, const Point& position, const Normal& normal) const {
    const bool is_caustic = state.depth > 1 && state.non_delta == 0;
    round.photons.push_back(
        {position, normal, sum_of(state.beta), round.starts.size() - 1, state.depth == 1, is_caustic});
  }
};

bool counts_at(const PilotPhoton& photon, const HitPoint& hit, PhotonUse use) {
  if (use == PhotonUse::caustics && !photon.caustic) return false;
  if (photon.direct && !hit.ends_gather) return false;
  if (hit.normal == Normal(0)) return photon.normal == Normal(0);
  if (!is_in_disc(dot(photon.position - hit.position, hit.normal), hit.radius)) return false;
  return dot(photon.normal, hit.normal) > 0.5f;
}

}  // namespace

CreditRound trace_round(const RenderJob& job, std::uint32_t number, const LightGuide& guide, bool in_media,
                        const PassDraw& draw) {
  const LightPaths paths(
      job.scene, {job.settings.seed, Stream::pilot_emission, number,
                  std::clamp<std::uint64_t>(job.settings.photons, least_of_round, most_of_round), &guide.emission});
  std::vector<CreditRound> chunks(paths.chunk_count());
  const WalkLimits limits{max_depth_of_photons(job.scene, job.settings.max_depth), 1};
  paths.for_each([&](const LightPath& start, Sampler& sampler, RayCounts& counts, std::size_t chunk) {
    CreditRound& round = chunks[chunk];
    round.starts.push_back({start.index, emission_numbers(start, sampler).at});
    const PathDraw own = draw.of_path(sampler);
    const PathContext path{job.scene, own.w, sampler, counts, limits};
    with_directions(&guide, PilotPhotonVisitor{round, in_media},
                    [&](auto visitor) { walk_from_light(path, start, own.time, std::move(visitor)); });
  });
  CreditRound all;
  for (const CreditRound& chunk : chunks) all.append(chunk);
  return all;
}

double give_credit(CreditRound& round, std::span<const HitPoint> hits, PhotonUse use) {
  std::vector<Point> positions(round.photons.size());
  std::transform(round.photons.begin(), round.photons.end(), positions.begin(),
                 [](const PilotPhoton& p) { return p.position; });
  const IndexBuild<BucketKdTree> built = BucketKdTree::build(positions);
  double shares = 0;
  // Serial, because several hit points add to the same paths.
  for (const HitPoint& hit : hits) {
    const auto for_each_counted = [&](auto&& visit) {
      built.index.for_each_near(hit.position, hit.radius, [&](std::uint32_t slot, float) {
        const PilotPhoton& photon = round.photons[built.order[slot]];
        if (counts_at(photon, hit, use)) visit(photon);
      });
    };
    float total = 0;
    for_each_counted([&](const PilotPhoton& photon) { total += photon.flux; });
    if (!(total > 0)) continue;
    shares += static_cast<double>(hit.share_of(total));
    const float credit_of_flux = hit.share_of(total) / total;
    for_each_counted(
        [&](const PilotPhoton& photon) { round.starts[photon.path].credit += photon.flux * credit_of_flux; });
  }
  return shares / static_cast<double>(std::max<std::size_t>(1, hits.size()));
}

namespace {

using Cell = TreeDistribution::Cell;

/// Subdivides the emission numbers of one light where its paths have credit.
class CreditSubdivision {
 public:
  /// Masses are shares of the photons of all lights. The share `known` is distributed by credit, whose sum over all
  /// lights is `all`; the share `rest` is distributed uniformly over this light. Only `axes` are halved.
  CreditSubdivision(float all, float known, float rest, std::vector<std::size_t> axes)
      : all_(all), known_(known), rest_(rest), axes_(std::move(axes)) {}

  TreeDistribution build(std::span<CreditedStart> starts) {
    TreeDistribution result;
    add(Cell{}, starts, known_ * credit_of(starts) / all_, 0, result);
    return result;
  }

 private:
  static constexpr int most_depth = 48;
  static constexpr std::size_t fewest_starts = 16;
  static constexpr float least_share = 1.0f / 16384;  // of all credit
  // Share of a cell's mass that its halves get in equal parts. Where few paths have credit, paths next to them
  // contribute too; without this share they would be rare and have a very large flux.
  static constexpr float doubt = 0.04f;

  static float credit_of(std::span<const CreditedStart> starts) {
    float sum = 0;
    for (const CreditedStart& s : starts) sum += s.credit;
    return sum;
  }
  static auto below(const Cell& cell, std::size_t axis) {
    const float middle = cell.half(axis, true).low[axis];
    return [axis, middle](const CreditedStart& s) { return s.at[axis] < middle; };
  }

  // The axis along which the credit of the two halves differs most.
  std::size_t most_uneven_axis(const Cell& cell, std::span<const CreditedStart> starts) const {
    const auto difference = [&](std::size_t axis) {
      const auto is_below = below(cell, axis);
      float sum = 0;
      for (const CreditedStart& s : starts) sum += is_below(s) ? s.credit : -s.credit;
      return std::fabs(sum);
    };
    std::size_t best = axes_.front();
    float most = difference(best);
    for (const std::size_t axis : std::span(axes_).subspan(1))
      if (const float own = difference(axis); own > most) {
        most = own;
        best = axis;
      }
    return best;
  }

  // `mass` is the part of `known` in this cell.
  std::uint32_t add(const Cell& cell, std::span<CreditedStart> starts, float mass, int depth, TreeDistribution& to) {
    if (axes_.empty() || starts.size() < fewest_starts || mass < least_share * known_ || depth == most_depth)
      return to.add_leaf(mass + rest_ * cell.volume());
    const std::size_t axis = most_uneven_axis(cell, starts);
    const auto middle = std::stable_partition(starts.begin(), starts.end(), below(cell, axis));
    const auto lower_count = static_cast<std::size_t>(middle - starts.begin());
    const std::span<CreditedStart> below_middle = starts.first(lower_count), above = starts.subspan(lower_count);
    const float lower_credit = credit_of(below_middle), upper_credit = credit_of(above);
    const float lower_share = (1 - doubt) * lower_credit / (lower_credit + upper_credit) + doubt / 2;
    const std::uint32_t lower = add(cell.half(axis, false), below_middle, lower_share * mass, depth + 1, to);
    const std::uint32_t upper = add(cell.half(axis, true), above, (1 - lower_share) * mass, depth + 1, to);
    return to.add_inner(axis, lower, upper);
  }

  float all_, known_, rest_;
  std::vector<std::size_t> axes_;
};

// The axes that can be recovered from a ray of the light. Along other axes credit differs by chance alone, so that a
// subdivision would fit noise, and MIS weights would have to integrate over them.
std::vector<std::size_t> telling_axes(const Light& light) {
  std::vector<std::size_t> axes;
  const auto ray = sample_emission(light, Vec2(0.5f), Vec2(0.5f), Wavelengths::rgb(0.5f));
  if (!ray) return axes;
  const EmissionNumbers u = invert_emission(light, {ray->origin, ray->normal, Vec2(0)}, ray->direction);
  if (u.position) axes = {0, 1};
  if (u.direction) axes.insert(axes.end(), {2, 3});
  return axes;
}

}  // namespace

EmissionGuide guide_from(const Scene& scene, std::vector<CreditedStart> starts, float unknown_share,
                         const std::optional<AimedDisks>& disks) {
  const std::vector<Light>& lights = scene.lights();
  EmissionGuide guide(lights.size(), disks);
  std::stable_sort(starts.begin(), starts.end(),
                   [](const CreditedStart& a, const CreditedStart& b) { return a.light < b.light; });
  float all = 0, total_power = 0;
  for (const CreditedStart& s : starts) all += s.credit;
  for (const Light& light : lights) total_power += std::fmax(0.0f, power(light));
  if (!(all > 0)) return guide;
  auto begin = starts.begin();
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    const auto end = std::find_if(begin, starts.end(), [i](const CreditedStart& s) { return s.light != i; });
    const float share_of_power = std::fmax(0.0f, power(lights[i])) / total_power;
    if (share_of_power > 0) {
      const std::span<CreditedStart> own(begin, end);
      float credit = 0;
      for (const CreditedStart& s : own) credit += s.credit;
      guide.lights[i].relevance = (1 - unknown_share) * credit / all / share_of_power + unknown_share;
      guide.lights[i].numbers =
          CreditSubdivision(all, 1 - unknown_share, unknown_share * share_of_power, telling_axes(lights[i])).build(own);
    }
    begin = end;
  }
  return guide;
}

}  // namespace lanthorn
