// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/emitter_sampling.h"

namespace lanthorn {

Vec2 barycentric(const Point& p0, const Point& p1, const Point& p2, const Point& point) {
  const Vec3 e1 = p1 - p0, e2 = p2 - p0, d = point - p0;
  const Vec3 n = cross(e1, e2);
  const float n2 = length_squared(n);
  if (!(n2 > 0)) return Vec2(0);
  return {dot(cross(d, e2), n) / n2, dot(cross(e1, d), n) / n2};
}
namespace {

glm::mat3 cofactor(const glm::mat3& m) { return {cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])}; }

}  // namespace

float stretch(const glm::mat3& linear, const Normal& n) { return std::sqrt(length_squared(cofactor(linear) * n)); }

Normal map_normal(const glm::mat3& linear, const Normal& n) {
  const Vec3 mapped = cofactor(linear) * n;
  const float sign = glm::determinant(linear) < 0 ? -1.0f : 1.0f;
  return mapped * (sign / std::sqrt(length_squared(mapped)));
}

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

Vec3 half_extent(const Vec3& x, const Vec3& y, const Vec3& z) {
  return {std::hypot(x.x, y.x, z.x), std::hypot(x.y, y.y, z.y), std::hypot(x.z, y.z, z.z)};
}

}  // namespace lanthorn
