// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What a walk tells its visitor. A walk visits vertices on surfaces and in participating media and, at its end, the
// escape from the scene.
#pragma once

#include <optional>

#include "math/vec.h"
#include "medium/flight.h"
#include "medium/medium.h"
#include "medium/phase.h"
#include "path/guidance.h"
#include "scene/surface_point.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// How a walk got to where it is.
struct WalkState {
  /// Eye walks: importance that arrives, the factor of radiance (W_e over the densities of all choices). Light walks:
  /// flux of the photon, watts; with all cosines and densities of the way folded in, without the scattering at this
  /// vertex.
  Spectrum beta{1};
  int depth = 0;            ///< scattering events and the emission before this vertex: 1 at the first surface
  int non_delta = 0;        ///< scatterings so far by lobes that are not delta functions
  bool last_delta = true;   ///< the last direction came from a delta lobe (or the camera): no other technique finds it
  bool dispersed = false;   ///< met an interface that is right for the hero wavelength only (see Wavelengths)
  float pdf_direction = 0;  ///< per solid angle, of the last direction incl. the probability of continuing; 0 if delta
  float non_delta_share = 1;  ///< part of the last vertex's non-delta light that the walk carries (see Continuation)
  Point previous{0};          ///< position of the previous vertex
  Normal previous_normal{0};  ///< shading normal there; 0 at the camera, on lights without surface and in media
  MediumId medium = MediumId::vacuum;  ///< that the walk goes through to reach this vertex
};

/// A surface that the walk has hit. Visitors may read all of it.
struct SurfaceVertex {
  const WalkState& state;
  const SurfacePoint& at;
  Direction wi;      ///< to the previous vertex, world space
  Vec3 wi_local;     ///< the same in the shading frame
  bool may_scatter;  ///< the depth limit allows one more scattering here
};

/// A point in a medium where the walk scatters.
struct MediumVertex {
  const WalkState& state;
  Point position;
  Direction wi;  ///< to the previous vertex, world space
  const HenyeyGreenstein& phase;
  float time;
  bool may_scatter;  ///< the depth limit allows one more scattering here
};

// The way from a vertex to something that it is connected with.

inline Point position_of(const SurfaceVertex& v) { return v.at.position; }
inline Point position_of(const MediumVertex& v) { return v.position; }
/// Shadow ray to `target` (stopping short of it) at `distance` along `direction`; distance may be infinite.
inline Ray ray_to(const SurfaceVertex& v, const Direction& direction, const Point& target, float distance) {
  return spawn_ray_to(v.at, direction, target, distance);
}
inline Ray ray_to(const MediumVertex& v, const Direction& direction, const Point& target, float distance) {
  SurfacePoint at;
  at.position = v.position;
  at.time = v.time;
  return spawn_ray_to(at, direction, target, distance);
}
/// The medium that such a ray starts in.
inline MediumId medium_towards(const SurfaceVertex& v, const Direction& direction) {
  return medium_towards(v.at, direction, v.state.medium);
}
inline MediumId medium_towards(const MediumVertex& v, const Direction&) { return v.state.medium; }

/// Volumetric emission on the way to the next vertex.
struct EmissionVertex {
  const WalkState& state;  ///< as at the start of that way
  Spectrum radiance;       ///< seen from its start
};

/// A straight flight of the walk through one medium or through vacuum, for visitors that look at flights. It is shown
/// before the vertex at its end.
struct FlownSegment {
  const WalkState& state;  ///< at its start; state.medium is what it went through
  Segment segment;         ///< its length ends where the walk scattered or met a surface; infinite if it met nothing
  bool scattered;          ///< it ended in the medium
  Spectrum weight;         ///< the flight's factor of state.beta
  /// Density with which it ended there, per metre, or probability with which it got through. None if not known (see
  /// Flight).
  std::optional<float> pdf;
};

/// The walk left the scene.
struct EscapeVertex {
  const WalkState& state;
  Direction direction;  ///< of the ray that left, away from the scene
};

/// A visitor's answer: whether and how the walk goes on.
///
/// A visitor that estimates part of the light of the non-delta lobes itself (a cache) says so with `non_delta_share`:
/// what is left to the walk is that share of the non-delta light and all of the delta lobes' light.
struct Continuation {
  float probability = 1;  ///< with which the visitor lets walks like this one go on; the walk divides by it. 0: stop
  float non_delta_share = 1;  ///< in [0,1]

  static constexpr Continuation go_on() { return {}; }
  static constexpr Continuation stop() { return {0, 0}; }
};

/// The answer of a visitor that also guides the walk's next direction. Its type says so, so that walks of other
/// visitors have nothing to ask. Whoever guides tells `next_event` the same.
struct GuidedContinuation : Continuation {
  Guidance guidance;
};

}  // namespace lanthorn
