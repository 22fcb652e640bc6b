// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Direct light by two techniques, next-event estimation and the walk's own hits of emitters, joined by multiple
// importance sampling (Veach 1997, chapter 9).
#pragma once

#include <string>
#include <vector>

#include "path/path_context.h"
#include "path/vertex.h"

namespace lanthorn {

/// Light from one next-event sample.
struct DirectLight {
  /// state.beta * f * |cos| * L / pdf * MIS weight, radiance (without the factor of dispersion).
  Spectrum radiance;
  /// The path met an interface that is right for the hero wavelength only, up to and including this vertex.
  bool dispersed = false;
};

/// One sample of one light, unweighted, for methods that know more techniques than two.
struct NextEvent {
  std::uint32_t light = 0;
  float pmf = 0;  ///< with which that light was chosen
  LightSample sample;
  Spectrum radiance;   ///< state.beta * f * |cos| * L / (pmf * pdf), times the transmittance where that is known
  float pdf_walk = 0;  ///< per solid angle, with which the walk would go there
  bool dispersed = false;
};
/// Chooses a light by the light BVH; empty if there is none or it is occluded.
std::optional<NextEvent> sample_next_event(const PathContext& path, const SurfaceVertex& vertex);
std::optional<NextEvent> sample_next_event(const PathContext& path, const MediumVertex& vertex);

/// The parts of next-event estimation, for those who may know what is on the way. First a sample as if nothing were;
/// empty if no light could arrive.
std::optional<NextEvent> sample_unshadowed(const PathContext& path, const SurfaceVertex& vertex);
/// Then the part of it that arrives.
Spectrum arriving(const PathContext& path, const SurfaceVertex& vertex, const NextEvent& event);
/// And its weight, as `next_event` has it.
DirectLight weighted(const NextEvent& event, float walk_probability, const Guidance& guidance = {});

/// Direct light at the vertex by one sample of one light, chosen by the light BVH; black if there is none or it is
/// occluded. `walk_probability` is that with which the walk will sample this vertex's non-delta lobes and so find
/// emitters itself: 0 gives next-event estimation the whole weight. `guidance` is what guides the walk there.
DirectLight next_event(const PathContext& path, const SurfaceVertex& vertex, float walk_probability,
                       const Guidance& guidance = {});

/// The same at a vertex in a medium.
DirectLight next_event(const PathContext& path, const MediumVertex& vertex, float walk_probability);

/// Radiance, times state.beta and the MIS weight, that the walk finds by having hit the emitter at this vertex; undoes
/// the share of light that an earlier visitor took on itself, since that share is of indirect light only.
Spectrum hit_emitter(const PathContext& path, const SurfaceVertex& vertex);
/// The same for infinite lights when the walk has left the scene.
Spectrum hit_environment(const PathContext& path, const EscapeVertex& vertex);

/// Which layer light belongs to, by Heckbert's path strings read from the eye, D standing for any non-delta scattering:
/// E S* L emission, E S* D L direct, E S* D S+ L caustic, all else indirect.
enum class PathClass : std::uint8_t { emission, direct, indirect, caustic };
inline constexpr std::size_t path_class_count = 4;
/// Their names: the light layers of films whose methods tell them apart.
inline std::vector<std::string> path_class_names() { return {"emission", "direct", "indirect", "caustic"}; }

/// Class of light that the walk finds by hitting an emitter.
inline PathClass class_of_hit(const WalkState& state) {
  if (state.non_delta == 0) return PathClass::emission;
  if (state.non_delta > 1) return PathClass::indirect;
  return state.last_delta ? PathClass::caustic : PathClass::direct;
}
/// Class of volumetric emission on the way from a vertex that the walk left in this state: the medium is the emitter.
inline PathClass class_of_emission(const WalkState& state) { return class_of_hit(state); }
/// Class of light that next-event estimation finds at a vertex of a walk in this state.
inline PathClass class_of_next_event(const WalkState& state) {
  return state.non_delta == 0 ? PathClass::direct : PathClass::indirect;
}

}  // namespace lanthorn
