// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The events that a walk passes to its visitor: vertices on surfaces and in participating media, and the escape from
// the scene at its end.
#pragma once

#include <cmath>
#include <optional>

#include "light/sample.h"
#include "math/vec.h"
#include "medium/flight.h"
#include "medium/medium.h"
#include "medium/phase.h"
#include "path/lobe_split.h"
#include "scene/surface_point.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

class DirectionGuide;

/// Path guiding at a vertex: the walk draws its next direction from the guide with probability `share`, otherwise from
/// the closure. This is defensive sampling: the closure's part of the mixture covers directions that the guide misses
/// (direction_guide.cpp).
struct Guidance {
  const DirectionGuide* guide = nullptr;  ///< null if share is 0
  float share = 0;                        ///< in [0,1)

  /// Draws a direction from the guide, world space. Empty if the guide has no flux.
  std::optional<Direction> sample(const Vec2& u) const;
  /// Density of the mixture, per solid angle, for a direction (world space) that the closure alone samples with density
  /// `closure_pdf`. Not for delta lobes.
  float pdf(float closure_pdf, const Direction& direction) const;
};

/// State of a walk at a vertex.
struct WalkState {
  /// Throughput. Eye walks: incident importance, the factor of radiance (W_e divided by the densities of all choices).
  /// Light walks: flux of the photon, watts. Includes all cosines and densities so far, but not the scattering at this
  /// vertex.
  Spectrum beta{1};
  int depth = 0;           ///< scattering events and emission before this vertex: 1 at the first surface
  int under_surface = 0;   ///< of these, those that the depth limit does not count (path/depth.h)
  int non_delta = 0;       ///< scatterings so far by lobes that are not delta functions
  bool last_delta = true;  ///< the last direction came from a delta lobe or the camera: no other technique samples it
  bool dispersed = false;  ///< met a dispersive interface: valid at the hero wavelength only (see Wavelengths)
  bool sky_is_found = false;  ///< a branch from the last vertex has looked for infinite lights (`branches_to_sky`)
  float pdf_direction = 0;  ///< of the last direction, per solid angle, times the probability of continuing; 0 if delta
  float share = 1;          ///< part of the last direction's light that the walk carries (WalkShare)
  Point previous{0};        ///< position of the previous vertex
  Normal previous_normal{0};  ///< shading normal there; 0 at the camera, on lights without surface and in media
  MediumId medium = MediumId::vacuum;  ///< the medium along the segment to this vertex

  /// As `depth`, by the count of the depth limit.
  int scatterings() const { return depth - under_surface; }
};

/// A vertex on a surface.
struct SurfaceVertex {
  const WalkState& state;
  const SurfacePoint& at;
  Direction wi;      ///< to the previous vertex, world space
  Vec3 wi_local;     ///< the same in the shading frame
  bool may_scatter;  ///< the depth limit allows one more scattering here
};

/// A vertex in a medium, where the walk scatters.
struct MediumVertex {
  const WalkState& state;
  Point position;
  Direction wi;  ///< to the previous vertex, world space
  const HenyeyGreenstein& phase;
  float time;
  bool may_scatter;  ///< the depth limit allows one more scattering here
};

// What techniques ask of a vertex, on a surface or in a medium.

inline Point position_of(const SurfaceVertex& v) { return v.at.position; }
inline Point position_of(const MediumVertex& v) { return v.position; }
/// Normal by which next-event estimation chooses a light for the vertex; 0 in media and on hair.
inline Normal receiver_normal(const SurfaceVertex& v) { return receiver_normal(v.at); }
inline Normal receiver_normal(const MediumVertex&) { return Normal(0); }
/// Shadow ray to the end, which lies in `direction`.
inline Ray ray_to(const SurfaceVertex& v, const Direction& direction, const SegmentEnd& end) {
  return spawn_ray_to(v.at, direction, end);
}
inline Ray ray_to(const MediumVertex& v, const Direction& direction, const SegmentEnd& end) {
  return segment_to(end, v.position, direction, v.time);
}
/// Shadow ray in `direction` that leaves the scene.
inline Ray ray_towards(const SurfaceVertex& v, const Direction& direction) { return spawn_ray(v.at, direction); }
inline Ray ray_towards(const MediumVertex& v, const Direction& direction) {
  return {v.position, direction, infinity, v.time};
}
inline SegmentEnd end_at(const LightSample& l) { return {l.position, l.normal, l.position_error}; }
/// Shadow ray to a point of a light.
template <class Vertex>
Ray ray_to_light(const Vertex& v, const LightSample& l) {
  return std::isfinite(l.distance) ? ray_to(v, l.wi, end_at(l)) : ray_towards(v, l.wi);
}
/// The medium in which such a ray starts. A ray that stays on the side from which the walk came, as all do at opaque
/// surfaces, stays in the walk's medium. This holds even if the shape declares another medium there, as opaque shapes
/// do that are inside out.
inline MediumId medium_towards(const SurfaceVertex& v, const Direction& direction) {
  if (!v.at.media.is_transition() || is_opaque(v.at.bsdf) ||
      (dot(direction, v.at.normal) > 0) == (dot(v.wi, v.at.normal) > 0))
    return v.state.medium;
  return medium_towards(v.at, direction, v.state.medium);
}
inline MediumId medium_towards(const MediumVertex& v, const Direction&) { return v.state.medium; }

