// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/guides/credit_round.h"

#include <algorithm>
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

}  // namespace lanthorn
