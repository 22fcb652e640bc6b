// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/direct_light.h"

#include <cmath>
#include <optional>

#include "math/sampling.h"
#include "path/depth.h"
#include "path/mis.h"
#include "path/transmittance.h"

namespace lanthorn {

namespace {

// Scattering at a vertex of light from a given direction.
struct Scattering {
  Spectrum f;          // 1/sr, times the cosine on surfaces
  float pdf_walk = 0;  // density with which the walk would sample this direction, per solid angle
  bool dispersed = false;
};

Scattering scatter_towards(const SurfaceVertex& vertex, const Direction& wi) {
  const Bsdf& bsdf = vertex.at.bsdf;
  const Vec3 wo = vertex.at.shading.to_local(wi);
  const BsdfValue value = evaluate(bsdf, vertex.wi_local, wo, Transport::radiance, {.f = true, .pdf = true});
  if (value.f.is_black()) return {};
  return {value.f * cosine(bsdf, wo), value.pdf, is_dispersive(bsdf)};
}

Scattering scatter_towards(const MediumVertex& vertex, const Direction& wi) {
  const float p = phase(vertex.phase, vertex.wi, wi);
  return {Spectrum(p), p, false};
}

template <class Vertex>
std::optional<NextEvent> sample_chosen(const PathContext& path, const Vertex& vertex, const SampledLight& chosen,
                                       const Vec2& u) {
  std::optional<NextEvent> result;
  const Light& light = path.scene.lights()[chosen.light];
  const std::optional<LightSample> l = sample_direct(light, position_of(vertex), u, path.w);
  if (!l) return result;

  const Scattering scattering = scatter_towards(vertex, l->wi);
  if (scattering.f.is_black()) return result;
  const float pdf = chosen.pmf * l->pdf;
  NextEvent& event = result.emplace();
  event.light = chosen.light;
  event.pmf = chosen.pmf;
  event.sample = *l;
  event.radiance = vertex.state.beta * scattering.f * l->radiance * (1 / pdf);
  event.pdf_walk = scattering.pdf_walk;
  event.dispersed = vertex.state.dispersed || scattering.dispersed;
  return result;
}

template <class Vertex>
std::optional<NextEvent> sample_light(const PathContext& path, const Vertex& vertex) {
  const std::optional<SampledLight> chosen =
      path.scene.light_bvh().sample(position_of(vertex), receiver_normal(vertex), path.sampler.next());
  if (!chosen) return {};
  return sample_chosen(path, vertex, *chosen, path.sampler.next2());
}

template <class Vertex>
Passage passage_to(const PathContext& path, const Vertex& vertex, const NextEvent& event) {
  const LightSample& l = event.sample;
  if (!may_leave(path, vertex, l.wi, end_at(l))) return {};
  const Ray ray = ray_to_light(vertex, l);
  const MediumId medium = medium_towards(vertex, l.wi);
  const std::uint32_t dimensions = visitor_dimensions(vertex.state.depth);
  if (is_volume(path.scene.lights()[event.light]))
    return {volume_emission(path, ray, medium, path.scene.light_media(event.light).inside, dimensions)};
  return passage(path, ray, medium, dimensions);
}

// Multiplies the sample's radiance by the fraction that arrives; empties it if none does. In place: each copy of such a
// result makes the processor wait.
template <class Vertex>
void see_light(const PathContext& path, const Vertex& vertex, std::optional<NextEvent>& e) {
  if (!e) return;
  const Passage way = passage_to(path, vertex, *e);
  e->radiance *= way.transmittance;
  e->optical_depth = way.optical_depth;
  if (e->radiance.is_black()) e.reset();
}

}  // namespace

std::optional<NextEvent> sample_unshadowed(const PathContext& path, const SurfaceVertex& vertex) {
  return sample_light(path, vertex);
}

Spectrum arriving(const PathContext& path, const SurfaceVertex& vertex, const NextEvent& event) {
  return passage_to(path, vertex, event).transmittance;
}

// Transmittance is part of neither technique's density: it multiplies both contributions and leaves the weight as it
// is.
DirectLight weighted(const NextEvent& event, float pdf_walk) {
  return {event.radiance * power_heuristic(event.pmf * event.sample.pdf, event.sample.delta ? 0.0f : pdf_walk),
          event.dispersed};
}

template <class Vertex>
std::optional<NextEvent> sample_next_event(const PathContext& path, const Vertex& vertex) {
  std::optional<NextEvent> e = sample_light(path, vertex);
  see_light(path, vertex, e);
  return e;
}
template std::optional<NextEvent> sample_next_event(const PathContext&, const SurfaceVertex&);
template std::optional<NextEvent> sample_next_event(const PathContext&, const MediumVertex&);

std::optional<NextEvent> sample_next_event_of(const PathContext& path, const MediumVertex& vertex,
                                              const SampledLight& light) {
  std::optional<NextEvent> e = sample_chosen(path, vertex, light, Vec2(0.5f));
  see_light(path, vertex, e);
  return e;
}

float next_event_density(const Scene& scene, std::uint32_t index, const Point& from, const Normal& normal,
                         const EmitterHit& hit, const Direction& direction) {
  const Light& light = scene.lights()[index];
  const float chosen = scene.light_bvh().pmf(from, normal, index);
  if (has_surface(light)) return chosen * pdf_direct(light, from, hit);
  return is_infinite(light) || is_volume(light) ? chosen * pdf_direct_towards(light, from, direction) : chosen;
}

// `pdf_direction` contains the probability with which the walk continued, and beta contains the share.
float weight_of_hit(const Scene& scene, const WalkState& state, const LightHit& hit) {
  if (state.last_delta || !hit.light) return 1;
  const float next_event =
      next_event_density(scene, *hit.light, state.previous, state.previous_normal, hit.at, hit.direction);
  return power_heuristic(state.pdf_direction, next_event) / state.share;
}

namespace {

// Density per metre with which walks scatter at a point of the segment, as MIS weights take it.
float scattering_density(const Medium& medium, const Point& p, float distance, const Wavelengths& w) {
  return collision_density(medium, p, w) * std::exp(-mean_extinction(medium, w) * distance);
}

}  // namespace

DirectLight RayLight::along(const PathContext& path, const MediumRay& ray) {
  strength_ = 0;
  const Scene& scene = path.scene;
  const RayLights& lights = scene.ray_lights();
  if (lights.empty() || ray.state.non_delta > 0 || scatterings_on_flight(scene, ray.state) > path.limits.max_depth)
    return {};
  const Medium& medium = scene.medium(ray.state.medium);
  if (!scatters(medium)) return {};
  segment_ = ray.segment;
  strength_ = lights.strength(segment_);
  if (!(strength_ > 0)) return {};

  HashRng numbers = path.sampler.generator(visitor_dimensions(0));
  const Vec2 u = numbers.next2();
  const auto chosen = lights.sample(segment_, strength_, u.x, u.y);
  if (!chosen) return {};
  WalkState state = ray.state;
  come_to_vertex(scene, state);
  const Point position = segment_.origin + chosen->distance * segment_.direction;
  const Spectrum scattered = scattering_at(medium, position, path.w);
  if (scattered.is_black()) return {};
  const MediumVertex vertex{state, position, -segment_.direction, phase_of(medium), ray.time, true};
  const std::optional<NextEvent> event = sample_next_event_of(path, vertex, {chosen->light, 1});
  if (!event) return {};
  const Segment way{segment_.origin, segment_.direction, chosen->distance};
  const float other = scattering_density(medium, position, chosen->distance, path.w) *
                      scene.light_bvh().pmf(position, Normal(0), chosen->light);
  return {event->radiance * transmittance(medium, way, path.w, numbers) * scattered * (1 / (chosen->pdf + other)),
          event->dispersed};
}

DirectLight RayLight::next_event_at(const PathContext& path, const MediumVertex& vertex) const {
  std::optional<NextEvent> event = sample_next_event(path, vertex);
  if (!event) return {};
  DirectLight light = weighted(*event, event->pdf_walk);
  if (!(strength_ > 0) || vertex.state.non_delta > 0 || !event->sample.delta) return light;
  const float distance = std::sqrt(distance_squared(vertex.position, segment_.origin));
  const Medium& medium = path.scene.medium(vertex.state.medium);
  const float own = scattering_density(medium, vertex.position, distance, path.w) * event->pmf;
  const float along = path.scene.ray_lights().pdf(segment_, strength_, event->light, distance);
  light.radiance *= own / (own + along);
  return light;
}

}  // namespace lanthorn
