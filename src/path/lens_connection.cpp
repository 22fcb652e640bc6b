// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/lens_connection.h"

#include "path/transmittance.h"
#include "path/walk.h"

namespace lanthorn {

namespace {

float time_of(const SurfaceVertex& v) { return v.at.time; }
float time_of(const MediumVertex& v) { return v.time; }

bool is_hidden(const SurfaceVertex& v) { return v.at.is_hidden; }
bool is_hidden(const MediumVertex&) { return false; }

// The point from which light leaves for a point of the lens.
std::optional<Point> leaving_point(const View& view, const SurfaceVertex& v, const Vec2& u_lens) {
  if (!v.at.is_flat_curve) return v.at.position;
  const std::optional<Point> lens = view.camera.lens_point_for(axis_of(v.at), u_lens, v.at.time);
  return lens ? std::optional(leaving_point_towards(v.at, *lens)) : std::nullopt;
}
std::optional<Point> leaving_point(const View&, const MediumVertex& v, const Vec2&) { return v.position; }

// state.beta times the scattering towards the lens, with the cosine of light walks on surfaces.
Spectrum sent_towards(const SurfaceVertex& v, const Direction& lens) {
  const Vec3 wo = v.at.shading.to_local(lens);
  return v.state.beta * evaluate(v.at.bsdf, v.wi_local, wo, Transport::importance, {.f = true}).f *
         (geometric_cosine(v.at, lens) * shading_flux_ratio(v.at, v.wi, v.wi_local));
}
Spectrum sent_towards(const MediumVertex& v, const Direction& lens) {
  return v.state.beta * phase(v.phase, v.wi, lens);
}

Ray ray_to(const SurfaceVertex& v, const CameraConnection& lens) {
  return spawn_ray_to(v.at, lens.towards, {lens.lens_point});
}
Ray ray_to(const MediumVertex& v, const CameraConnection& lens) {
  return {v.position, lens.towards, lens.distance, v.time};
}

bool disperses(const SurfaceVertex& v) { return v.state.dispersed || is_dispersive(v.at.bsdf); }
bool disperses(const MediumVertex& v) { return v.state.dispersed; }

}  // namespace

template <class Vertex>
std::optional<CameraConnection> find_lens(const PathContext& path, const View& view, const Vertex& v) {
  if (is_hidden(v)) return {};
  path.sampler.seek(visitor_dimensions(v.state.depth));
  const Vec2 u_lens = path.sampler.next2();
  const std::optional<Point> from = leaving_point(view, v, u_lens);
  if (!from) return {};
  return view.camera.connect(*from, u_lens, time_of(v));
}
template std::optional<CameraConnection> find_lens(const PathContext&, const View&, const SurfaceVertex&);
template std::optional<CameraConnection> find_lens(const PathContext&, const View&, const MediumVertex&);

template <class Vertex>
std::optional<LensLight> connect_to_lens(const PathContext& path, const View& view, const Vertex& v,
                                         const CameraConnection& lens) {
  std::optional<LensLight> result;
  const Spectrum sent = sent_towards(v, lens.towards);
  if (sent.is_black()) return result;
  const Ray ray = ray_to(v, lens);
  const Passage way = passage_to_lens(path, ray, medium_towards(v, lens.towards), visitor_dimensions(v.state.depth));
  const Spectrum light = sent * way.transmittance * (lens.importance * view.imaging_ratio);
  if (light.is_black()) return result;
  LensLight& seen = result.emplace();
  seen.raster = lens.raster;
  seen.light = light;
  seen.dispersed = disperses(v);
  seen.from_lens.origin = lens.lens_point;
  seen.from_lens.direction = -lens.towards;
  seen.from_lens.time = ray.time;
  seen.distance = lens.distance;
  seen.optical_depth = way.optical_depth;
  return result;
}
template std::optional<LensLight> connect_to_lens(const PathContext&, const View&, const SurfaceVertex&,
                                                  const CameraConnection&);
template std::optional<LensLight> connect_to_lens(const PathContext&, const View&, const MediumVertex&,
                                                  const CameraConnection&);

}  // namespace lanthorn
