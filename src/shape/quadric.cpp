// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// References:
//   Haines, Günther, Akenine-Möller 2019, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems ch. 7.
//   Parametrisations and cuts: pbrt 4e, §6.2 to §6.4.
#include "shape/quadric.h"

#include <algorithm>
#include <cmath>

namespace lanthorn {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

double clamped_radians(float degrees) {
  return std::clamp(static_cast<double>(degrees), 0.0, 360.0) * std::numbers::pi / 180;
}

double azimuth(const DVec3& p) {
  const double phi = std::atan2(p.y, p.x);
  return phi < 0 ? phi + two_pi : phi;
}

bool keeps_azimuth(const Quadric& q, const DVec3& p) { return q.phi_max >= two_pi || azimuth(p) <= q.phi_max; }

// True if the point, which lies on the unbounded surface, is on the part that remains after clipping.
bool keeps(const Quadric& q, const DVec3& p) {
  switch (q.kind) {
    case Quadric::Kind::sphere:
      if ((q.z_min > -q.radius && p.z < q.z_min) || (q.z_max < q.radius && p.z > q.z_max)) return false;
      break;
    case Quadric::Kind::cylinder:
      if (p.z < q.z_min || p.z > q.z_max) return false;
      break;
    case Quadric::Kind::disk: {
      const double r2 = p.x * p.x + p.y * p.y;
      if (r2 > q.radius * q.radius || r2 < q.inner_radius * q.inner_radius) return false;
      break;
    }
  }
  return keeps_azimuth(q, p);
}

// Factor of lengths if the map only rotates and scales uniformly, to within the rounding of double precision; otherwise
// 0.
double scale_of_similarity(const Affine& map) {
  constexpr double rounding = 1e-14;
  const DMat3 metric = glm::transpose(map.linear) * map.linear;
  const double scale2 = metric[0][0];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!(std::fabs(metric[i][j] - (i == j ? scale2 : 0)) <= rounding * scale2)) return 0;
  return std::sqrt(scale2);
}

// Error bound of mapping rays and points to object space and back, metres.
double rounding_slack_of(const Quadric& q) {
  double reach = 0;
  for (int i = 0; i < 3; ++i) reach = std::max(reach, std::fabs(q.to_world.translation[i]));
  const double size = std::max({q.radius, std::fabs(q.z_min), std::fabs(q.z_max)});
  for (int i = 0; i < 3; ++i) reach += glm::length(q.to_world.linear[i]) * size;
  return 0x1p-48 * reach;
}

void place(Quadric& q, const Transform& to_world) {
  q.to_world = Affine(to_world);
  q.rounding_slack = rounding_slack_of(q);
}

}  // namespace

Quadric Quadric::from(const description::Sphere& s, const Transform& to_world) {
  Quadric q;
  q.kind = Kind::sphere;
  q.radius = s.radius;
  q.z_min = std::clamp(std::min(s.z_min, s.z_max), -s.radius, s.radius);
  q.z_max = std::clamp(std::max(s.z_min, s.z_max), -s.radius, s.radius);
  q.phi_max = clamped_radians(s.phi_max);
  place(q, to_world);
  if (q.is_whole_sphere()) q.ball_radius = q.radius * scale_of_similarity(q.to_world);
  return q;
}

Quadric Quadric::from(const description::Disk& d, const Transform& to_world) {
  Quadric q;
  q.kind = Kind::disk;
  q.radius = d.radius;
  q.inner_radius = d.inner_radius;
  q.z_min = q.z_max = d.height;
  q.phi_max = clamped_radians(d.phi_max);
  place(q, to_world);
  return q;
}

Quadric Quadric::from(const description::Cylinder& c, const Transform& to_world) {
  Quadric q;
  q.kind = Kind::cylinder;
  q.radius = c.radius;
  q.z_min = std::min(c.z_min, c.z_max);
  q.z_max = std::max(c.z_min, c.z_max);
  q.phi_max = clamped_radians(c.phi_max);
  place(q, to_world);
  return q;
}

bool Quadric::is_whole_sphere() const {
  return kind == Kind::sphere && z_min <= -radius && z_max >= radius && phi_max >= two_pi;
}

Bounds Quadric::bounds() const {
  // Row i of the linear map determines the extent along axis i: its first two entries for the disk (r cos, r sin), the
  // third for z. For a whole sphere all three entries count together.
  const DMat3 rows = glm::transpose(to_world.linear);
  Bounds b;
  for (int i = 0; i < 3; ++i) {
    const DVec3 row = rows[i];
    double low = 0, high = 0;
    if (is_whole_sphere()) {
      high = radius * glm::length(row);
      low = -high;
    } else {
      const double around = radius * std::hypot(row.x, row.y);
      low = std::min(row.z * z_min, row.z * z_max) - around;
      high = std::max(row.z * z_min, row.z * z_max) + around;
    }
    const double t = to_world.translation[i];
    b.min[i] = std::nextafter(static_cast<float>(t + low - rounding_slack), -infinity);
    b.max[i] = std::nextafter(static_cast<float>(t + high + rounding_slack), infinity);
  }
  return b;
}

