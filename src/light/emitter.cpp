// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/emitter.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "math/frame.h"
#include "math/hash.h"
#include "math/sampling.h"

namespace lanthorn {
namespace {

/// Density by area turned into density by solid angle.
float pdf_by_area(float area, const Point& from, const Point& hit, const Normal& normal) {
  const Vec3 d = hit - from;
  const float distance2 = length_squared(d);
  const float cos = std::fabs(dot(normal, d)) / std::sqrt(distance2);
  const float pdf = distance2 / (cos * area);
  return std::isfinite(pdf) ? pdf : 0;
}

std::optional<EmitterDirection> direction_to(const EmitterPoint& s, float area, const Point& from) {
  const float pdf = pdf_by_area(area, from, s.point, s.normal);
  if (!(pdf > 0)) return {};
  const Vec3 d = s.point - from;
  const float distance = std::sqrt(length_squared(d));
  return EmitterDirection{s.point, s.normal, d / distance, distance, pdf};
}

/// Random numbers for what rejection needs beyond `u`.
HashRng rejection_rng(const Vec2& u) {
  return HashRng(hash_words({std::bit_cast<std::uint32_t>(u.x), std::bit_cast<std::uint32_t>(u.y)}));
}

/// Point of [0,1)² with density proportional to `density(p)` <= `bound(p)`, from proposals `propose(u)` with density
/// proportional to `bound`. After many rejections takes what it has: only shapes that are degenerate get there.
template <class Propose, class Density, class BoundAt>
Vec2 sample_by_rejection(Vec2 u, Propose&& propose, Density&& density, BoundAt&& bound) {
  constexpr int most_tries = 10000;
  HashRng rng = rejection_rng(u);
  for (int i = 1;; ++i) {
    const Vec2 p = propose(u);
    if (rng.next() * bound(p) <= density(p) || i == most_tries) return p;
    u = rng.next2();
  }
}

/// Integral over [0,1]² by Gauss-Legendre quadrature with 3 x 3 points in each of cells x cells cells.
template <class F>
float integrate(int cells, F&& f) {
  constexpr std::array<double, 3> offset{0.1127016653792583, 0.5, 0.8872983346207417};
  constexpr std::array<double, 3> weight{5.0 / 18, 8.0 / 18, 5.0 / 18};
  const auto at = [&](int i) {
    const int cell = i / 3;
    return static_cast<float>((cell + offset[static_cast<unsigned>(i % 3)]) / cells);
  };
  double total = 0;
  for (int i = 0; i < 3 * cells; ++i)
    for (int j = 0; j < 3 * cells; ++j)
      total += weight[static_cast<unsigned>(i % 3)] * weight[static_cast<unsigned>(j % 3)] *
               static_cast<double>(f(Vec2(at(i), at(j))));
  return static_cast<float>(total / (static_cast<double>(cells) * cells));
}

// Affine maps stretch the area around normal n by |cofactor(M) n|, and map n to cofactor(M) n / det(M).

glm::mat3 cofactor(const glm::mat3& m) { return {cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])}; }
float stretch(const glm::mat3& linear, const Normal& n) { return std::sqrt(length_squared(cofactor(linear) * n)); }
Normal map_normal(const glm::mat3& linear, const Normal& n) {
  const Vec3 mapped = cofactor(linear) * n;
  const float sign = glm::determinant(linear) < 0 ? -1.0f : 1.0f;
  return mapped * (sign / std::sqrt(length_squared(mapped)));
}

/// Bound of the stretch over normals in the span of the first `dimensions` axes, by Gershgorin's theorem (tight for
/// scales along the axes); 0 if the stretch is the same for all of them.
float max_stretch(const glm::mat3& linear, int dimensions) {
  const glm::mat3 c = cofactor(linear);
  const glm::mat3 gram = glm::transpose(c) * c;
  float bound = 0, deviation = 0;
  for (int i = 0; i < dimensions; ++i) {
    float row = 0;
    for (int j = 0; j < dimensions; ++j) {
      row += std::fabs(gram[i][j]);
      deviation = std::fmax(deviation, std::fabs(gram[i][j] - (i == j ? gram[0][0] : 0.0f)));
    }
    bound = std::fmax(bound, row);
  }
  return deviation <= 2e-5f * gram[0][0] ? 0.0f : std::sqrt(bound) * 1.00001f;
}

