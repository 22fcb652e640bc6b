// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// Bounding sphere of the scene: what photons from infinitely far lights are aimed at.
struct BoundingSphere {
  Point centre{0};
  float radius = 1;
};

/// A point of an emitting surface, as a ray finds it.
struct EmitterHit {
  Point position{0};
  Normal normal{0, 0, 1};  ///< geometric, unit; after orientation: the side that the shape calls outside
  Vec2 uv{0};              ///< texture coordinates
};

/// Result of next-event sampling, seen from the receiving point.
struct LightSample {
  Direction wi{0, 0, 1};      ///< from the receiving point to the light
  Point position{0};          ///< on the light; meaningless for infinite and distant lights
  Normal normal{0};           ///< geometric normal there; 0 for lights without surface
  float distance = infinity;  ///< infinity for infinite and distant lights
  Spectrum radiance;   ///< L arriving along -wi; for delta lights the intensity/distance² or the irradiance carried
  float pdf = 0;       ///< per solid angle at the receiving point; 1 for lights without extent
  bool delta = false;  ///< no other technique can find this direction
};

/// Result of photon emission.
struct EmissionSample {
  Point origin{0};
  Normal normal{0};  ///< geometric normal at the origin; 0 for lights without surface
  Direction direction{0, 0, 1};
  Spectrum flux;           ///< L_e cos / (p_A p_omega): watts per emitted photon of this light if one photon is emitted
  float pdf_position = 1;  ///< per area (infinite lights: per area of the disk); 1 if the position is a single one
  float pdf_direction = 1;  ///< per solid angle; 1 if the direction is a single one
  float cos_origin = 1;     ///< |cos| between direction and normal; 1 for lights without surface
  /// The origin is on the way of light from infinitely far: what lies on the way before it takes its share of the
  /// photon.
  bool from_infinity = false;
};

struct EmissionPdf {
  float position = 0;   ///< per area
  float direction = 0;  ///< per solid angle
};

}  // namespace lanthorn
