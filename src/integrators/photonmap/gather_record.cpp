// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/photonmap/gather_cache.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "photon/gather/photon_gather.h"

namespace lanthorn {

namespace {

// A gather ray that also records the distance to its first hit.
struct RangedVisitor {
  TwoPassVisitor inner;
  float& distance;

  void note(const WalkState& state, const Point& p) {
    if (std::isinf(distance)) distance = std::sqrt(distance_squared(state.previous, p));
  }
  NarrowContinuation operator()(const SurfaceVertex& vertex) {
    note(vertex.state, vertex.at.position);
    return inner(vertex);
  }
  Continuation operator()(const MediumVertex& vertex) {
    note(vertex.state, vertex.position);
    return inner(vertex);
  }
  void operator()(const EmissionVertex& vertex) { inner(vertex); }
  void operator()(const EscapeVertex& vertex) { inner(vertex); }
};

// Follows a pixel's eye path, as TwoPassVisitor does, to the diffuse surface that it sees. Calls
// `see(vertex, cache, length)` there, with the pass's cache for it and the length of the path, m.
template <class See>
class FillVisitor {
 public:
  FillVisitor(const GatherFill& fill, See& see) : fill_(fill), see_(see) {}

  NarrowContinuation operator()(const SurfaceVertex& vertex) {
    length_ += std::sqrt(distance_squared(vertex.state.previous, vertex.at.position));
    if (vertex.state.non_delta > 0 || !vertex.may_scatter) return {Continuation::stop()};
    if (!has_non_delta(vertex.at.bsdf)) return {Continuation::go_on()};
    if (const IrradianceCache* cache = cache_for(fill_.maps, vertex)) {
      see_(vertex, static_cast<std::size_t>(cache - fill_.maps.gathered.data()), length_);
      return {Continuation::stop()};
    }
    return narrow_lobes(split_lobes(vertex));
  }
  Continuation operator()(const MediumVertex&) const { return Continuation::stop(); }
  void operator()(const EscapeVertex&) const {}

 private:
  const GatherFill& fill_;
  See& see_;
  float length_ = 0;
};

// The pixel's own eye path of this pass.
template <class See>
void follow_eye_path(const GatherFill& fill, const PixelPlace& place, RayCounts& counts, See&& see) {
  Sampler sampler = eye_sampler(fill.job, place, fill.pass);
  const PathDraw draw = fill.maps.draw.of_eye_path(sampler, place.x, place.y);
  const EyeStart start = start_eye_path(fill.job, place, fill.pass, draw.time, sampler);
  const auto see_from = [&](const SurfaceVertex& vertex, std::size_t cache, float length) {
    see(start.camera.ray, vertex, cache, length);
  };
  const PathContext path{fill.job.scene, draw.w, sampler, counts, {fill.job.settings.max_depth, 3}};
  walk_from_camera(path, start.camera, fill.job.view.medium, FillVisitor(fill, see_from));
}

// One ray of a record: as in TwoPassVisitor::gather, but in a direction of the hemisphere's grid and without the
// reflectance.
HemisphereRay gather_ray(const GatherFill& fill, std::uint32_t key, const SurfaceVertex& vertex, const Frame& frame,
                         int cell, RayCounts& counts) {
  const int depth = vertex.state.depth;
  const std::uint64_t own_key = hash_words({key, static_cast<std::uint64_t>(depth)});
  Sampler own =
      Sampler::for_pixel(fill.job.settings.seed, Stream::irradiance, static_cast<std::uint32_t>(own_key),
                         fill.pass * static_cast<std::uint32_t>(fill.grid.cells()) + static_cast<std::uint32_t>(cell));
  const Wavelengths w = fill.maps.draw.of_path(own).w;
  own.seek(walk_dimensions(depth));
  const Vec3 local = fill.grid.direction(cell, own.next2());
  const Direction wo = frame.to_world(local);
  HemisphereRay ray;
  // The hemisphere of a shading normal reaches below the facet.
  const Vec3 wo_local = vertex.at.shading.to_local(wo);
  if (evaluate(vertex.at.bsdf, vertex.wi_local, wo_local, Transport::radiance, {.f = true}).f.is_black()) return ray;
  LightLayers layers(w);
  const TwoPassContext context{fill.job, fill.settings, fill.maps, key, fill.pass, &fill.misses};
  const PathContext path{fill.job.scene, w, own, counts, {fill.job.settings.max_depth, 3}};
  walk_towards<Transport::radiance>(
      path, vertex, wo, pdf_cosine_hemisphere(local.z), unit_beta(w),
      RangedVisitor{TwoPassVisitor::of_gather_ray({path, layers}, context, vertex.state.non_delta + 1), ray.distance});
  for (const PathClass path_class : {PathClass::direct, PathClass::caustic, PathClass::indirect})
    ray.radiance += layers.light(path_class);
  return ray;
}

IrradianceRecord gather(const GatherFill& fill, std::uint32_t key, const SurfaceVertex& vertex, RayCounts& counts) {
  Frame frame = vertex.at.shading;
  frame.n = normal_of_light(vertex);
  std::vector<HemisphereRay> rays(static_cast<std::size_t>(fill.grid.cells()));
  for (int cell = 0; cell < fill.grid.cells(); ++cell)
    rays[static_cast<std::size_t>(cell)] = gather_ray(fill, key, vertex, frame, cell, counts);
  return estimate_irradiance(fill.grid, rays, frame);
}

}  // namespace

SeenPoint seen_from(const GatherFill& fill, const PixelPlace& place, RayCounts& counts) {
  SeenPoint seen;
  follow_eye_path(fill, place, counts,
                  [&](const Ray& camera_ray, const SurfaceVertex& vertex, std::size_t cache, float length) {
                    const float density = fill.job.view.camera.density_at(camera_ray, length);
                    const float widest = fill.job.scene.bounding_sphere().radius;
                    const float pixel = density > 0 ? std::min(widest, 1 / std::sqrt(density)) : widest;
                    seen = {vertex.at.position, normal_of_light(vertex), pixel, cache};
                  });
  return seen;
}

IrradianceRecord planned_record(const SeenPoint& seen, const GatherCacheSettings& settings) {
  IrradianceRecord record;
  record.position = seen.position;
  record.normal = seen.normal;
  record.distance = 0;
  record.least = settings.least * seen.pixel / settings.error;
  return record;
}

IrradianceRecord make_record(const GatherFill& fill, const PixelPlace& place, const SeenPoint& seen,
                             RayCounts& counts) {
  const GatherCacheSettings& settings = *fill.settings.cache;
  IrradianceRecord record;
  follow_eye_path(fill, place, counts, [&](const Ray&, const SurfaceVertex& vertex, std::size_t, float) {
    record = gather(fill, fill.job.view.pixel_key(place.x, place.y), vertex, counts);
  });
  const IrradianceRecord planned = planned_record(seen, settings);
  record.position = planned.position;
  record.normal = planned.normal;
  record.least = planned.least;
  record.distance = std::min(record.distance, settings.most * seen.pixel / settings.error);
  return record;
}

}  // namespace lanthorn
