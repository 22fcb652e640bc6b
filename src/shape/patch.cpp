// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reference:
//   Reshetov 2019, "Cool Patches: A Geometric Approach to Ray/Bilinear Patch Intersections", Ray Tracing Gems ch. 8.
#include "shape/patch.h"

#include <algorithm>
#include <cmath>

namespace lanthorn {

namespace {

// Neighbouring patches round the parameters of their shared edge differently; this tolerance leaves no gap.
constexpr double edge_tolerance = 1e-12;

bool inside(double x) { return x >= -edge_tolerance && x <= 1 + edge_tolerance; }

struct Quadratic {
  int count = 0;
  std::array<double, 2> x{};
};
Quadratic solve(double a, double b, double c) {
  if (a == 0 && b == 0) return {};
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return {};
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  if (q == 0) return {1, {0, 0}};
  if (a == 0) return {1, {c / q, 0}};
  return {2, {c / q, q / a}};
}

}  // namespace

PatchHits intersect(const Patch& patch, const Vec3& origin, const Vec3& direction, float t_min, float t_max) {
  const DVec3 o(origin);
  const DVec3 d(direction);
  const DVec3 q00 = patch.p00 - o, q10 = patch.p10 - o, q01 = patch.p01 - o, q11 = patch.p11 - o;
  // For fixed u, the ruling runs from a(u) = lerp(q00, q10) to b(u) = lerp(q01, q11). The ray meets the ruling's line
  // where the volume (a x b) . d is 0, a quadratic equation in u (§8.2).
  const double at0 = glm::dot(glm::cross(q00, q01), d);
  const double at1 = glm::dot(glm::cross(q10, q11), d);
  const double curvature = glm::dot(glm::cross(q10 - q00, q11 - q01), d);
  const Quadratic us = solve(curvature, at1 - at0 - curvature, at0);

  PatchHits result;
  for (int i = 0; i < us.count; ++i) {
    double u = us.x[static_cast<unsigned>(i)];
    if (!inside(u)) continue;
    u = std::clamp(u, 0.0, 1.0);
    const DVec3 a = (1 - u) * q00 + u * q10;
    const DVec3 ruling = (1 - u) * q01 + u * q11 - a;
    // t d = a + v ruling: solves for both parameters by Cramer's rule along n = d x ruling.
    const DVec3 n = glm::cross(d, ruling);
    const double n2 = glm::dot(n, n);
    if (!(n2 > 0)) continue;
    const DVec3 m = glm::cross(a, n);
    const double v = -glm::dot(m, d) / n2;
    const double t = -glm::dot(m, ruling) / n2;
    if (!inside(v) || !(t > t_min) || !(t < t_max)) continue;
    result.hits[static_cast<unsigned>(result.count++)] = {t, u, std::clamp(v, 0.0, 1.0)};
  }
  if (result.count == 2 && result.hits[1].t < result.hits[0].t) std::swap(result.hits[0], result.hits[1]);
  return result;
}

Vec2 parameters_at(const Patch& patch, const Point& point) {
  constexpr int most_steps = 16;
  double u = 0.5, v = 0.5;
  for (int step = 0; step < most_steps; ++step) {  // Gauss-Newton; parallelograms need one step
    const DVec3 du = patch.dpdu(v), dv = patch.dpdv(u), rest = DVec3(point) - patch.position(u, v);
    const double uu = glm::dot(du, du), uv = glm::dot(du, dv), vv = glm::dot(dv, dv);
    const double along_u = glm::dot(du, rest), along_v = glm::dot(dv, rest);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) break;
    const double step_u = (along_u * vv - along_v * uv) / determinant;
    const double step_v = (along_v * uu - along_u * uv) / determinant;
    u = std::clamp(u + step_u, 0.0, 1.0);
    v = std::clamp(v + step_v, 0.0, 1.0);
    if (std::fabs(step_u) + std::fabs(step_v) < 1e-9) break;
  }
  return {static_cast<float>(u), static_cast<float>(v)};
}

bool is_parallelogram(const Point& p00, const Point& p10, const Point& p01, const Point& p11) {
  const DVec3 gap = DVec3(p11) - DVec3(p10) - DVec3(p01) + DVec3(p00);
  const float shortest = std::min(distance_squared(p00, p10), distance_squared(p00, p01));
  if (glm::dot(gap, gap) > 1e-10 * shortest) return false;
  for (int i = 0; i < 3; ++i) {
    const float largest = std::max({std::fabs(p00[i]), std::fabs(p10[i]), std::fabs(p01[i]), std::fabs(p11[i])});
    if (std::fabs(gap[i]) > 0x1p-22 * largest) return false;
  }
  return true;
}

std::optional<std::array<Point, 4>> parallelogram_of(const std::array<Point, 3>& first,
                                                     const std::array<Point, 3>& second) {
  for (unsigned i = 0; i < 3; ++i)
    for (unsigned j = 0; j < 3; ++j) {
      const Point &p00 = first[i], &p10 = first[(i + 1) % 3], &p01 = first[(i + 2) % 3], &p11 = second[j];
      if (second[(j + 1) % 3] == p01 && second[(j + 2) % 3] == p10 && is_parallelogram(p00, p10, p01, p11))
        return std::array{p00, p10, p01, p11};
    }
  return {};
}

}  // namespace lanthorn
