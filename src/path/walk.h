// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The random walk of all methods. Russian roulette, dispersion, the adjoint of shading normals and the media between
// surfaces are handled here only. Path tracing, photon tracing and the eye passes of progressive methods are visitors.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "camera/camera.h"
#include "math/sampler.h"
#include "math/tree_distribution.h"
#include "medium/medium.h"
#include "path/depth.h"
#include "path/path_context.h"
#include "path/transmittance.h"
#include "path/vertex.h"
#include "scene/scene.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// |cos| of wi to the shading normal / |cos| to the geometric normal. Scattering is defined with the shading normal,
/// but flux arrives through the geometric surface. The ratio multiplies flux scattered at a vertex of a light walk, and
/// photons in a density estimate (Veach 1997, section 5.3.2).
inline float shading_flux_ratio(const SurfacePoint& at, const Direction& wi, const Vec3& wi_local) {
  const float geometric = geometric_cosine(at, wi);
  return geometric > 0 ? cosine(at.bsdf, wi_local) / geometric : 0.0f;
}

namespace walk_detail {

/// The magnitude of a throughput for Russian roulette: its mean over the channels that still carry light.
inline float magnitude(const Spectrum& beta, bool dispersed, const Wavelengths& w) {
  if (w.mode == ColorMode::rgb) return beta[0] + beta[1] + beta[2];
  return dispersed ? 4 * beta[w.hero] : sum_of(beta);
}

/// Correction of a light walk's throughput for shading normals: sampling has multiplied by the shading cosine of wo,
/// but flux leaves by the geometric cosine (Veach 1997, eq. 5.19).
inline float adjoint_correction(const SurfaceVertex& v, const Direction& wo, const Vec3& wo_local) {
  const float shading = cosine(v.at.bsdf, wo_local);
  return shading > 0 ? shading_flux_ratio(v.at, v.wi, v.wi_local) * geometric_cosine(v.at, wo) / shading : 0.0f;
}

/// Density of a sampled direction as `evaluate` would give it, so that both sides of a MIS weight use the same
/// function.
template <Transport transport>
float pdf_of_sample(const SurfaceVertex& v, const BsdfSample& s) {
  return s.pdf_is_exact ? s.pdf : evaluate(v.at.bsdf, v.wi_local, s.wo, transport, {.pdf = true}).pdf;
}

/// A direction drawn from the mixture of closure and guide: `weight` and `pdf` are the mixture's.
struct GuidedSample : BsdfSample {
  float closure_ratio = 1;  ///< the weight of the closure's own sampling / that of the mixture
};
/// Factor that removes the guide's density from the throughput, for Russian roulette.
constexpr float closure_ratio(const BsdfSample&) { return 1; }
constexpr float closure_ratio(const GuidedSample& s) { return s.closure_ratio; }

/// Spread of a ray in a direction that was drawn with density `pdf` per solid angle: as if the vertex had sent 256
/// rays, each with its own cone (path footprints, Bekaert et al. 2003, "A custom designed density estimator for light
/// transport"). At most that of a diffuse surface, 1/16. Delta lobes have spread 0, because curved mirrors and lenses
/// may magnify the surfaces seen in them. So do light paths, because the camera may see their vertices.
inline float spread_of(float pdf) {
  constexpr float rays = 256, most = 1.0f / 16;
  return std::min(most, 1 / std::sqrt(rays * pi * pdf));
}

template <Transport transport>
std::optional<BsdfSample> draw(const SurfaceVertex& v, const Continuation&, float u_lobe, const Vec2& u) {
  return sample(v.at.bsdf, v.wi_local, u_lobe, u, transport);
}

/// One sample of the mixture of guide and closure (Veach 1997, section 9.2.4: one-sample model, balance heuristic): f
/// cos divided by the mixture's density, whichever of the two has drawn the direction. A direction that a layered
/// closure has drawn keeps the sample's own estimate of f.
template <Transport transport>
std::optional<GuidedSample> draw(const SurfaceVertex& v, const GuidedContinuation& continuation, float u_lobe,
                                 const Vec2& u) {
  const Guidance& guidance = continuation.guidance;
  const Bsdf& bsdf = v.at.bsdf;
  const float share = guidance.share;
  if (u_lobe < share) {
    const std::optional<Direction> wo = guidance.sample(u);
    if (!wo) return std::nullopt;
    const Vec3 local = v.at.shading.to_local(*wo);
    const BsdfValue own = evaluate(bsdf, v.wi_local, local, transport, {.f = true, .pdf = true});
    if (own.f.is_black()) return std::nullopt;
    const float mixed = guidance.pdf(own.pdf, *wo);
    if (!(mixed > 0)) return std::nullopt;
    return GuidedSample{{local, own.f * (cosine(bsdf, local) / mixed), mixed}, mixed / own.pdf};
  }
  const float rest = std::min(one_minus_epsilon, (u_lobe - share) / (1 - share));
  const std::optional<BsdfSample> s = sample(bsdf, v.wi_local, rest, u, transport);
  if (!s || guidance.guide == nullptr) return s ? std::optional(GuidedSample{*s}) : std::nullopt;
  GuidedSample result{*s};
  if (s->delta) {
    result.closure_ratio = 1 - share;
  } else {
    const float own = pdf_of_sample<transport>(v, *s);
    result.pdf = guidance.pdf(own, v.at.shading.to_world(s->wo));
    result.pdf_is_exact = true;
    if (!(own > 0)) return std::nullopt;
    result.closure_ratio = result.pdf / own;
  }
  result.weight *= 1 / result.closure_ratio;
  return result;
}

/// Scatters at a vertex: updates the state and makes `ray` the next. False if the walk ends here.
template <Transport transport, class Answer>
bool scatter(const PathContext& path, const SurfaceVertex& v, const Answer& answer, WalkState& state, Ray& ray) {
  Sampler& sampler = path.sampler;
  sampler.seek(walk_dimensions(state.depth));
  const float u_lobe = sampler.next();
  const float u_x = sampler.next();
  const Vec2 u{u_x, sampler.next()};
  const auto s = draw<transport>(v, answer, u_lobe, u);
  if (!s) return false;

  const Direction wo = v.at.shading.to_world(s->wo);
  Spectrum beta = state.beta * s->weight;
  if (beta.is_black()) return false;
  if constexpr (transport == Transport::importance) beta *= adjoint_correction(v, wo, s->wo);
  if (!may_leave(path, v, wo)) return false;
  state.dispersed = state.dispersed || is_dispersive(v.at.bsdf);

  const float pdf = s->delta ? 0.0f : pdf_of_sample<transport>(v, *s);
  const WalkShare share = answer.towards(s->delta ? infinity : pdf / closure_ratio(*s));
  float survival = share.probability;
  if (state.depth >= path.limits.roulette_depth) {
    // Russian roulette ignores two factors. Refraction scales radiance by 1 / eta^2, and the next interface undoes it;
    // the flux of photons is not scaled. A guide's density lowers the throughput of directions that it samples often.
    const float squeeze = transport == Transport::radiance ? s->eta * s->eta : 1.0f;
    const float before = magnitude(state.beta, state.dispersed, path.w);
    const float after = magnitude(beta, state.dispersed, path.w) * squeeze * closure_ratio(*s);
    survival *= std::min(1.0f, after / before);
  }
  if (!(survival > 0) || (survival < 1 && sampler.next() >= survival)) return false;
  state.beta = beta * (share.part / survival);
  state.last_delta = s->delta;
  state.sky_is_found = answer.branches_to_sky() && !s->delta;
  state.non_delta += s->delta ? 0 : 1;
  state.pdf_direction = share.probability * pdf;
  state.share = share.part;
  state.previous = v.at.position;
  state.previous_normal = receiver_normal(v.at);
  leave_surface(v.at, wo, ray);
  if (transport == Transport::radiance && !s->delta) ray.spread = spread_of(pdf);
  return true;
}

/// Scatters at a vertex in a medium. `before` is the throughput before the flight to it, so that Russian roulette uses
/// the albedo.
inline bool scatter(const PathContext& path, const MediumVertex& v, const Spectrum& before, WalkState& state,
                    Ray& ray) {
  path.sampler.seek(walk_dimensions(state.depth));
  const Vec2 u = path.sampler.next2();
  const PhaseSample s = sample_phase(v.phase, v.wi, u);
  float survival = 1;
  if (state.depth >= path.limits.roulette_depth) {
    const Wavelengths& w = path.w;
    survival = std::min(1.0f, magnitude(state.beta, state.dispersed, w) / magnitude(before, state.dispersed, w));
    if (!(survival > 0) || path.sampler.next() >= survival) return false;
  }
  state.beta *= 1 / survival;
  state.last_delta = state.sky_is_found = false;
  ++state.non_delta;
  state.pdf_direction = s.pdf;
  state.share = 1;
  state.previous = v.position;
  state.previous_normal = Normal(0);
  ray = {v.position, s.wo, infinity, v.time};
  return true;
}

/// Passes a flight to visitors that declare FlownSegment; for other visitors it compiles to nothing. `begin_normal`: as
/// in FlownSegment.
template <class Visit>
void show(Visit& visit, const WalkState& state, const Ray& ray, const Normal& begin_normal,
          const std::optional<SurfacePoint>& at, const Flight& flight = {}) {
  if constexpr (requires(const FlownSegment& segment) { visit(segment); }) {
    const float to_surface = at ? std::sqrt(distance_squared(at->position, ray.origin)) : infinity;
    visit(FlownSegment{state,
                       {ray.origin, ray.direction, flight.distance.value_or(to_surface)},
                       to_surface,
                       flight.distance.has_value(),
                       flight.weight,
                       flight.optical_depth,
                       flight.pdf,
                       begin_normal,
                       at && !at->is_hair ? at->normal : Normal(0)});
  }
}

/// Draws ahead the random numbers of the next vertex: the visitor's in eye walks, the walk's own in light walks, whose
/// visitors mostly need none.
template <Transport transport>
void draw_ahead(const PathContext& path, int depth) {
  constexpr bool is_eye_walk = transport == Transport::radiance;
  path.sampler.draw_ahead(is_eye_walk ? visitor_dimensions(depth) : walk_dimensions(depth));
}

/// Passes a ray through an interface between media, or an eye path that has not scattered through a shape that is
/// hidden from the camera. Returns false if the surface stops the ray.
template <Transport transport>
bool pass_through(const SurfacePoint& at, WalkState& state, Ray& ray) {
  const bool is_hidden = transport == Transport::radiance && at.is_hidden && state.depth == 0;
  if (!is_hidden && !at.is_interface) return false;
  if (at.is_interface) state.medium = medium_towards(at, ray.direction, state.medium);
  Ray rest = pass_surface(at, ray);
  rest.width = ray.width + ray.spread * std::sqrt(distance_squared(at.position, ray.origin));  // its footprint goes on
  rest.spread = ray.spread;
  ray = rest;
  return true;
}

/// How the crossing of a medium ends: the walk passes to the end of the ray, ends, or scatters.
enum class Crossing : std::uint8_t { passed, ended, scattered };

/// Takes the walk through its medium to the surface `at`, or to infinity. If it scatters, `ray` becomes the next ray.
template <class Visit>
Crossing cross_medium(const PathContext& path, Ray& ray, const Normal& begin_normal,
                      const std::optional<SurfacePoint>& at, HashRng& flights, WalkState& state, Visit& visit) {
  const float length = at ? std::sqrt(distance_squared(at->position, ray.origin)) : infinity;
  const Medium& medium = path.scene.medium(state.medium);
  const Segment way{ray.origin, ray.direction, length};
  if constexpr (requires(const EmissionVertex& vertex) { visit(vertex); })
    if (is_emissive(medium)) {
      const Spectrum emitted = emission_along(medium, way, path.w, flights).emitted;
      if (!emitted.is_black()) visit(EmissionVertex{state, ray.direction, emitted});
    }
  if constexpr (requires(const MediumRay& in_medium) { visit(in_medium); }) visit(MediumRay{state, way, ray.time});
  const Flight flight = fly(medium, way, state.beta, path.w, flights);
  show(visit, state, ray, begin_normal, at, flight);
  const Spectrum before = state.beta;
  state.beta *= flight.weight;
  if (state.beta.is_black()) return Crossing::ended;
  if (!flight.distance) return Crossing::passed;
  come_to_vertex(path.scene, state);
  const Point position = ray.origin + *flight.distance * ray.direction;
  const MediumVertex vertex{state, position, -ray.direction, phase_of(medium), ray.time, may_scatter(path, state)};
  const Continuation continuation = visit(vertex);
  if (!vertex.may_scatter || !continuation.goes_on) return Crossing::ended;
  return scatter(path, vertex, before, state, ray) ? Crossing::scattered : Crossing::ended;
}

}  // namespace walk_detail

