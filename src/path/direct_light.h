// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Direct light by two techniques, next-event estimation and the walk's own hits of emitters, combined by multiple
// importance sampling (Veach 1997, chapter 9).
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

/// One sample of one light, without MIS weight, for methods with more than two techniques.
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
std::optional<NextEvent> sample_next_event(const PathContext& path, const SurfaceVertex& vertex);
std::optional<NextEvent> sample_next_event(const PathContext& path, const MediumVertex& vertex);
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

namespace detail {
Spectrum hit_light(const PathContext& path, const SurfaceVertex& vertex, std::uint32_t light);
}

/// Emission of the surface that the walk has hit, times state.beta and the MIS weight. Divides by `state.share`,
/// because the previous visitor's part contained indirect light only.
inline Spectrum hit_emitter(const PathContext& path, const SurfaceVertex& vertex) {
  return vertex.at.light ? detail::hit_light(path, vertex, *vertex.at.light) : Spectrum();
}
/// The same for a medium that the walk's ray crosses. No other technique samples emission from media that are not
/// lights, so its weight is 1. Methods that estimate the light of non-delta lobes otherwise follow a branch for it
/// (`add_unlit_emission`).
Spectrum hit_volume_emission(const PathContext& path, const EmissionVertex& vertex);
/// The same for infinite lights when the walk has left the scene.
Spectrum hit_environment(const PathContext& path, const EscapeVertex& vertex);

}  // namespace lanthorn
