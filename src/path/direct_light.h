// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Direct light by two techniques, next-event estimation and the walk's own hits of emitters, combined by multiple
// importance sampling (Veach 1997, chapter 9). `RayLight` adds samples along rays in media.
#pragma once

#include <cstdint>
#include <optional>

#include "path/path_context.h"
#include "path/vertex.h"

namespace lanthorn {

/// Light from one next-event sample.
struct DirectLight {
  /// state.beta * f * |cos| * L / pdf * MIS weight, radiance (without the factor of dispersion).
  Spectrum radiance;
  /// The path up to and including this vertex met a dispersive interface, so that it is valid at the hero wavelength
  /// only.
  bool dispersed = false;
};

/// One sample of one light, without MIS weight.
struct NextEvent {
  std::uint32_t light = 0;
  float pmf = 0;  ///< probability with which that light was chosen
  LightSample sample;
  /// state.beta * f * |cos| * L / (pmf * pdf); after the visibility test also times the fraction that arrives
  /// (`arriving`).
  Spectrum radiance;
  float pdf_walk = 0;  ///< density with which the walk would sample this direction, per solid angle
  bool dispersed = false;
  float optical_depth = 0;  ///< of the way to the light (`Passage`), once its transmittance has been computed
};
/// Chooses a light by the light BVH and samples it. Empty if there is no light or it is occluded.
template <class Vertex>
std::optional<NextEvent> sample_next_event(const PathContext& path, const Vertex& vertex);
/// The same for a given point-like light, whose sample needs no random numbers.
std::optional<NextEvent> sample_next_event_of(const PathContext& path, const MediumVertex& vertex,
                                              const SampledLight& light);

// Next-event estimation in three steps, for callers that can sometimes skip the shadow ray.

/// Step 1: a sample that ignores occlusion. Empty if its contribution is zero.
std::optional<NextEvent> sample_unshadowed(const PathContext& path, const SurfaceVertex& vertex);
/// Step 2: the factor of its radiance that arrives, by a shadow ray and the transmittance of media. For an emissive
/// medium, whose samples have radiance 1: its emission along the ray.
Spectrum arriving(const PathContext& path, const SurfaceVertex& vertex, const NextEvent& event);
/// Step 3: the sample with its MIS weight against a walk that samples the direction with density `pdf_walk`, per solid
/// angle, and so may hit the light itself.
DirectLight weighted(const NextEvent& event, float pdf_walk);

/// The density, per solid angle, with which a walk that leaves the vertex with this answer samples the event's
/// direction.
inline float walk_density(const NextEvent& event, const Continuation& answer) {
  return answer.goes_on ? event.pdf_walk : 0.0f;
}
inline float walk_density(const NextEvent& event, const GuidedContinuation& answer) {
  return answer.goes_on ? answer.guidance.pdf(event.pdf_walk, event.sample.wi) : 0.0f;
}
inline float walk_density(const NextEvent& event, const NarrowContinuation& answer) {
  if (answer.branches_to_sky() && event.sample.distance == infinity) return event.pdf_walk;
  return answer.towards(event.pdf_walk).probability * event.pdf_walk;
}

/// Direct light at the vertex, on a surface or in a medium, by one sample of one light, which the light BVH chooses.
/// Black if there is no light or it is occluded. `answer`: the visitor's answer to the walk; if it stops the walk,
/// next-event estimation has weight 1.
template <class Vertex, class Answer>
DirectLight next_event(const PathContext& path, const Vertex& vertex, const Answer& answer) {
  const std::optional<NextEvent> event = sample_next_event(path, vertex);
  return event ? weighted(*event, walk_density(*event, answer)) : DirectLight{};
}

/// Emission that the walk has hit, without MIS weight.
struct LightHit {
  /// Index of the light. Empty for the emission of a medium that is not a light: no other technique finds it. Methods
  /// that estimate the light of non-delta lobes otherwise follow a branch for it (`add_unlit_emission`).
  std::optional<std::uint32_t> light;
  EmitterHit at;        ///< of lights without surface any point of the ray
  Direction direction;  ///< of the walk's ray
  int scatterings;      ///< of the walk before
  Spectrum radiance;    ///< times state.beta
};
/// Calls `found(LightHit)` for the emitter that the walk has hit, for the medium that its ray crosses, or for each
/// infinite light when it has left the scene.
template <class Found>
void for_each_hit(const PathContext& path, const SurfaceVertex& v, Found&& found) {
  if (!v.at.light) return;
  const EmitterHit at{v.at.position, v.at.normal, v.at.uv};
  const Spectrum radiance = emitted(path.scene.lights()[*v.at.light], at, v.wi, path.w);
  if (!radiance.is_black()) found(LightHit{v.at.light, at, -v.wi, v.state.depth - 1, v.state.beta * radiance});
}
template <class Found>
void for_each_hit(const PathContext& path, const EmissionVertex& v, Found&& found) {
  found(LightHit{path.scene.volume_light(v.state.medium), EmitterHit{v.state.previous, Normal(0), Vec2(0)}, v.direction,
                 v.state.depth, v.state.beta * v.radiance});
}
template <class Found>
void for_each_hit(const PathContext& path, const EscapeVertex& v, Found&& found) {
  if (v.state.sky_is_found) return;
  for (const std::uint32_t index : path.scene.infinite_lights()) {
    const Light& light = path.scene.lights()[index];
    if (v.state.depth == 0 && is_hidden_from_camera(light)) continue;
    const Spectrum radiance = emitted_infinite(light, v.state.previous, v.direction, path.w);
    if (radiance.is_black()) continue;
    found(LightHit{index, EmitterHit{v.state.previous, Normal(0), Vec2(0)}, v.direction, v.state.depth,
                   v.state.beta * radiance});
  }
}

/// Density, per solid angle at `from`, with which next-event estimation chooses `direction` towards the point `hit` of
/// the light. For point, spot and distant lights it is the probability of choosing the light. Used by MIS weights.
float next_event_density(const Scene& scene, std::uint32_t light, const Point& from, const Normal& normal,
                         const EmitterHit& hit, const Direction& direction);

/// MIS weight of a hit against next-event estimation. Divides by `state.share`, because the previous visitor's part
/// contained indirect light only.
float weight_of_hit(const Scene& scene, const WalkState& state, const LightHit& hit);

/// Light of all hits at the vertex, times their weights.
template <class Vertex>
Spectrum hit_lights(const PathContext& path, const Vertex& vertex) {
  Spectrum sum;
  for_each_hit(path, vertex,
               [&](const LightHit& hit) { sum += hit.radiance * weight_of_hit(path.scene, vertex.state, hit); });
  return sum;
}

/// Light of point-like lights that scatters once, on the rays that eye paths send through media. Next-event estimation
/// from the points where a walk scatters rarely finds a narrow beam in thin fog, and hardly ever the light close to a
/// source. The light of point-like lights is therefore also sampled along the whole ray, as if each point of it
/// scattered (`RayLights`). The balance heuristic combines both techniques, in the measure of light and distance.
///
/// Only rays before the first non-specular scattering use the second technique; later rays are too many for its cost.
class RayLight {
 public:
  /// One sample of the light along the ray. Remembers the ray for `next_event_at`.
  DirectLight along(const PathContext& path, const MediumRay& ray);
  /// Next-event estimation where the walk scatters on the ray seen last, like `next_event`.
  DirectLight next_event_at(const PathContext& path, const MediumVertex& vertex) const;

 private:
  Segment segment_;
  double strength_ = 0;  // of the lights along it; 0: they are not sampled along it
};

}  // namespace lanthorn