/// Follows `ray` through the scene. `state` holds beta, densities and medium at the ray's start, and becomes that at
/// the end of the walk. Calls the visitor:
/// - `visit(SurfaceVertex)` and `visit(MediumVertex)` where the walk may scatter. They return a Continuation; on
///   surfaces one of the types derived from it is possible too.
/// - `visit(EscapeVertex)` when the walk leaves the scene.
/// - `visit(EmissionVertex)`, if the visitor declares it, for volumetric emission.
/// - `visit(MediumRay)`, if the visitor declares it, for each ray through a medium.
/// - `visit(FlownSegment)`, if the visitor declares it, for each flight.
/// The walk draws from `path.sampler` at `walk_dimensions(depth)`. A visitor must seek `visitor_dimensions(depth)`
/// before it draws. Eye walks pass through shapes that are hidden from the camera until they scatter.
template <Transport transport, class Visit>
void walk(const PathContext& path, Ray ray, WalkState& state, Visit&& visit) {
  // Scenes without media need not pay for this hash.
  HashRng flights = path.scene.has_media() ? path.sampler.generator(walk_dimensions(0)) : HashRng(0);
  Normal begin_normal = state.previous_normal;  // of the ray
  for (;;) {
    ++path.counts.walk;
    walk_detail::draw_ahead<transport>(path, state.depth + 1);
    const std::optional<SurfacePoint> at = path.scene.intersect(ray, path.w);
    if (state.medium != MediumId::vacuum) {
      const walk_detail::Crossing crossing =
          walk_detail::cross_medium(path, ray, begin_normal, at, flights, state, visit);
      if (crossing == walk_detail::Crossing::ended) return;
      begin_normal = state.previous_normal;
      if (crossing == walk_detail::Crossing::scattered) continue;
    } else {
      walk_detail::show(visit, state, ray, begin_normal, at);
    }
    if (at && walk_detail::pass_through<transport>(*at, state, ray)) {
      begin_normal = at->normal;
      continue;
    }
    if (!at) {
      // At the limits of single precision, a closure or a camera may produce a ray without a finite direction.
      if (std::isfinite(ray.direction.x + ray.direction.y + ray.direction.z)) visit(EscapeVertex{state, ray.direction});
      return;
    }
    come_to_vertex(path.scene, state);
    const Direction wi = -ray.direction;
    const SurfaceVertex vertex{state, *at, wi, at->shading.to_local(wi), may_scatter(path, state)};
    const auto answer = visit(vertex);
    if (!vertex.may_scatter || !answer.goes_on) return;
    if (!walk_detail::scatter<transport>(path, vertex, answer, state, ray)) return;
    state.medium = medium_towards(vertex, ray.direction);
    begin_normal = state.previous_normal;
  }
}