/// The area density of a patch, the norm of |dp/du x dp/dv|: that vector, linear in (u, v), at each corner.
struct PatchJacobian {
  Vec3 j00, j10, j01, j11;

  explicit PatchJacobian(const PatchEmitter& patch) {
    const Vec3 along_u = patch.p10 - patch.p00, along_v = patch.p01 - patch.p00;
    const Vec3 twist = (patch.p11 - patch.p01) - along_u;
    j00 = cross(along_u, along_v);
    j10 = cross(along_u, along_v + twist);
    j01 = cross(along_u + twist, along_v);
    j11 = j10 + j01 - j00;
  }
  Vec3 at(const Vec2& uv) const { return j00 + uv.x * (j10 - j00) + uv.y * (j01 - j00); }
};

float norm(const Vec3& v) { return std::sqrt(length_squared(v)); }

/// x in [0,1] with density proportional to the line from a to b.
float sample_linear(float u, float a, float b) {
  if (a == b) return u;
  return std::fmin(u * (a + b) / (a + std::sqrt(lerp(u, a * a, b * b))), one_minus_epsilon);
}

}  // namespace

TriangleEmitter::TriangleEmitter(const Point& p0, const Point& p1, const Point& p2) : p{p0, p1, p2} {
  const Vec3 doubled = cross(p1 - p0, p2 - p0);
  const float length = norm(doubled);
  area = 0.5f * length;
  if (length > 0) normal = doubled / length;
}

EmitterPoint TriangleEmitter::sample_area(const Vec2& u) const {
  const Vec2 b = sample_uniform_triangle(u);
  return {p[0] + b.x * (p[1] - p[0]) + b.y * (p[2] - p[0]), normal};
}

namespace {

/// The triangle seen from a point as a spherical triangle.
struct SphericalTriangle {
  std::array<Direction, 3> v;
  float det, dots, base;  ///< |v0 v1 v2|, (v0 + v1).v2, 1 + v0.v1
  float solid_angle;      ///< sr, in [0, 2 pi] (van Oosterom & Strackee 1983)

  SphericalTriangle(const TriangleEmitter& t, const Point& from) {
    float lengths = 1;
    for (unsigned i = 0; i < 3; ++i) {
      v[i] = t.p[i] - from;
      const float length = norm(v[i]);
      lengths *= length;
      v[i] /= length;
    }
    // By the height above the plane: the determinant of nearly parallel unit vectors would cancel.
    det = std::fabs(dot(t.normal, t.p[0] - from)) * 2 * t.area / lengths;
    dots = dot(v[0] + v[1], v[2]);
    base = 1 + dot(v[0], v[1]);
    solid_angle = 2 * std::atan2(det, dots + base);
  }

  /// Below, area sampling is as good; above, the point lies almost in the triangle.
  bool well_conditioned() const { return solid_angle > 2e-5f && solid_angle < 6.2f; }

