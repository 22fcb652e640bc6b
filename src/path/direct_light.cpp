// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/direct_light.h"

#include <optional>

#include "path/mis.h"

namespace lanthorn {

namespace {

// Weight of the walk's hit against next-event estimation, over the share of non-delta light that it carries. The walk's
// density contains the probability of having gone on, its beta the share: direct light is not shared, so the share is
// taken out again.
float hit_weight(const WalkState& state, float pdf_next_event) {
  if (state.last_delta) return 1;
  return mis_weight(state.pdf_direction, pdf_next_event) / state.non_delta_share;
}

}  // namespace

DirectLight next_event(const Scene& scene, const SurfaceVertex& vertex, float walk_probability, const Wavelengths& w,
                       Sampler& sampler, RayCounts& counts) {
  const SurfacePoint& at = vertex.at;
  const std::optional<SampledLight> chosen = scene.light_bvh().sample(at.position, at.shading.n, sampler.next());
  if (!chosen) return {};
  const Light& light = scene.lights()[chosen->light];
  const std::optional<LightSample> l = sample_direct(light, at.position, sampler.next2(), w);
  if (!l) return {};

  const Vec3 wo = at.shading.to_local(l->wi);
  const Spectrum f = eval(at.bsdf, vertex.wi_local, wo, Transport::radiance);
  if (f.is_black()) return {};
  ++counts.shadow;
  if (!scene.visible(spawn_ray_to(at, l->wi, l->position, l->distance))) return {};

  const float pdf_light = chosen->pmf * l->pdf;
  const float pdf_walk =
      l->delta || walk_probability == 0 ? 0.0f : walk_probability * pdf(at.bsdf, vertex.wi_local, wo);
  const float factor = abs_cos_theta(wo) / pdf_light * mis_weight(pdf_light, pdf_walk);
  return {vertex.state.beta * f * l->radiance * factor, vertex.state.dispersed || is_dispersive(at.bsdf)};
}

Spectrum hit_emitter(const Scene& scene, const SurfaceVertex& vertex, const Wavelengths& w) {
  if (!vertex.at.light) return {};
  const std::uint32_t index = *vertex.at.light;
  const Light& light = scene.lights()[index];
  const Spectrum radiance = emitted(light, vertex.at.normal, vertex.wi, w);
  if (radiance.is_black()) return {};
  const WalkState& state = vertex.state;
  float pdf_light = 0;
  if (!state.last_delta)
    pdf_light = scene.light_bvh().pmf(state.previous, state.previous_normal, index) *
                pdf_direct(light, state.previous, vertex.at.position, vertex.at.normal);
  return state.beta * radiance * hit_weight(state, pdf_light);
}

Spectrum hit_environment(const Scene& scene, const EscapeVertex& vertex, const Wavelengths& w) {
  Spectrum sum;
  const WalkState& state = vertex.state;
  for (const std::uint32_t index : scene.infinite_lights()) {
    const Light& light = scene.lights()[index];
    float pdf_light = 0;
    if (!state.last_delta)
      pdf_light = scene.light_bvh().pmf(state.previous, state.previous_normal, index) *
                  pdf_direct_infinite(light, vertex.direction);
    sum += state.beta * emitted_infinite(light, vertex.direction, w) * hit_weight(state, pdf_light);
  }
  return sum;
}

}  // namespace lanthorn