/// The first ray of an additional path from a vertex, through its non-delta lobes only, with the given answer. Empty if
/// a delta lobe is drawn. For methods that split paths; `path` belongs to the branch, and `state` becomes that of the
/// ray.
template <Transport transport, class Answer>
std::optional<Ray> branch_ray(const PathContext& path, const SurfaceVertex& vertex, const Answer& answer,
                              WalkState& state) {
  state = vertex.state;
  // No Russian roulette at the branching vertex: the method has already chosen the number of branches.
  PathContext here = path;
  here.limits.roulette_depth = std::numeric_limits<int>::max();
  Ray ray;
  if (!walk_detail::scatter<transport>(here, vertex, answer, state, ray) || state.last_delta) return {};
  state.medium = medium_towards(vertex, ray.direction);
  return ray;
}

/// Follows the path that `branch_ray` begins.
template <Transport transport, class Answer, class Visit>
void branch_walk(const PathContext& path, const SurfaceVertex& vertex, const Answer& answer, Visit&& visit) {
  WalkState state;
  if (const std::optional<Ray> ray = branch_ray<transport>(path, vertex, answer, state))
    walk<transport>(path, *ray, state, visit);
}

/// Follows a path from a vertex in a reflected direction that the caller has drawn with density `pdf` (per solid
/// angle). `beta` is the throughput after the vertex, the rest as for `branch_walk`.
template <Transport transport, class Visit>
void walk_towards(const PathContext& path, const SurfaceVertex& vertex, const Direction& wo, float pdf,
                  const Spectrum& beta, Visit&& visit) {
  if (!may_leave(path, vertex, wo)) return;
  WalkState state = vertex.state;
  state.beta = beta;
  state.last_delta = state.sky_is_found = false;
  ++state.non_delta;
  state.pdf_direction = pdf;
  state.share = 1;
  state.previous = vertex.at.position;
  state.previous_normal = receiver_normal(vertex.at);
  state.medium = medium_towards(vertex, wo);
  Ray ray = spawn_ray(vertex.at, wo);
  if (transport == Transport::radiance) ray.spread = walk_detail::spread_of(pdf);
  walk<transport>(path, ray, state, visit);
}