  /// Peters 2021, §3: v2 moves towards v0 until the rest has the solid angle u.x * all, then u.y picks on the arc from
  /// v1 to it. h is the direction half way between v0 and the moved vertex.
  Direction sample(const Vec2& u) const {
    const float half = 0.5f * u.x * solid_angle;
    const float sin = std::sin(half), cos = std::cos(half);
    const Vec3 h = (det * cos - dots * sin) * v[0] + (base * sin) * v[2];
    const float h2 = length_squared(h);
    const Direction moved = h2 > 0 ? (2 * dot(v[0], h) / h2) * h - v[0] : v[0];
    const Vec3 chord = moved - v[1];
    const float one_minus_cos = u.y * 0.5f * length_squared(chord);
    const Vec3 tangent = chord - dot(chord, v[1]) * v[1];
    const float tangent_length = norm(tangent);
    if (!(tangent_length > 0)) return v[1];
    return (1 - one_minus_cos) * v[1] + (safe_sqrt(one_minus_cos * (2 - one_minus_cos)) / tangent_length) * tangent;
  }
};

/// Where the ray meets the triangle's plane (Möller & Trumbore 1997), moved into the triangle if rounding put it
/// outside.
std::optional<Point> intersect(const TriangleEmitter& t, const Point& from, const Direction& direction) {
  const Vec3 e1 = t.p[1] - t.p[0], e2 = t.p[2] - t.p[0], offset = from - t.p[0];
  const Vec3 q = cross(direction, e2);
  const float det = dot(e1, q);
  const float b1 = std::clamp(dot(offset, q) / det, 0.0f, 1.0f);
  const float b2 = std::clamp(dot(direction, cross(offset, e1)) / det, 0.0f, 1.0f - b1);
  if (!std::isfinite(b1 + b2)) return {};
  return t.p[0] + b1 * e1 + b2 * e2;
}

}  // namespace

namespace {

/// Whether the triangle looks so small from `from` that its points differ little in their cosine and distance: area
/// sampling is then about as good as sampling by solid angle, at a third of its cost. Far is beyond four times the
/// longest edge.
bool is_far(const TriangleEmitter& t, const Point& from) {
  const Vec3 e1 = t.p[1] - t.p[0], e2 = t.p[2] - t.p[0];
  const float size2 = std::max({length_squared(e1), length_squared(e2), distance_squared(t.p[1], t.p[2])});
  return distance_squared(from, t.p[0]) > 16 * size2;
}

}  // namespace

std::optional<EmitterDirection> TriangleEmitter::sample_towards(const Point& from, const Vec2& u) const {
  if (is_far(*this, from)) return direction_to(sample_area(u), area, from);
  const SphericalTriangle triangle(*this, from);
  if (!triangle.well_conditioned()) return direction_to(sample_area(u), area, from);
  const std::optional<Point> hit = intersect(*this, from, triangle.sample(u));
  if (!hit) return {};
  const Vec3 d = *hit - from;
  const float distance = norm(d);
  return EmitterDirection{*hit, normal, d / distance, distance, 1 / triangle.solid_angle};
}

float TriangleEmitter::pdf_towards(const Point& from, const Point& hit, const Normal& normal_at_hit) const {
  if (is_far(*this, from)) return pdf_by_area(area, from, hit, normal_at_hit);
  const SphericalTriangle triangle(*this, from);
  return triangle.well_conditioned() ? 1 / triangle.solid_angle : pdf_by_area(area, from, hit, normal_at_hit);
}

PatchEmitter::PatchEmitter(const Point& p00_, const Point& p10_, const Point& p01_, const Point& p11_)
    : p00(p00_), p10(p10_), p01(p01_), p11(p11_) {
  const PatchJacobian jacobian(*this);
  area = integrate(8, [&](const Vec2& uv) { return norm(jacobian.at(uv)); });
}

EmitterPoint PatchEmitter::sample_area(const Vec2& u) const {
  // The norm of a linear function is convex, so that bilinear interpolation of the corners bounds it.
  const PatchJacobian jacobian(*this);
  const float w00 = norm(jacobian.j00), w10 = norm(jacobian.j10), w01 = norm(jacobian.j01), w11 = norm(jacobian.j11);
  const auto propose = [&](const Vec2& x) {
    const float v = sample_linear(x.y, w00 + w10, w01 + w11);
    return Vec2(sample_linear(x.x, lerp(v, w00, w01), lerp(v, w10, w11)), v);
  };
  const auto density = [&](const Vec2& uv) { return norm(jacobian.at(uv)); };
  // A flat patch meets its bound up to rounding and rejects nothing.
  const auto bound = [&](const Vec2& uv) {
    return (1 - 1e-5f) * lerp(uv.y, lerp(uv.x, w00, w10), lerp(uv.x, w01, w11));
  };
  const Vec2 uv = sample_by_rejection(u, propose, density, bound);
  const Vec3 n = jacobian.at(uv);
  const Point left = p00 + uv.y * (p01 - p00), right = p10 + uv.y * (p11 - p10);
  return {left + uv.x * (right - left), n / norm(n)};
}