namespace quadric_detail {

QuadricRoots intersect_mapped(const Quadric& q, const Vec3& origin, const Vec3& direction, float t_min, float t_max) {
  const DVec3 o = q.to_world.inverse_point(DVec3(origin));
  const DVec3 d = q.to_world.inverse_vector(DVec3(direction));
  Roots roots;
  switch (q.kind) {
    case Quadric::Kind::sphere:
      roots = circle_roots(o, d, q.radius);
      break;
    case Quadric::Kind::cylinder:
      roots = circle_roots({o.x, o.y, 0}, {d.x, d.y, 0}, q.radius);
      break;
    case Quadric::Kind::disk:
      if (d.z == 0) return {};
      roots.real = true;
      roots.t0 = roots.t1 = (q.z_min - o.z) / d.z;
      break;
  }
  return roots_within(roots, t_min, t_max, [&](double t) { return keeps(q, o + t * d); });
}

}  // namespace quadric_detail

namespace {

// pbrt's v: the polar angle, from its value at z_min to its value at z_max. Texture coordinates are single precision.
float sphere_v(const Quadric& q, float z) {
  const auto theta = [](float cos) { return std::acos(std::clamp(cos, -1.0f, 1.0f)); };
  if (q.is_whole_sphere()) return 1 - theta(z) * inv_pi;
  const float low = theta(static_cast<float>(q.z_min / q.radius)), high = theta(static_cast<float>(q.z_max / q.radius));
  return (theta(z) - low) / (high - low);
}

// Angle about z in [0, 2 pi), as a fraction of phi_max.
float quadric_u(const Quadric& q, const DVec3& p) {
  const float phi = std::atan2(static_cast<float>(p.y), static_cast<float>(p.x));
  return (phi < 0 ? phi + 2 * pi : phi) / static_cast<float>(q.phi_max);
}

}  // namespace

QuadricPoint evaluate(const Quadric& q, const DVec3& near) {
  if (q.ball_radius > 0) {
    const DVec3 out = near - q.to_world.translation;
    const DVec3 n = out / glm::length(out);
    return {q.to_world.translation + q.ball_radius * n, n};
  }
  DVec3 p = q.to_world.inverse_point(near);
  DVec3 n;
  switch (q.kind) {
    case Quadric::Kind::sphere:
      p *= q.radius / glm::length(p);
      n = p / q.radius;
      break;
    case Quadric::Kind::cylinder: {
      const double to_surface = q.radius / std::sqrt(p.x * p.x + p.y * p.y);
      p.x *= to_surface;
      p.y *= to_surface;
      n = DVec3(p.x, p.y, 0) / q.radius;
      break;
    }
    case Quadric::Kind::disk:
      p.z = q.z_min;
      n = {0, 0, 1};
      break;
  }
  return {q.to_world.point(p), glm::normalize(q.to_world.normal(n))};
}

Vec2 evaluate_uv(const Quadric& q, const DVec3& near) {
  const DVec3 p = q.to_world.inverse_point(near);
  const float u = quadric_u(q, p);
  switch (q.kind) {
    case Quadric::Kind::sphere:
      return {u, sphere_v(q, static_cast<float>(p.z / glm::length(p)))};
    case Quadric::Kind::cylinder:
      return {u, static_cast<float>((p.z - q.z_min) / (q.z_max - q.z_min))};
    case Quadric::Kind::disk:
      break;
  }
  const double across = std::sqrt(p.x * p.x + p.y * p.y);
  return {u, static_cast<float>((q.radius - across) / (q.radius - q.inner_radius))};
}

QuadricTangents evaluate_tangents(const Quadric& q, const DVec3& near) {
  const DVec3 p = q.to_world.inverse_point(near);
  const double across = std::sqrt(p.x * p.x + p.y * p.y);
  const DVec3 outwards = across > 0 ? DVec3(p.x / across, p.y / across, 0) : DVec3(1, 0, 0);
  const DVec3 around(-outwards.y, outwards.x, 0);
  const DVec3 dpdu = (q.phi_max * across) * around;
  DVec3 dpdv;
  switch (q.kind) {
    case Quadric::Kind::sphere: {
      // Along the meridian, over the clipped range of the polar angle.
      const auto theta = [&](double z) { return std::acos(std::clamp(z / q.radius, -1.0, 1.0)); };
      dpdv = (theta(q.z_min) - theta(q.z_max)) * (DVec3(0, 0, across) - p.z * outwards);
      break;
    }
    case Quadric::Kind::cylinder:
      dpdv = {0, 0, q.z_max - q.z_min};
      break;
    case Quadric::Kind::disk:
      dpdv = (q.inner_radius - q.radius) * outwards;
      break;
  }
  return {q.to_world.vector(around), q.to_world.vector(dpdu), q.to_world.vector(dpdv)};
}

}  // namespace lanthorn
