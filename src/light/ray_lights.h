// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Importance sampling of point-like lights along a ray through a medium.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light/light.h"
#include "medium/flight.h"

namespace lanthorn {

/// Samples a point-like light together with a distance along a segment. The density is proportional to the light's
/// intensity over its squared distance, within the part of the segment that lies in the light's cone: equiangular
/// sampling (Kulla & Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating Media"), jointly
/// for all such lights. Occlusion and extinction are ignored.
class RayLights {
 public:
  RayLights() = default;
  /// Takes the point-like lights among `lights`, or none if there are more than 64: each ray would have to visit all.
  explicit RayLights(std::span<const Light> lights);

  bool empty() const { return sources_.empty(); }

  struct Sample {
    std::uint32_t light = 0;
    float distance = 0;  ///< from the segment's origin, m
    float pdf = 0;       ///< of light and distance, 1/m
  };
  /// Integral of intensity over squared distance along the segment, summed over all lights.
  double strength(const Segment& segment) const;
  /// `strength`: the result of `strength(segment)`; must be positive. `u_light` and `u_distance` in [0,1).
  std::optional<Sample> sample(const Segment& segment, double strength, float u_light, float u_distance) const;
  /// Density of `sample`; 0 if the light is none of these or its cone does not contain the point.
  float pdf(const Segment& segment, double strength, std::uint32_t light, float distance) const;

 private:
  struct Source {
    std::uint32_t light = 0;
    glm::dvec3 position{0}, axis{0, 0, 1};
    double cos = -1;  ///< of the half angle of the light's cone; if <= 0, the cone is ignored
    double intensity = 0;
  };
  struct LitPart;
  static LitPart lit_part(const Source& source, const Segment& segment);

  std::vector<Source> sources_;  ///< by light
};

}  // namespace lanthorn