/// The ray of an emitted photon. Its origin is moved off the emitter by the bound of its error.
inline Ray spawn_from_light(const EmissionSample& emission, float time) {
  SurfacePoint at;
  at.position = emission.origin;
  at.position_error = emission.position_error * abs(emission.normal);
  at.normal = emission.normal;
  at.time = time;
  return spawn_ray(at, emission.direction);
}

/// Records the end of a path. `start`: throughput at its start. Russian roulette keeps throughputs about as large;
/// `most` only prevents integer overflow.
inline void note_end(const PathContext& path, const WalkState& end, const Spectrum& start, PathEnds& ends) {
  ++ends.paths;
  if (may_scatter(path, end)) return;
  constexpr float most = 1 << 10;
  const float share =
      walk_detail::magnitude(end.beta, end.dispersed, path.w) / walk_detail::magnitude(start, false, path.w);
  if (share > 0) ends.cut += static_cast<std::uint64_t>(PathEnds::unit * static_cast<double>(std::min(share, most)));
}

/// The initial throughput of a walk. In RGB mode the fourth channel carries no light and is 0, so that media do not
/// sample distances by it.
inline const Spectrum& unit_beta(const Wavelengths& w) {
  static constexpr Spectrum rgb(1, 1, 1, 0), spectral(1);
  return w.mode == ColorMode::rgb ? rgb : spectral;
}

