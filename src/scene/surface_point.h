// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reference: Pharr, Jakob, Humphreys 2023, "Physically Based Rendering" 4e, §6.8.6.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "math/frame.h"
#include "math/ray.h"
#include "math/vec.h"
#include "medium/medium.h"
#include "surface/bsdf.h"

namespace lanthorn {

/// A point on a surface with all data that light transport needs.
struct SurfacePoint {
  // With a defaulted constructor, `optional::emplace` would set the whole point to zero first.
  SurfacePoint() {}  // NOLINT(modernize-use-equals-default)
  Point position{0};
  Vec3 position_error{0};  ///< bound of the rounding error of `position`, per axis, metres
  Normal normal{0, 0, 1};  ///< geometric, unit; on the side that the shape's orientation calls outside
  Frame shading;  ///< interpolated normal, in the hemisphere of `normal`; the closure's directions are local to it
  Vec2 uv{0};     ///< 0 on quadrics where neither material nor emission depends on the place
  std::optional<std::uint32_t> light;  ///< the emitter this surface belongs to, an index into Scene::lights()
  float time = 0;
  MediumInterface media;
  bool is_interface = false;  ///< no surface, only an interface of media; the closure is undefined
  bool is_hidden = false;     ///< rays from the camera pass through
  /// A flat curve: a ribbon that faces every ray. `normal` faces the ray that has met it; `shading.s` runs along it.
  bool is_flat_curve = false;
  /// A flat curve of hair. `position` lies on its axis.
  bool is_hair = false;
  /// Of a flat curve, metres: from `position` to the curve's axis along `normal` x `shading.s`; and the offset from the
  /// axis at which rays leave, see `leaving_point`.
  float to_axis = 0, leaves_at = 0;
  /// Height, metres along `normal`, of the smooth surface over a facet that stands in for it; not 0 only where the
  /// smooth surface bulges out on the side from which the ray came. Light that the facet itself would block leaves from
  /// there (`offset_origin`).
  float rise = 0;
  PointBsdf bsdf;
};

/// |cos| factor of the flux through the surface along a direction. The angle is measured from the geometric normal; for
/// a hair, whose width faces all directions, from the plane perpendicular to the hair.
inline float geometric_cosine(const SurfacePoint& at, const Direction& w) {
  return at.is_hair ? safe_sqrt(1 - sqr(dot(w, at.shading.s))) : std::fabs(dot(w, at.normal));
}

/// |cos| that turns the density of rays along `w`, per area across them, into one per area of the surface that they
/// meet. Differs from `geometric_cosine` on flat curves that are no hair, because these turn towards the rays.
inline float area_cosine(const SurfacePoint& at, const Direction& w) {
  return at.is_flat_curve ? safe_sqrt(1 - sqr(dot(w, at.shading.s))) : std::fabs(dot(w, at.normal));
}

/// True if `wi` and `w` are on different sides of an opaque surface. Flat curves have no sides, since they turn to each
/// ray.
inline bool is_behind(const SurfacePoint& at, const Direction& wi, const Direction& w) {
  return !at.is_flat_curve && dot(wi, at.normal) * dot(w, at.normal) < 0 && is_opaque(at.bsdf);
}
/// True if a ray in `direction` leaves an opaque facet towards its back, but from the smooth surface over it.
inline bool leaves_from_smooth_surface(const SurfacePoint& at, const Direction& direction) {
  return at.rise * dot(direction, at.normal) < 0;
}

/// `area_cosine` for light along `w` at a point that the eye sees along `wi`: 0 where no light walk can arrive, because
/// the opaque surface is in its way.
inline float arrival_cosine(const SurfacePoint& at, const Direction& wi, const Direction& w) {
  return is_behind(at, wi, w) ? 0.0f : area_cosine(at, w);
}

/// Normal of a receiver of light; zero if it receives from all directions alike (hair).
inline Normal receiver_normal(const SurfacePoint& at) { return at.is_hair ? Normal(0) : at.shading.n; }

/// The medium that the surface declares towards `direction`; `current`, the medium around the point, if it bounds no
/// media.
inline MediumId medium_towards(const SurfacePoint& at, const Direction& direction, MediumId current) {
  if (!at.media.is_transition()) return current;
  return dot(direction, at.normal) > 0 ? at.media.outside : at.media.inside;
}

namespace detail {

/// The neighbouring float in the direction of `offset`'s sign, because the sum may have been rounded the other way.
inline float rounded_away(float x, float offset) {
  if (x == 0) return offset == 0 ? x : std::copysign(std::numeric_limits<float>::denorm_min(), offset);
  // Without branches, because zeros and signs of the coordinates of normals are unpredictable.
  const std::uint32_t away = (x > 0) == (offset > 0) ? 1u : ~0u, step = offset == 0 ? 0u : away;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) + step);
}

/// Upper bound of the rounding error of a hit perpendicular to the surface, per metre of the ray's length. In single
/// precision, the test of a triangle rounds three things a few times each: the corners relative to the ray's origin,
/// the normal and the distance.
inline constexpr float tracing_error = 0x1p-20f;

}  // namespace detail

/// A point of the axis of a flat curve.
inline Point axis_of(const SurfacePoint& at) { return at.position + at.to_axis * cross(at.normal, at.shading.s); }

/// The part of a direction across a flat curve, unit; the normal for directions along the curve.
inline Direction across_curve(const SurfacePoint& at, const Direction& w) {
  const Vec3 across = w - dot(w, at.shading.s) * at.shading.s;
  const float length2 = length_squared(across);
  return length2 > 1e-12f ? across / std::sqrt(length2) : at.normal;
}

