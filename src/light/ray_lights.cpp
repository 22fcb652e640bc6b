// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/ray_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lanthorn {

namespace {

struct Interval {
  double begin = 0, end = 0;
};

/// The interval of t in which o + t d lies in a cone with its tip at the origin and a half angle below 90 degrees. `d`
/// is a unit vector. The cone is convex, so there is one interval: the part of the double cone ((o + t d)·axis)² >=
/// cos² |o + t d|² where (o + t d)·axis >= 0.
Interval part_in_cone(const glm::dvec3& o, const glm::dvec3& d, const glm::dvec3& axis, double cos) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  const double along = glm::dot(o, axis), slope = glm::dot(d, axis), cos2 = cos * cos;
  const double a = slope * slope - cos2, b = along * slope - cos2 * glm::dot(o, d),
               c = along * along - cos2 * glm::dot(o, o);
  const double discriminant = b * b - a * c;
  if (a >= 0) {  // the ray is steeper than the cone's side: one end is infinitely far away
    const double root = std::sqrt(std::max(0.0, discriminant));
    // The two roots; where both vanish, the ray meets the tip along the cone's surface.
    const double q = -(b + std::copysign(root, b)), one = q / a, other = q != 0 ? c / q : one;
    if (!(a > 0)) return slope > 0 ? Interval{other, endless} : Interval{-endless, other};
    return slope > 0 ? Interval{std::max(one, other), endless} : Interval{-endless, std::min(one, other)};
  }
  if (discriminant <= 0) return {};
  const double middle = -b / a, half = std::sqrt(discriminant) / -a;
  return along + middle * slope > 0 ? Interval{middle - half, middle + half} : Interval{};
}

}  // namespace

/// The part of a segment that a source lights, parametrised by the angle at the source.
struct RayLights::LitPart {
  double nearest = 0;         ///< its distance along the segment, m
  double height = 1;          ///< of the source above the segment's line, m
  double begin = 0, end = 0;  ///< angles at the source, from the nearest point, radians

  bool empty() const { return !(end > begin); }
  /// The integral of 1/distance² over the part, 1/m.
  double integral() const { return empty() ? 0 : (end - begin) / height; }
  double angle_of(double distance) const { return std::atan((distance - nearest) / height); }
};

RayLights::RayLights(std::span<const Light> lights) {
  constexpr std::size_t most = 64;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!is_point(lights[i])) continue;
    const std::optional<EmissionBounds> bounds = emission_bounds(lights[i]);
    if (!bounds || !(bounds->intensity > 0)) continue;
    const double half_angle = std::acos(std::clamp(double{bounds->cone.cos}, -1.0, 1.0)) +
                              std::acos(std::clamp(double{bounds->cos_emission}, -1.0, 1.0));
    sources_.push_back({static_cast<std::uint32_t>(i), glm::dvec3(bounds->box.min),
                        glm::normalize(glm::dvec3(bounds->cone.axis)),
                        half_angle < 0.5 * std::numbers::pi ? std::cos(half_angle) : -1, double{bounds->intensity}});
  }
  if (sources_.size() > most) sources_.clear();
}

RayLights::LitPart RayLights::lit_part(const Source& source, const Segment& segment) {
  const glm::dvec3 o = glm::dvec3(segment.origin) - source.position, d = glm::normalize(glm::dvec3(segment.direction));
  LitPart part;
  part.nearest = -glm::dot(o, d);
  // Not below the least height that single precision distinguishes from 0: densities stay finite on rays through the
  // source.
  constexpr double least = 1e-6;
  part.height = std::max(glm::length(o + part.nearest * d), least * (glm::length(o) + 1e-30));
  Interval lit{0, double{segment.length}};
  if (source.cos > 0) {
    const Interval cone = part_in_cone(o, d, source.axis, source.cos);
    lit = {std::max(lit.begin, cone.begin), std::min(lit.end, cone.end)};
  }
  if (lit.end > lit.begin) {
    part.begin = part.angle_of(lit.begin);
    part.end = part.angle_of(lit.end);
  }
  return part;
}

double RayLights::strength(const Segment& segment) const {
  double sum = 0;
  for (const Source& source : sources_) sum += source.intensity * lit_part(source, segment).integral();
  return sum;
}

std::optional<RayLights::Sample> RayLights::sample(const Segment& segment, double strength, float u_light,
                                                   float u_distance) const {
  double rest = double{u_light} * strength;
  for (const Source& source : sources_) {
    const LitPart part = lit_part(source, segment);
    const double own = source.intensity * part.integral();
    if (part.empty() || (rest -= own) >= 0) continue;
    const double angle = part.begin + double{u_distance} * (part.end - part.begin);
    const auto distance = static_cast<float>(part.nearest + part.height * std::tan(angle));
    const float density = pdf(segment, strength, source.light, distance);
    return density > 0 && distance > 0 ? std::optional(Sample{source.light, distance, density}) : std::nullopt;
  }
  return std::nullopt;
}

float RayLights::pdf(const Segment& segment, double strength, std::uint32_t light, float distance) const {
  const auto source = std::lower_bound(sources_.begin(), sources_.end(), light,
                                       [](const Source& s, std::uint32_t index) { return s.light < index; });
  if (source == sources_.end() || source->light != light || !(strength > 0)) return 0;
  const LitPart part = lit_part(*source, segment);
  const double angle = part.angle_of(double{distance});
  if (part.empty() || angle < part.begin || angle > part.end) return 0;
  const double cos = std::cos(angle) / part.height;
  return static_cast<float>(source->intensity * cos * cos / strength);
}

}  // namespace lanthorn
