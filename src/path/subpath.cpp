// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/subpath.h"

#include <algorithm>
#include <utility>

#include "path/direct_light.h"

namespace lanthorn {

namespace {

// Squared length of a flight, bounded from below: a flight whose length rounds to 0 still has a direction, and hence
// densities.
float squared_length(const Point& from, const Point& to) {
  constexpr float least = 1e-24f;
  return std::max(distance_squared(from, to), least);
}

// A first vertex of a path.
struct FirstVertex {
  Direction direction;  // of the path there
  Point position;
  Normal normal;  // 0 in a medium
  float time;
  float distance2;  // from the start
};

// Density per solid angle of an eye path's first ray.
float lens_density(const Camera& camera, const Point& lens, const FirstVertex& at) {
  const float distance = std::sqrt(at.distance2);
  const Ray ray{lens, at.direction, infinity, at.time};
  return camera.density_at(ray, distance) * at.distance2;
}

// Density of next-event estimation from the first vertex of a light path, per area at the light.
float direct_density(const Scene& scene, const PathStart& start, const FirstVertex& at) {
  const EmissionSample& e = start.emission;
  const float chosen =
      next_event_density(scene, start.light, at.position, at.normal, {e.origin, e.normal, Vec2(0)}, -e.direction);
  return has_surface(scene.lights()[start.light]) ? chosen * e.cos_origin / at.distance2 : chosen;
}

// MIS weights do not distinguish where on a ray through an emissive medium a light path started.
EmissionSample emission_seen_from(const Light& light, const PathStart& start, const FirstVertex& at) {
  EmissionSample result = start.emission;
  if (is_volume(light))
    result.pdf_position = pdf_emission(light, {at.position, Normal(0), Vec2(0)}, result.direction).position;
  return result;
}

// Optical depth of the first flight; 0 from an emissive medium, for the same reason.
float optical_depth_from(const Scene& scene, const PathStart& start, float optical_depth) {
  return !start.is_eye() && is_volume(scene.lights()[start.light]) ? 0.0f : optical_depth;
}

// Densities of the start, without the geometry of the first vertex (TR eqs. 31-33).
SubpathDensities densities_of_start(const Scene& scene, const PathStart& start, const Techniques& techniques,
                                    const Point& from, const FirstVertex& at) {
  if (start.is_eye()) return SubpathDensities::from_lens(techniques.light_paths, lens_density(*start.camera, from, at));
  const Light& light = scene.lights()[start.light];
  const EmissionSample e = emission_seen_from(light, start, at);
  const float traced = start.density_factor * e.pdf_position * e.pdf_direction;
  if (!(traced > 0)) return {};
  const float cos_origin = has_surface(light) ? e.cos_origin : 1.0f;
  return SubpathDensities::from_light(traced, direct_density(scene, start, at),
                                      is_delta(light) || !techniques.connects ? 0.0f : cos_origin);
}

bool comes_as_ray(const Scene& scene, const PathStart& start) {
  return !start.is_eye() && is_of_rays(scene.lights()[start.light]);
}

}  // namespace

VolumeArrival arrive_in_medium(const Scene& scene, const PathStart& start, const Departure& departure,
                               const Techniques& techniques, const Point& p, float time, float optical_depth,
                               float collision) {
  const float distance2 = squared_length(p, departure.from), whole = departure.optical_depth + optical_depth;
  const float seen = departure.is_first ? optical_depth_from(scene, start, whole) : whole;
  const FlightDensity flight{FlightDensity::passing(seen), FlightDensity::colliding(collision)};
  SubpathDensities densities = departure.densities;
  bool as_ray = false;
  if (departure.is_first) {
    densities = densities_of_start(scene, start, techniques, departure.from,
                                   {departure.direction, p, Normal(0), time, distance2});
    as_ray = comes_as_ray(scene, start);
  }
  densities.fly(flight, departure.collision, departure.over_pass);
  densities.arrive(distance2, 1, as_ray);
  return {densities, flight};
}

void Subpath::depart(const WalkState& state, const Direction& direction) {
  if (has_departed_) return;
  has_departed_ = true;
  departure_.from = state.previous;
  departure_.direction = direction;
  departure_.optical_depth = 0;
  if (departure_.is_first) return;
  const bool in_medium = !previous_.surface;
  const float cos = in_medium ? 1.0f : arrival_cosine(*previous_.surface, previous_.wi, direction);
  departure_.over_pass = 0;
  if (state.last_delta) return departure_.densities.scatter_delta(cos);
  float merging = 0;
  if (in_medium && techniques_.volume.is_used()) {
    const VolumeMerging seen = start_.is_eye() ? techniques_.volume : techniques_.volume.reversed();
    const VolumeMerging::Sum merged = seen.before_next(flight_, length(cross(previous_.wi, direction)));
    merging = coherence_ * merged.a;
    departure_.over_pass = coherence_ * merged.b / state.pdf_direction;
  }
  // The coherence of an eye path applies to later vertices, the coherence of a light path's vertex to earlier ones.
  if (start_.is_eye()) coherence_ = coherence_beyond();
  departure_.densities.scatter({.cos = cos,
                                .pdf = state.pdf_direction,
                                .reverse = reverse_density(state, direction),
                                .merges = previous_.merges,
                                .merging_media = merging,
                                .coherence = start_.is_eye() ? 1.0f : previous_.coherence},
                               techniques_.connects);
}

float Subpath::reverse_density(const WalkState& state, const Direction& direction) const {
  if (!previous_.surface) return state.pdf_direction;  // phase functions have the same density in both directions
  const SurfacePoint& at = *previous_.surface;
  const Transport transport = start_.is_eye() ? Transport::radiance : Transport::importance;
  return evaluate(at.bsdf, previous_.wi_local, at.shading.to_local(direction), transport, {.pdf_reverse = true})
      .pdf_reverse;
}

SubpathDensities Subpath::densities_of_direct_light() const {
  SubpathDensities result = departure_.densities;
  result.start_denser(emission_densities_->of_direct_light(start_.light, start_.density_factor) /
                      start_.density_factor);
  return result;
}

const Departure& Subpath::depart(const FlownSegment& flight) {
  depart(flight.state, flight.segment.direction);
  return departure_;
}

void Subpath::fly(const FlownSegment& flight) {
  if (flight.state.medium == MediumId::vacuum) return;
  depart(flight);
  departure_.optical_depth += flight.optical_depth;
}

void Subpath::arrive_at(const Scene& scene, const WalkState& state, const Position& at, const Direction& wi) {
  const float distance2 = squared_length(at.position, state.previous);
  depart(state, -wi);
  has_departed_ = false;
  const bool is_first = std::exchange(departure_.is_first, false);
  if (scene.has_media()) {
    const float depth =
        is_first ? optical_depth_from(scene, start_, departure_.optical_depth) : departure_.optical_depth;
    flight_ = {FlightDensity::passing(depth), FlightDensity::colliding(at.collision)};
  }
  if (is_first)
    departure_.densities = densities_of_start(scene, start_, techniques_, state.previous,
                                              {departure_.direction, at.position, at.normal, at.time, distance2});
  if (scene.has_media()) departure_.densities.fly(flight_, departure_.collision, departure_.over_pass);
  departure_.densities.arrive(distance2, at.cos, is_first && comes_as_ray(scene, start_));
  departure_.collision = flight_.collision;
}

void Subpath::arrive(const PathContext& path, const SurfaceVertex& v) {
  const bool is_direct = !start_.is_eye() && v.state.depth == 1;
  const bool merges = merges_at(v.at) && !(is_direct && techniques_.connects);
  const float cos = area_cosine(v.at, v.wi);
  arrive_at(path.scene, v.state, {v.at.position, receiver_normal(v.at), v.at.time, cos, 1, merges}, v.wi);
  previous_ = {v.at, v.wi_local, v.wi, merges, techniques_.volume.is_used() ? lanthorn::coherence(v.at.bsdf) : 1.0f};
}

void Subpath::arrive(const PathContext& path, const MediumVertex& v) {
  const float collision = collision_density(path.scene.medium(v.state.medium), v.position, path.w);
  arrive_at(path.scene, v.state, {v.position, Normal(0), v.time, 1, collision, false}, v.wi);
  previous_ = {{}, Vec3(0), v.wi, false, techniques_.volume.is_used() ? lanthorn::coherence(v.phase) : 1.0f};
}

void Subpath::escape(const WalkState& state, const Direction& direction, bool flies) {
  depart(state, direction);
  if (departure_.is_first) return;
  const FlightDensity flight{flies ? FlightDensity::passing(departure_.optical_depth) : 1.0f, 1};
  departure_.densities.fly(flight, departure_.collision, departure_.over_pass);
}

}  // namespace lanthorn