SphereEmitter::SphereEmitter(const Transform& object_to_world, float radius_, float z_min_, float z_max_,
                             float phi_max_)
    : linear(object_to_world.matrix),
      centre(object_to_world.point(Point(0))),
      radius(radius_),
      z_min(std::clamp(std::fmin(z_min_, z_max_), -radius_, radius_)),
      z_max(std::clamp(std::fmax(z_min_, z_max_), -radius_, radius_)),
      phi_max(std::clamp(phi_max_, 0.0f, 2 * pi)),
      max_stretch(lanthorn::max_stretch(linear, 3)) {
  // Over the polar angle the integrand is smooth at the poles.
  const float theta0 = std::acos(z_max / radius), theta1 = std::acos(z_min / radius);
  const float mean = max_stretch == 0
                         ? stretch(linear, {0, 0, 1}) * (z_max - z_min) / radius
                         : (theta1 - theta0) * integrate(64, [&](const Vec2& u) {
                             const float theta = lerp(u.x, theta0, theta1), phi = u.y * phi_max;
                             const float sin = std::sin(theta);
                             return sin * stretch(linear, {sin * std::cos(phi), sin * std::sin(phi), std::cos(theta)});
                           });
  area = phi_max * radius * radius * mean;
  const bool whole = z_min == -radius && z_max == radius && phi_max > 2 * pi * (1 - 1e-6f);
  if (whole && max_stretch == 0) world_radius = radius * std::cbrt(std::fabs(glm::determinant(linear)));
}

EmitterPoint SphereEmitter::sample_area(const Vec2& u) const {
  const auto normal_at = [&](const Vec2& x) {
    const float z = lerp(x.x, z_min, z_max), phi = x.y * phi_max;
    const float r = safe_sqrt((radius - z) * (radius + z));
    return Vec3(r * std::cos(phi), r * std::sin(phi), z) / radius;
  };
  const Vec2 x = max_stretch == 0 ? u
                                  : sample_by_rejection(
                                        u, [](const Vec2& v) { return v; },
                                        [&](const Vec2& v) { return stretch(linear, normal_at(v)); },
                                        [&](const Vec2&) { return max_stretch; });
  const Normal n = normal_at(x);
  return {linear * (radius * n) + centre, map_normal(linear, n)};
}

namespace {

/// The cone of directions from a point outside to a sphere.
struct SphereCone {
  float distance;       ///< to the centre
  float sin2;           ///< of the half angle
  float one_minus_cos;  ///< of the half angle; from the sine, because it is small far away
};
SphereCone sphere_cone(float distance, float radius) {
  const float sin2 = sqr(radius / distance);
  const float cos = std::sqrt((distance - radius) * (distance + radius)) / distance;
  return {distance, sin2, sin2 / (1 + cos)};
}

}  // namespace

