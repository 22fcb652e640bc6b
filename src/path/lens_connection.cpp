// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/lens_connection.h"

#include <cmath>

#include "path/transmittance.h"
#include "path/walk.h"

namespace lanthorn {

namespace {

// `start(u_lens)`: the point from which light leaves for that point of the lens.
template <class Start>
std::optional<CameraConnection> find_lens_from(const PathContext& path, const View& view, const WalkState& state,
                                               float time, Start&& start) {
  path.sampler.seek(visitor_dimensions(state.depth));
  const Vec2 u_lens = path.sampler.next2();
  const std::optional<Point> from = start(u_lens);
  return from ? view.camera.connect(*from, u_lens, time) : std::nullopt;
}

// `value`: flux times scattering towards the lens.
std::optional<LensLight> finish(const PathContext& path, const View& view, const WalkState& state,
                                const CameraConnection& lens, const Ray& ray, MediumId medium, const Spectrum& value,
                                bool dispersive) {
  const Passage way = passage_to_lens(path, ray, medium, visitor_dimensions(state.depth));
  const Spectrum light = value * way.transmittance * (lens.importance * view.imaging_ratio);
  if (light.is_black()) return {};
  return LensLight{lens.raster,
                   light,
                   state.dispersed || dispersive,
                   Ray{lens.lens_point, -lens.towards, infinity, ray.time},
                   lens.distance,
                   way.optical_depth};
}

}  // namespace

std::optional<CameraConnection> find_lens(const PathContext& path, const View& view, const SurfaceVertex& vertex) {
  const SurfacePoint& at = vertex.at;
  if (at.is_hidden) return {};
  return find_lens_from(path, view, vertex.state, at.time, [&](const Vec2& u_lens) -> std::optional<Point> {
    if (!at.is_flat_curve) return at.position;
    const std::optional<Point> lens = view.camera.lens_point_for(axis_of(at), u_lens, at.time);
    return lens ? std::optional(leaving_point_towards(at, *lens)) : std::nullopt;
  });
}

std::optional<CameraConnection> find_lens(const PathContext& path, const View& view, const MediumVertex& vertex) {
  return find_lens_from(path, view, vertex.state, vertex.time,
                        [&](const Vec2&) { return std::optional(vertex.position); });
}

std::optional<LensLight> connect_to_lens(const PathContext& path, const View& view, const SurfaceVertex& vertex,
                                         const CameraConnection& lens) {
  const SurfacePoint& at = vertex.at;
  const Vec3 wo = at.shading.to_local(lens.towards);
  Spectrum value = vertex.state.beta * evaluate(at.bsdf, vertex.wi_local, wo, Transport::importance, {.f = true}).f;
  value *= geometric_cosine(at, lens.towards) * shading_flux_ratio(at, vertex.wi, vertex.wi_local);
  if (value.is_black()) return {};
  return finish(path, view, vertex.state, lens, spawn_ray_to(at, lens.towards, {lens.lens_point}),
                medium_towards(vertex, lens.towards), value, is_dispersive(at.bsdf));
}

std::optional<LensLight> connect_to_lens(const PathContext& path, const View& view, const MediumVertex& vertex,
                                         const CameraConnection& lens) {
  const Spectrum value = vertex.state.beta * phase(vertex.phase, vertex.wi, lens.towards);
  return finish(path, view, vertex.state, lens, {vertex.position, lens.towards, lens.distance, vertex.time},
                vertex.state.medium, value, false);
}

}  // namespace lanthorn
