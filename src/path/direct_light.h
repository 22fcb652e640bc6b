// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Direct light by two techniques, next-event estimation and the walk's own hits of emitters, combined by multiple
// importance sampling (Veach 1997, chapter 9).
#pragma once

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
  /// state.beta * f * |cos| * L / (pmf * pdf), times what arrives of it, once that has been computed (`arriving`).
  Spectrum radiance;
  float pdf_walk = 0;  ///< density with which the walk would sample this direction, per solid angle
  bool dispersed = false;
  float optical_depth = 0;  ///< of the way to the light (`Passage`), if its transmittance has been computed
};
/// Chooses a light by the light BVH and samples it. Empty if there is no light or it is occluded.
std::optional<NextEvent> sample_next_event(const PathContext& path, const SurfaceVertex& vertex);
std::optional<NextEvent> sample_next_event(const PathContext& path, const MediumVertex& vertex);

// Next-event estimation in three steps, for callers that can sometimes skip the shadow ray.

/// Step 1: a sample that ignores occlusion. Empty if its contribution is zero.
std::optional<NextEvent> sample_unshadowed(const PathContext& path, const SurfaceVertex& vertex);
/// Step 2: the part of its radiance that arrives, by a shadow ray and the transmittance of media. Of media that emit,
/// whose radiance is 1, all that they send along the ray.
Spectrum arriving(const PathContext& path, const SurfaceVertex& vertex, const NextEvent& event);
/// Step 3: the sample with the MIS weight that `next_event` gives it.
DirectLight weighted(const NextEvent& event, float walk_probability, const Guidance& guidance = {});

/// Direct light at the vertex by one sample of one light, which the light BVH chooses. Black if there is no light or it
/// is occluded. `walk_probability` is the probability with which the walk samples this vertex's non-delta lobes and so
/// can hit emitters itself; with 0, next-event estimation has weight 1. `guidance` must be the walk's at this vertex.
DirectLight next_event(const PathContext& path, const SurfaceVertex& vertex, float walk_probability,
                       const Guidance& guidance = {});

/// The same at a vertex in a medium.
DirectLight next_event(const PathContext& path, const MediumVertex& vertex, float walk_probability);

/// Emission of the surface that the walk has hit, times state.beta and the MIS weight. Divides by
/// `state.non_delta_share`: the part of the light that the previous visitor estimated is indirect light only.
Spectrum hit_emitter(const PathContext& path, const SurfaceVertex& vertex);
/// The same for a medium that the walk's ray crosses. What media that are no lights emit is nobody else's and has
/// weight 1: methods that estimate the light of non-delta lobes otherwise follow a branch for it (`add_unlit_glow`).
Spectrum hit_glow(const PathContext& path, const EmissionVertex& vertex);
/// The same for infinite lights when the walk has left the scene.
Spectrum hit_environment(const PathContext& path, const EscapeVertex& vertex);

}  // namespace lanthorn