std::optional<EmitterDirection> SphereEmitter::sample_towards(const Point& from, const Vec2& u) const {
  const Vec3 to_centre = centre - from;
  const float distance = norm(to_centre);
  if (!(world_radius > 0 && distance > world_radius)) return direction_to(sample_area(u), area, from);
  const SphereCone cone = sphere_cone(distance, world_radius);
  const Frame frame(to_centre / distance);
  const float h = u.x * cone.one_minus_cos;
  const float sin2 = h * (2 - h), sin = std::sqrt(sin2), cos = 1 - h;
  const float phi = 2 * pi * u.y;
  const Vec3 around = std::cos(phi) * frame.s + std::sin(phi) * frame.t;
  // The nearer root, from the product of both: their difference would cancel near the sphere.
  const float ratio = std::fmin(1.0f, sin2 / cone.sin2);
  const float half_chord = std::sqrt(1 - ratio);  // in radii
  const float t = (distance - world_radius) * (distance + world_radius) / (distance * cos + world_radius * half_chord);
  const float cos_centre = std::sqrt(cone.sin2) * ratio + cos * half_chord;
  const Normal outwards = normalize(-cos_centre * frame.n + (t * sin / world_radius) * around);
  return EmitterDirection{centre + world_radius * outwards, outwards, cos * frame.n + sin * around, t,
                          pdf_uniform_cone(cone.one_minus_cos)};
}

float SphereEmitter::pdf_towards(const Point& from, const Point& hit, const Normal& normal_at_hit) const {
  const float distance = norm(centre - from);
  if (!(world_radius > 0 && distance > world_radius)) return pdf_by_area(area, from, hit, normal_at_hit);
  return pdf_uniform_cone(sphere_cone(distance, world_radius).one_minus_cos);
}

DiskEmitter::DiskEmitter(const Transform& object_to_world, float height, float radius_, float inner_radius_,
                         float phi_max_)
    : centre(object_to_world.point({0, 0, height})),
      axis_x(object_to_world.vector({1, 0, 0})),
      axis_y(object_to_world.vector({0, 1, 0})),
      normal(map_normal(glm::mat3(object_to_world.matrix), {0, 0, 1})),
      radius(radius_),
      inner_radius(inner_radius_),
      phi_max(std::clamp(phi_max_, 0.0f, 2 * pi)),
      area(0.5f * phi_max * (radius - inner_radius) * (radius + inner_radius) * norm(cross(axis_x, axis_y))) {}

EmitterPoint DiskEmitter::sample_area(const Vec2& u) const {
  Vec2 p;
  if (inner_radius == 0 && phi_max > 2 * pi * (1 - 1e-6f)) {
    p = radius * sample_concentric_disk(u);
  } else {
    const float r = std::sqrt(lerp(u.x, inner_radius * inner_radius, radius * radius)), phi = u.y * phi_max;
    p = r * Vec2(std::cos(phi), std::sin(phi));
  }
  return {centre + p.x * axis_x + p.y * axis_y, normal};
}

CylinderEmitter::CylinderEmitter(const Transform& object_to_world, float radius_, float z_min_, float z_max_,
                                 float phi_max_)
    : linear(object_to_world.matrix),
      origin(object_to_world.point(Point(0))),
      radius(radius_),
      z_min(std::fmin(z_min_, z_max_)),
      z_max(std::fmax(z_min_, z_max_)),
      phi_max(std::clamp(phi_max_, 0.0f, 2 * pi)),
      max_stretch(lanthorn::max_stretch(linear, 2)) {
  const float mean = integrate(64, [&](const Vec2& u) {
    const float phi = u.x * phi_max;
    return stretch(linear, {std::cos(phi), std::sin(phi), 0});
  });
  area = radius * phi_max * (z_max - z_min) * mean;
}

EmitterPoint CylinderEmitter::sample_area(const Vec2& u) const {
  const auto normal_at = [&](const Vec2& x) {
    const float phi = x.y * phi_max;
    return Vec3(std::cos(phi), std::sin(phi), 0);
  };
  const Vec2 x = max_stretch == 0 ? u
                                  : sample_by_rejection(
                                        u, [](const Vec2& v) { return v; },
                                        [&](const Vec2& v) { return stretch(linear, normal_at(v)); },
                                        [&](const Vec2&) { return max_stretch; });
  const Normal n = normal_at(x);
  return {linear * (radius * n + Vec3(0, 0, lerp(x.x, z_min, z_max))) + origin, map_normal(linear, n)};
}

