// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// A point of an emitter, sampled uniformly by area with density 1 / area.
struct EmitterPoint {
  Point point{0};
  Normal normal{0, 0, 1};  ///< natural geometric normal, unit
};

/// A point of an emitter, sampled from a receiving point.
struct EmitterDirection {
  Point point{0};
  Normal normal{0, 0, 1};  ///< natural geometric normal, unit
  Direction wi{0, 0, 1};   ///< from the receiving point to the emitter
  float distance = 0;      ///< metres
  float pdf = 0;           ///< per solid angle at the receiving point
};

/// A cone that contains all natural normals of an emitter.
struct NormalCone {
  Direction axis{0, 0, 1};
  float cos = -1;  ///< cosine of the half angle; -1: any normal
};

/// Kind of a light. Every light has a static member `traits` of this type, and the members that `LightSource` (light.h)
/// requires of its kind.
struct LightTraits {
  const char* name;        ///< in summaries of scenes
  bool has_surface;        ///< rays can meet it
  bool is_infinite;        ///< rays that leave the scene see it
  bool is_far;             ///< its light comes from infinitely far away: true of all infinite and distant lights
  bool is_volume = false;  ///< it is a medium: rays gather its emission along their way
};

/// Bounding sphere of the scene, at which photons from infinitely distant lights are aimed.
struct BoundingSphere {
  Point centre{0};
  float radius = 1;
};

/// A point of an emitting surface hit by a ray.
struct EmitterHit {
  Point position{0};
  Normal normal{0, 0, 1};  ///< geometric, unit, after orientation: on the side that the shape calls outside
  Vec2 uv{0};              ///< texture coordinates
};

/// Result of next-event sampling, seen from the receiving point.
struct LightSample {
  Direction wi{0, 0, 1};  ///< from the receiving point to the light
  Point position{0};      ///< on the light; undefined for infinite and distant lights; for media the receiving point
  Normal normal{0};       ///< geometric normal of the light there; 0 for lights without surface
  float distance = infinity;  ///< infinity for infinite and distant lights
  float position_error = 0;   ///< bound of the distance between `position` and the surface that rays meet, metres
  Spectrum radiance;   ///< L arriving along -wi; for delta lights intensity/distance² or irradiance; for media 1
  float pdf = 0;       ///< per solid angle at the receiving point; 1 for lights without extent
  bool delta = false;  ///< no other technique can find this direction
};

/// Result of photon emission.
struct EmissionSample {
  Point origin{0};
  Normal normal{0};          ///< geometric normal at the origin; 0 for lights without surface
  float position_error = 0;  ///< bound of the distance between the origin and the surface that rays meet, metres
  Direction direction{0, 0, 1};
  Spectrum flux;  ///< L_e cos / (p_A p_omega): watts per emitted photon of this light if one photon is emitted
  float pdf_position =
      1;  ///< per area (infinite lights: of the disk; media: volume); 1 if the position is a single one
  float pdf_direction = 1;  ///< per solid angle; 1 if the direction is a single one
  float cos_origin = 1;     ///< |cos| between direction and normal; 1 for lights without surface
  /// The origin lies on the path of light from infinity: media and surfaces before the origin attenuate the photon.
  bool from_infinity = false;
};

/// The numbers in [0,1]² from which a light sampled a ray. Empty if the light needs none or its sampling has no
/// inverse; densities are then averaged over them.
struct EmissionNumbers {
  std::optional<Vec2> position{}, direction{};
};

struct EmissionPdf {
  float position = 0;   ///< per area (media: across the ray)
  float direction = 0;  ///< per solid angle
};

}  // namespace lanthorn
