// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/lens_connection.h"

#include <cmath>

#include "path/transmittance.h"

namespace lanthorn {

namespace {

std::optional<CameraConnection> see_lens(const Scene& scene, const WalkState& state, const Point& from, float time,
                                         Sampler& sampler) {
  sampler.seek(visitor_dimensions(state.depth));
  return scene.camera().connect(from, sampler.next2(), time);
}

// `value`: flux times scattering towards the lens.
std::optional<LensLight> finish(const Scene& scene, const WalkState& state, const CameraConnection& lens,
                                const Ray& ray, MediumId medium, const Spectrum& value, bool dispersive,
                                const Wavelengths& w, Sampler& sampler, RayCounts& counts) {
  const Spectrum arrives =
      transmittance(scene, ray, medium, w, sampler.generator(visitor_dimensions(state.depth)), counts);
  const Spectrum light = value * arrives * (lens.importance * scene.description().film.imaging_ratio);
  if (light.is_black()) return {};
  return LensLight{lens.raster, light, state.dispersed || dispersive,
                   Ray{lens.lens_point, -lens.towards, infinity, ray.time}, lens.distance};
}

}  // namespace

std::optional<LensLight> connect_to_lens(const Scene& scene, const SurfaceVertex& vertex, const Wavelengths& w,
                                         Sampler& sampler, RayCounts& counts) {
  const SurfacePoint& at = vertex.at;
  const auto lens = see_lens(scene, vertex.state, at.position, at.time, sampler);
  if (!lens) return {};
  const Vec3 wo = at.shading.to_local(lens->towards);
  Spectrum value = vertex.state.beta * eval(at.bsdf, vertex.wi_local, wo, Transport::importance);
  value *= geometric_cosine(at, lens->towards) * shading_flux_ratio(at, vertex.wi, vertex.wi_local);
  if (value.is_black()) return {};
  return finish(scene, vertex.state, *lens, spawn_ray_to(at, lens->towards, lens->lens_point, lens->distance),
                medium_towards(at, lens->towards, vertex.state.medium), value, is_dispersive(at.bsdf), w, sampler,
                counts);
}

std::optional<LensLight> connect_to_lens(const Scene& scene, const MediumVertex& vertex, const Wavelengths& w,
                                         Sampler& sampler, RayCounts& counts) {
  const auto lens = see_lens(scene, vertex.state, vertex.position, vertex.time, sampler);
  if (!lens) return {};
  const Spectrum value = vertex.state.beta * phase(vertex.phase, vertex.wi, lens->towards);
  return finish(scene, vertex.state, *lens, {vertex.position, lens->towards, lens->distance, vertex.time},
                vertex.state.medium, value, false, w, sampler, counts);
}

}  // namespace lanthorn
