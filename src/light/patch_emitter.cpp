// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/emitter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "light/emitter_sampling.h"
#include "math/sampling.h"

namespace lanthorn {
namespace {

/// Area density |dp/du x dp/dv| of a patch. The cross product is linear in (u, v); it is stored at each corner.
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

struct Roots {
  std::array<float, 2> x;
};
/// Roots of a + b x + c x², accurate even for small c; both may be infinite.
Roots quadratic_roots(float a, float b, float c) {
  const float q = -0.5f * (b + std::copysign(safe_sqrt(b * b - 4 * a * c), b));
  return {{a / q, q / c}};
}

/// Samples x in [0,1] with density proportional to the line from a to b.
float sample_linear(float u, float a, float b) {
  if (a == b) return u;
  return std::min(one_minus_epsilon, u * (a + b) / (a + std::sqrt(lerp(u, a * a, b * b))));
}

/// Inverse of `sample_linear`.
float integral_of_linear(float x, float a, float b) { return x * (2 * a + x * (b - a)) / (a + b); }

}  // namespace

PatchEmitter::PatchEmitter(const Point& p00_, const Point& p10_, const Point& p01_, const Point& p11_)
    : p00(p00_), p10(p10_), p01(p01_), p11(p11_) {
  const PatchJacobian jacobian(*this);
  area = integrate(8, [&](const Vec2& uv) { return norm(jacobian.at(uv)); });
}

EmitterPoint PatchEmitter::sample_area(const Vec2& u) const {
  // The norm of a linear function is convex, so bilinear interpolation of the corners is an upper bound.
  const PatchJacobian jacobian(*this);
  const float w00 = norm(jacobian.j00), w10 = norm(jacobian.j10), w01 = norm(jacobian.j01), w11 = norm(jacobian.j11);
  const auto propose = [&](const Vec2& x) {
    const float v = sample_linear(x.y, w00 + w10, w01 + w11);
    return Vec2(sample_linear(x.x, lerp(v, w00, w01), lerp(v, w10, w11)), v);
  };
  const auto density = [&](const Vec2& uv) { return norm(jacobian.at(uv)); };
  // The bound of a flat patch is tight up to rounding: nothing is rejected.
  const auto bound = [&](const Vec2& uv) {
    return (1 - 1e-5f) * lerp(uv.y, lerp(uv.x, w00, w10), lerp(uv.x, w01, w11));
  };
  const Vec2 uv = sample_by_rejection(u, propose, density, bound);
  const Vec3 n = jacobian.at(uv);
  const Point left = p00 + uv.y * (p01 - p00), right = p10 + uv.y * (p11 - p10);
  return {left + uv.x * (right - left), n / norm(n)};
}

std::optional<Vec2> PatchEmitter::invert_sample_area(const Point& point) const {
  const PatchJacobian jacobian(*this);
  const float w00 = norm(jacobian.j00), w10 = norm(jacobian.j10), w01 = norm(jacobian.j01), w11 = norm(jacobian.j11);
  constexpr float rejected = 1e-4f;
  if (area < (1 - rejected) * 0.25f * (w00 + w10 + w01 + w11)) return {};
  // The point minus v b is along a + v twist: a quadratic equation for v.
  const Vec3 a = p10 - p00, b = p01 - p00, twist = p11 - p01 - a, d = point - p00;
  const Vec3 n = jacobian.at(Vec2(0.5f));
  const auto across = [&](const Vec3& x, const Vec3& y) { return dot(cross(x, y), n); };
  const auto [roots] = quadratic_roots(across(d, a), across(d, twist) - across(b, a), -across(b, twist));
  const auto outside = [](float v) { return std::isfinite(v) ? std::fabs(v - 0.5f) : infinity; };
  const float v = std::clamp(outside(roots[0]) < outside(roots[1]) ? roots[0] : roots[1], 0.0f, 1.0f);
  const Vec3 along_u = a + v * twist;
  const float u = std::clamp(dot(d - v * b, along_u) / length_squared(along_u), 0.0f, 1.0f);
  return clamped_to_square(
      {integral_of_linear(u, lerp(v, w00, w01), lerp(v, w10, w11)), integral_of_linear(v, w00 + w10, w01 + w11)});
}

Bounds PatchEmitter::bounds() const {
  Bounds b;
  for (const Point& corner : {p00, p10, p01, p11}) b.extend(corner);
  return b;
}

NormalCone PatchEmitter::normal_cone() const {
  // Every normal is a positive combination of the corners' normals.
  const PatchJacobian jacobian(*this);
  const std::array<Vec3, 4> corners{jacobian.j00, jacobian.j10, jacobian.j01, jacobian.j11};
  Vec3 sum(0);
  for (const Vec3& n : corners) sum += n / norm(n);
  const Direction axis = sum / norm(sum);
  float cos = 1;
  for (const Vec3& n : corners) cos = std::fmin(cos, dot(axis, n) / norm(n));
  const bool valid = std::isfinite(length_squared(axis)) && cos > 0;
  return valid ? NormalCone{axis, cos} : NormalCone{};
}

}  // namespace lanthorn