namespace {

template <class Shape>
constexpr bool samples_directions = requires(const Shape& s) {
  s.sample_towards(Point(0), Vec2(0));
};

Bounds around_points(std::initializer_list<Point> points) {
  Bounds b;
  for (const Point& p : points) b.extend(p);
  return b;
}
/// Half size of the box around the image of the unit ball of the space that x, y, z span.
Vec3 half_extent(const Vec3& x, const Vec3& y, const Vec3& z = Vec3(0)) {
  return {std::hypot(x.x, y.x, z.x), std::hypot(x.y, y.y, z.y), std::hypot(x.z, y.z, z.z)};
}
Bounds box(const Point& centre, const Vec3& half) { return {centre - half, centre + half}; }

Bounds bounds_of(const TriangleEmitter& s) { return around_points({s.p[0], s.p[1], s.p[2]}); }
Bounds bounds_of(const PatchEmitter& s) { return around_points({s.p00, s.p10, s.p01, s.p11}); }
Bounds bounds_of(const SphereEmitter& s) {
  return box(s.centre, s.radius * half_extent(s.linear[0], s.linear[1], s.linear[2]));
}
Bounds bounds_of(const DiskEmitter& s) { return box(s.centre, s.radius * half_extent(s.axis_x, s.axis_y)); }
Bounds bounds_of(const CylinderEmitter& s) {
  const Vec3 half = s.radius * half_extent(s.linear[0], s.linear[1]);
  Bounds b = box(s.origin + s.z_min * s.linear[2], half);
  b.extend(box(s.origin + s.z_max * s.linear[2], half));
  return b;
}

NormalCone cone_of(const TriangleEmitter& s) { return {s.normal, 1}; }
NormalCone cone_of(const DiskEmitter& s) { return {s.normal, 1}; }
NormalCone cone_of(const SphereEmitter&) { return {}; }
NormalCone cone_of(const CylinderEmitter&) { return {}; }
NormalCone cone_of(const PatchEmitter& s) {
  // Every normal is a positive combination of those at the corners.
  const PatchJacobian jacobian(s);
  const std::array<Vec3, 4> corners{jacobian.j00, jacobian.j10, jacobian.j01, jacobian.j11};
  Vec3 sum(0);
  for (const Vec3& n : corners) sum += n / norm(n);
  const Direction axis = sum / norm(sum);
  float cos = 1;
  for (const Vec3& n : corners) cos = std::fmin(cos, dot(axis, n) / norm(n));
  const bool valid = std::isfinite(length_squared(axis)) && cos > 0;
  return valid ? NormalCone{axis, cos} : NormalCone{};
}

}  // namespace

float area(const EmitterShape& shape) {
  return std::visit([](const auto& s) { return s.area; }, shape);
}
EmitterPoint sample_area(const EmitterShape& shape, const Vec2& u) {
  return std::visit([&](const auto& s) { return s.sample_area(u); }, shape);
}
std::optional<EmitterDirection> sample_towards(const EmitterShape& shape, const Point& from, const Vec2& u) {
  return std::visit(
      [&](const auto& s) {
        if constexpr (samples_directions<std::decay_t<decltype(s)>>) return s.sample_towards(from, u);
        return direction_to(s.sample_area(u), s.area, from);
      },
      shape);
}
float pdf_towards(const EmitterShape& shape, const Point& from, const Point& hit, const Normal& normal) {
  return std::visit(
      [&](const auto& s) {
        if constexpr (samples_directions<std::decay_t<decltype(s)>>) return s.pdf_towards(from, hit, normal);
        return pdf_by_area(s.area, from, hit, normal);
      },
      shape);
}
Bounds bounds(const EmitterShape& shape) {
  return std::visit([](const auto& s) { return bounds_of(s); }, shape);
}
NormalCone normal_cone(const EmitterShape& shape) {
  return std::visit([](const auto& s) { return cone_of(s); }, shape);
}

}  // namespace lanthorn
