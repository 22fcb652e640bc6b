// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/ray_light.h"

#include <cmath>
#include <optional>

#include "path/depth.h"

namespace lanthorn {

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