/// Volumetric emission along the segment to the next vertex.
struct EmissionVertex {
  const WalkState& state;  ///< at the start of the segment
  Direction direction;     ///< of the segment
  Spectrum radiance;       ///< at the start of the segment
};

/// A ray of the walk through a medium, up to the next surface or interface, before it is decided where on it the walk
/// scatters.
struct MediumRay {
  const WalkState& state;  ///< at its start; state.medium is the medium
  Segment segment;         ///< infinite if the ray leaves the scene
  float time;
};

/// A straight flight of the walk through one medium or through vacuum. Visitors that declare it get it before the
/// vertex at its end.
struct FlownSegment {
  const WalkState& state;  ///< at its start; state.medium is the medium of the flight
  Segment segment;         ///< up to the scattering event or the surface; infinite if the ray leaves the scene
  float reach;             ///< metres from its start to the next surface; infinite if there is none
  bool scattered;          ///< it ended in the medium
  Spectrum weight;         ///< the flight's factor of state.beta
  float optical_depth;     ///< of the segment, as in `Attenuation`
  /// Density per metre with which the flight ended there if it scattered, otherwise the probability of no scattering.
  /// Empty if unknown (see Flight).
  std::optional<float> pdf;
  /// Normals of the surfaces or interfaces where the flight begins and where it would reach the next one, on either
  /// side; 0 if there is none.
  Normal begin_normal{0}, end_normal{0};
};

/// The walk left the scene.
struct EscapeVertex {
  const WalkState& state;
  Direction direction;  ///< of the ray that left the scene
};

/// The part of the light that a walk carries on in one direction.
struct WalkShare {
  float part = 1;         ///< of the direction's light, in [0,1]; the visitor has found the rest
  float probability = 1;  ///< with which the walk goes there, in (0,1], or 0 if it has no part; the walk divides by it
};

/// A visitor's answer: whether the walk goes on. The visitor must pass the same answer to `next_event`.
///
/// `towards(pdf)` is the walk's share in a direction that the closure samples with density `pdf` (1/sr; infinite for
/// delta lobes). `branches_to_sky()`: the visitor follows a branch in a direction of the closure up to infinite lights
/// (`add_sky`); the walk's next hit of them then counts only after a delta lobe.
struct Continuation {
  bool goes_on = true;

  static constexpr Continuation go_on() { return {true}; }
  static constexpr Continuation stop() { return {false}; }
  constexpr WalkShare towards(float /*pdf*/) const { return {1, goes_on ? 1.0f : 0.0f}; }
  static constexpr bool branches_to_sky() { return false; }
};

// Other answers have types of their own, so that other visitors' walks do not pay for them.

/// The answer of a visitor that also guides the walk's next direction.
struct GuidedContinuation : Continuation {
  Guidance guidance;
};

/// The answer of a visitor that estimates the light of wide lobes itself, from a cache. The walk carries the part of
/// narrow lobes; it continues with probability `eagerness` times that part, at most 1.
struct NarrowContinuation : Continuation {
  LobeSplit split = LobeSplit::all_narrow();
  float eagerness = 1;
  bool has_sky_branch = false;

  /// The answer at a vertex whose light `split` divides.
  static NarrowContinuation of(const LobeSplit& split, float eagerness = 1) {
    return {{!split.is_all_wide()}, split, eagerness};
  }
  /// The same, with a branch that looks for the sky unless the walk continues in all directions.
  static NarrowContinuation with_sky_branch(const LobeSplit& split, float eagerness = 1) {
    return {{!split.is_all_wide()}, split, eagerness, !split.is_all_narrow()};
  }
  bool branches_to_sky() const { return has_sky_branch; }
  WalkShare towards(float pdf) const {
    const float narrow = goes_on ? split.narrow(pdf) : 0.0f;
    return {narrow, std::fmin(1.0f, eagerness * narrow)};
  }
};

/// The answer of a walk that stands in for a cache: it finds the light of wide lobes.
struct WideContinuation : GuidedContinuation {
  LobeSplit split;
  float factor = 1;  ///< 1 / number of such walks

  WalkShare towards(float pdf) const { return {factor * split.wide(pdf), 1}; }
};

}  // namespace lanthorn
