// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/direct_light.h"

#include <optional>

#include "math/power_heuristic.h"
#include "path/mis.h"
#include "path/transmittance.h"

namespace lanthorn {

namespace {

// MIS weight of the walk's hit against next-event estimation, divided by the walk's share of light. `pdf_direction`
// contains the probability with which the walk continued, and beta contains the share. The share concerns indirect
// light only, hence the division.
float hit_weight(const WalkState& state, float pdf_next_event) {
  if (state.last_delta) return 1;
  return power_heuristic(state.pdf_direction, pdf_next_event) / state.share;
}

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

struct Receiver {
  Point position;
  Normal normal;  // 0 in media
};
Receiver receiver(const SurfaceVertex& vertex) { return {vertex.at.position, receiver_normal(vertex.at)}; }
Receiver receiver(const MediumVertex& vertex) { return {vertex.position, Normal(0)}; }

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
  const Receiver at = receiver(vertex);
  const std::optional<SampledLight> chosen = path.scene.light_bvh().sample(at.position, at.normal, path.sampler.next());
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

template <class Vertex>
std::optional<NextEvent> sample_visible(const PathContext& path, const Vertex& vertex) {
  std::optional<NextEvent> e = sample_light(path, vertex);
  see_light(path, vertex, e);
  return e;
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

std::optional<NextEvent> sample_next_event(const PathContext& path, const SurfaceVertex& vertex) {
  return sample_visible(path, vertex);
}

std::optional<NextEvent> sample_next_event(const PathContext& path, const MediumVertex& vertex) {
  return sample_visible(path, vertex);
}

std::optional<NextEvent> sample_next_event_of(const PathContext& path, const MediumVertex& vertex,
                                              const SampledLight& light) {
  std::optional<NextEvent> e = sample_chosen(path, vertex, light, Vec2(0.5f));
  see_light(path, vertex, e);
  return e;
}

Spectrum detail::hit_light(const PathContext& path, const SurfaceVertex& vertex, std::uint32_t index) {
  const Light& light = path.scene.lights()[index];
  const EmitterHit hit{vertex.at.position, vertex.at.normal, vertex.at.uv};
  const Spectrum radiance = emitted(light, hit, vertex.wi, path.w);
  if (radiance.is_black()) return {};
  const WalkState& state = vertex.state;
  float pdf_light = 0;
  if (!state.last_delta)
    pdf_light = path.scene.light_bvh().pmf(state.previous, state.previous_normal, index) *
                pdf_direct(light, state.previous, hit);
  return state.beta * radiance * hit_weight(state, pdf_light);
}

Spectrum hit_volume_emission(const PathContext& path, const EmissionVertex& vertex) {
  const WalkState& state = vertex.state;
  const std::optional<std::uint32_t> index = path.scene.volume_light(state.medium);
  if (!index) return state.beta * vertex.radiance;
  float pdf_light = 0;
  if (!state.last_delta)
    pdf_light = path.scene.light_bvh().pmf(state.previous, state.previous_normal, *index) *
                pdf_direct_towards(path.scene.lights()[*index], state.previous, vertex.direction);
  return state.beta * vertex.radiance * hit_weight(state, pdf_light);
}

Spectrum hit_environment(const PathContext& path, const EscapeVertex& vertex) {
  Spectrum sum;
  const WalkState& state = vertex.state;
  if (state.sky_is_found) return sum;
  for (const std::uint32_t index : path.scene.infinite_lights()) {
    const Light& light = path.scene.lights()[index];
    if (state.depth == 0 && is_hidden_from_camera(light)) continue;
    float pdf_light = 0;
    if (!state.last_delta)
      pdf_light = path.scene.light_bvh().pmf(state.previous, state.previous_normal, index) *
                  pdf_direct_towards(light, state.previous, vertex.direction);
    sum +=
        state.beta * emitted_infinite(light, state.previous, vertex.direction, path.w) * hit_weight(state, pdf_light);
  }
  return sum;
}

}  // namespace lanthorn
