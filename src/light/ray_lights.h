// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Lights at points as rays through media see them: where on the ray is their light?
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light/light.h"
#include "medium/flight.h"

namespace lanthorn {

/// Samples a light at a point and a distance along a segment, with a density in proportion to the light's intensity
/// over its squared distance, in the part of the segment that its cone contains: equiangular sampling (Kulla & Fajardo
/// 2012, "Importance Sampling Techniques for Path Tracing in Participating Media"), for all such lights together.
/// Occlusion and what the medium absorbs are not considered.
class RayLights {
 public:
  RayLights() = default;
  /// Has no light if there are so many that looking at each of them for every ray would take too long.
  explicit RayLights(std::span<const Light> lights);

  bool empty() const { return sources_.empty(); }

  struct Sample {
    std::uint32_t light = 0;
    float distance = 0;  ///< from the segment's origin, m
    float pdf = 0;       ///< of light and distance, 1/m
  };
  /// The integral of intensity over squared distance along the segment, of all lights.
  double strength(const Segment& segment) const;
  /// `strength`: of the segment; positive. `u_light` and `u_distance` in [0,1).
  std::optional<Sample> sample(const Segment& segment, double strength, float u_light, float u_distance) const;
  /// Density of `sample`; 0 if the light is none of these or its cone does not contain the point.
  float pdf(const Segment& segment, double strength, std::uint32_t light, float distance) const;

 private:
  struct Source {
    std::uint32_t light = 0;
    glm::dvec3 position{0}, axis{0, 0, 1};
    double cos = -1;  ///< of the half angle of the cone of its light; 0 or less: the cone is not looked at
    double intensity = 0;
  };
  struct LitPart;
  static LitPart lit_part(const Source& source, const Segment& segment);

  std::vector<Source> sources_;  ///< by light
};

}  // namespace lanthorn
