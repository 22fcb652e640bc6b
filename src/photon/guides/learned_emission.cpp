// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/guides/learned_emission.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "light/light_sampler.h"
#include "photon/guides/credit_round.h"
#include "photon/guides/hit_points.h"
#include "photon/guides/projection_map.h"

namespace lanthorn {

namespace {

constexpr int rounds = 4;
// Share of the photons that ignore the guide: while learning, and with the finished guide.
constexpr float exploring_share = 0.5f, defensive_share = 0.25f;

// Boxes that each hold a few neighbouring points, made by halving at the median.
void add_boxes(std::span<Point> points, std::vector<PhotonBox>& to) {
  constexpr std::size_t most_points = 16;
  if (points.empty()) return;
  Bounds box;
  for (const Point& p : points) box.extend(p);
  if (points.size() <= most_points) {
    to.push_back({box, static_cast<float>(points.size())});
    return;
  }
  const Vec3 extent = box.extent();
  const int axis = extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
  const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
  std::nth_element(points.begin(), middle, points.end(),
                   [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; });
  const std::size_t half = points.size() / 2;
  add_boxes(points.first(half), to);
  add_boxes(points.subspan(half), to);
}

// Disks around the middle of the landings and hit points. None if most of the scene lies between them.
std::optional<AimedDisks> disks_around(std::vector<Point> landings, const std::vector<HitPoint>& hits,
                                       const BoundingSphere& scene) {
  for (const HitPoint& hit : hits) landings.push_back(hit.position);
  if (landings.empty()) return {};
  std::vector<float> values(landings.size());
  const auto middle_of = [&](auto&& value) {
    std::transform(landings.begin(), landings.end(), values.begin(), value);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  Point centre;
  for (int axis = 0; axis < 3; ++axis) centre[axis] = middle_of([axis](const Point& p) { return p[axis]; });
  const float smallest = std::sqrt(middle_of([&](const Point& p) { return distance_squared(p, centre); }));
  constexpr float small = 0.25f;
  if (!(smallest > 0) || smallest > small * scene.radius) return {};
  return AimedDisks(scene, centre, smallest);
}

// Gives some credit to the starts of photons that may hit mirrors or glass, even if the pilot found none there. The
// paths through a lens that the pilot has missed lie near those that it has found; without credit each would have a
// very large flux.
void credit_seeds(std::vector<CreditedStart>& seeds, const std::vector<CreditedStart>& known) {
  constexpr float share = 0.125f;
  float all = 0;
  for (const CreditedStart& s : known) all += s.credit;
  for (CreditedStart& s : seeds) s.credit = share * all / static_cast<float>(seeds.size());
}

// Methods that merge weigh photons by the densities of their paths, which guided directions would change. Paths of
// caustic photons end at the first wide lobe.
bool guides_directions(PhotonUse use) { return use == PhotonUse::indirect || use == PhotonUse::gathering; }

// Photons shared among the lights by power. If they were shared by the masses of a projection map, an environment with
// a coarse map would get almost all of them. A light that far stronger ones would leave next to no photons gets some
// all the same: it may provide all the light of a part of the picture.
EmissionGuide shared_by_power(EmissionGuide guide, const Scene& scene) {
  constexpr float least = 1.0f / 16;  // of an even share
  const std::vector<float> by_power = emission_probabilities(scene.lights());
  const auto emitters = std::count_if(by_power.begin(), by_power.end(), [](float share) { return share > 0; });
  const float least_share = least / static_cast<float>(emitters);
  for (std::size_t i = 0; i < by_power.size(); ++i)
    guide.lights[i].relevance = by_power[i] > 0 ? std::max(1.0f, least_share / by_power[i]) : 1.0f;
  return guide;
}

bool has_power(const Light& light) { return power(light) > 0; }

// Photons add light only where eye paths that continue meet a surface or a medium. Eye paths may miss small mirrors and
// glass, which projection maps find, and scattering media.
bool may_gain(const Scene& scene, const Landings& landings) {
  return !landings.places.empty() || scene.may_be_specular() || scene.has_scattering_media();
}

}  // namespace

LearnedEmission learn_emission(const RenderJob& job, PhotonUse use, bool in_media) {
  const Scene& scene = job.scene;
  if (std::none_of(scene.lights().begin(), scene.lights().end(), has_power)) return {};
  const PassDraw draw = draw_for_pass(job, 0);
  const std::vector<HitPoint> hits = find_hit_points(job, use, in_media, draw);
  // The first round uses projection maps, including the map of mirrors and glass: in large scenes, few photons
  // would reach a visible surface if lights emitted them in proportion to their power.
  Landings landings = find_landings(job, use, in_media, draw);
  if (!may_gain(scene, landings)) return {};
  const std::optional<AimedDisks> disks = disks_around(landings.places, hits, scene.bounding_sphere());
  LightGuide guide{shared_by_power(make_projection_map(scene, PhotonTarget::specular, disks), scene)};
  if (guides_directions(use)) guide.directions = GuidePhotons::build(landings.importance, draw.w);
  CreditRound round = trace_round(job, 0, guide, in_media, draw);
  std::vector<CreditedStart> seeds = round.starts, known;
  if (use != PhotonUse::caustics) {
    std::vector<PhotonBox> boxes;
    add_boxes(landings.places, boxes);
    guide.emission = shared_by_power(make_projection_map(scene, boxes, disks), scene);
    round.append(trace_round(job, 1, guide, in_media, draw));
  }
  LearnedEmission learned;
  for (std::uint32_t number = 0; number < rounds; ++number) {
    if (number > 0) round = trace_round(job, number + 1, guide, in_media, draw);
    learned.share = give_credit(round, hits, use);
    std::copy_if(round.starts.begin(), round.starts.end(), std::back_inserter(known),
                 [](const CreditedStart& start) { return start.credit > 0; });
    credit_seeds(seeds, known);
    std::vector<CreditedStart> starts = known;
    starts.insert(starts.end(), seeds.begin(), seeds.end());
    guide.emission =
        guide_from(scene, std::move(starts), number + 1 < rounds ? exploring_share : defensive_share, disks);
  }
  learned.guide = std::move(guide);
  return learned;
}

}  // namespace lanthorn