/// A walk from the camera, which is in `medium`. Does nothing if the lens has blocked the ray.
template <class Visit>
void walk_from_camera(const PathContext& path, const CameraRay& start, MediumId medium, Visit&& visit) {
  if (!(start.weight > 0)) return;
  WalkState state;
  state.beta = unit_beta(path.w) * start.weight;
  state.previous = start.ray.origin;
  state.medium = medium;
  walk<Transport::radiance>(path, start.ray, state, visit);
  note_end(path, state, unit_beta(path.w) * start.weight, path.counts.eye);
}

/// A light path before its emission.
struct LightPath {
  const Light& light;
  std::uint32_t index = 0;  ///< of the light in the scene
  float weight = 1;         ///< share of the light's flux that one photon carries (PhotonAllocation)
  const EmissionGuide* guide = nullptr;
};

/// The four numbers in [0,1) that sample the emission of a light path. Takes dimension group 0; group 1 is the
/// caller's.
inline TreeDistribution::Sample emission_numbers(const LightPath& path, Sampler& sampler) {
  sampler.seek(0);
  const Vec2 position = sampler.next2();
  const Vec2 direction = sampler.next2();
  const TreeDistribution::Numbers u{position.x, position.y, direction.x, direction.y};
  return path.guide ? path.guide->lights[path.index].numbers.sample(u) : TreeDistribution::Sample{u, 1};
}

/// Samples the emission. Its densities are the light's own; MIS weights account for the guide by `EmissionDensities`.
inline std::optional<EmissionSample> sample_emission_of(const LightPath& path, Sampler& sampler, const Wavelengths& w) {
  const auto [u, pdf] = emission_numbers(path, sampler);
  const AimedDisks* disks = path.guide && path.guide->disks ? &*path.guide->disks : nullptr;
  std::optional<EmissionSample> emission = sample_emission(path.light, disks, u, w);
  if (emission) emission->flux *= 1 / pdf;
  return emission;
}

/// The walk of one photon. Calls `visit(EmissionSample)` first if the visitor declares it.
template <class Visit>
void walk_from_light(const PathContext& path, const LightPath& start, float time, Visit&& visit) {
  const std::optional<EmissionSample> emission = sample_emission_of(start, path.sampler, path.w);
  if (!emission || emission->flux.is_black()) return;
  const MediumInterface media = path.scene.light_media(start.index);
  if (is_volume(start.light) &&
      !path.scene.lies_in(media.inside, {emission->origin, emission->direction, infinity, time}))
    return;
  if constexpr (requires { visit(*emission); }) visit(*emission);
  WalkState state;
  state.beta = emission->flux * start.weight;
  state.previous = emission->origin;
  state.previous_normal = emission->normal;
  state.medium = dot(emission->direction, emission->normal) < 0 ? media.inside : media.outside;
  if (emission->from_infinity) {
    const Passage way = passage_from_infinity(path, *emission, state.medium, time, visitor_dimensions(0));
    state.beta *= way.transmittance;
    state.medium = way.medium;
    if (state.beta.is_black()) return;
  }
  const Spectrum beta = state.beta;
  walk<Transport::importance>(path, spawn_from_light(*emission, time), state, visit);
  note_end(path, state, beta, path.counts.light);
}

}  // namespace lanthorn