/// Where a ray in `direction` leaves the surface. Rays of any direction see a flat curve as a ribbon that faces them,
/// so that no point of one ribbon is a point of all others. Therefore the width at which a ray leaves is independent of
/// the width at which another ray has arrived: `leaves_at`, uniform over the width, across the ray that leaves. Walks
/// from the eye and from lights then make the same paths with the same densities.
inline Point leaving_point(const SurfacePoint& at, const Direction& direction) {
  if (!at.is_flat_curve) return at.position;
  return axis_of(at) + at.leaves_at * cross(across_curve(at, direction), at.shading.s);
}
/// Likewise for the ray through the point `to`.
inline Point leaving_point_towards(const SurfacePoint& at, const Point& to) {
  if (!at.is_flat_curve) return at.position;
  const Point axis = axis_of(at);
  const Vec3 way = to - axis, across = way - dot(way, at.shading.s) * at.shading.s;
  const float distance = std::sqrt(length_squared(across));
  if (!(distance > std::fabs(at.leaves_at))) return leaving_point(at, normalize(way));
  // Across the curve, the ray is the tangent from `to` to the circle about the axis with radius leaves_at.
  const Vec3 towards = across / distance;
  const float sin = at.leaves_at / distance, cos = safe_sqrt(1 - sin * sin);
  return axis + at.leaves_at * (cos * cross(towards, at.shading.s) + sin * towards);
}

/// Bound of the rounding error of the position across the surface, metres.
inline float position_error_across(const SurfacePoint& at) { return dot(abs(at.normal), at.position_error); }

/// Origin of a ray that leaves the surface in `direction`, offset by the error bound (pbrt 4e, §6.8) so that the ray
/// cannot hit the surface again. Rays that would lead through the facet start on the smooth surface, so that shadows
/// end as smoothly as the shading does (Hanika 2021, "Hacking the Shadow Terminator", Ray Tracing Gems II, chapter 4).
inline Point offset_origin(const SurfacePoint& at, const Direction& direction) {
  if (at.is_flat_curve) return leaving_point(at, direction) + position_error_across(at) * across_curve(at, direction);
  const float distance = position_error_across(at), along = dot(direction, at.normal);
  const float height =
      at.rise * along < 0 ? at.rise + std::copysign(distance, at.rise) : (along < 0 ? -distance : distance);
  const Vec3 offset = height * at.normal;
  const Point p = at.position + offset;
  return {detail::rounded_away(p.x, offset.x), detail::rounded_away(p.y, offset.y),
          detail::rounded_away(p.z, offset.z)};
}

/// Makes `ray` one that leaves the surface.
inline void leave_surface(const SurfacePoint& at, const Direction& direction, Ray& ray) {
  ray.origin = offset_origin(at, direction);
  ray.direction = direction;
  ray.t_max = infinity;
  ray.time = at.time;
  ray.width = ray.spread = 0;
}
/// A ray that leaves the surface.
inline Ray spawn_ray(const SurfacePoint& at, const Direction& direction) {
  Ray ray;
  leave_surface(at, direction, ray);
  return ray;
}

/// The rest of a ray that goes on straight through a surface which it has met.
inline Ray pass_surface(const SurfacePoint& at, const Ray& ray) {
  if (!at.is_flat_curve) return spawn_ray(at, ray.direction);
  const float reach = dot(at.position - ray.origin, ray.direction) + position_error_across(at);
  return {ray.origin + reach * ray.direction, ray.direction, infinity, at.time};
}

/// The end of a segment: a point in space, or a point on a surface. In the latter case, `segment_to` stops short of the
/// surface.
struct SegmentEnd {
  Point position{0};
  Normal normal{0};  ///< geometric, unit, of either side; 0 in space
  float error = 0;   ///< bound of the distance between the position and the surface that rays meet, metres
};
/// The end of a segment from the point `from`.
inline SegmentEnd end_at(const SurfacePoint& at, const Point& from) {
  if (!at.is_flat_curve) return {at.position, at.normal, position_error_across(at)};
  const Point end = leaving_point_towards(at, from);
  return {end, across_curve(at, from - end), position_error_across(at)};
}

/// The ray from `origin` to the end. If a surface lies there, the ray stops short of it by the bound of all rounding
/// errors: it meets whatever lies in between, and never that surface.
inline Ray segment_to(const SegmentEnd& end, const Point& origin, const Direction& if_empty, float time) {
  Vec3 way = end.position - origin;
  const float margin = end.error + detail::tracing_error * std::sqrt(length_squared(way));
  way += (dot(way, end.normal) > 0 ? -margin : margin) * end.normal;
  const float length = std::sqrt(length_squared(way));
  if (!(length > 0)) return {origin, if_empty, 0, time};
  return {origin, way / length, length, time};
}
/// A ray from the surface to the end, which lies in `direction`. It aims at the end from its actual origin; otherwise
/// rays would miss close lights.
inline Ray spawn_ray_to(const SurfacePoint& at, const Direction& direction, const SegmentEnd& end) {
  return segment_to(end, offset_origin(at, direction), direction, at.time);
}
/// The rest of a segment beyond a surface on it.
inline Ray continue_segment(const SurfacePoint& at, const Ray& ray) {
  if (!std::isfinite(ray.t_max)) return pass_surface(at, ray);
  if (at.is_flat_curve) {
    Ray rest = pass_surface(at, ray);
    rest.t_max = ray.t_max - dot(rest.origin - ray.origin, ray.direction);
    return rest;
  }
  const Ray rest = spawn_ray_to(at, ray.direction, {ray.origin + ray.t_max * ray.direction});
  return dot(rest.direction, ray.direction) > 0 ? rest : Ray{rest.origin, ray.direction, 0, ray.time};
}

}  // namespace lanthorn
