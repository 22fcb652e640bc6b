// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "texture/texture_mapping.h"

#include <algorithm>
#include <cmath>

namespace lanthorn {

namespace {

using description::CylindricalTextureMapping;
using description::PlanarTextureMapping;
using description::SolidMapping;
using description::SphericalTextureMapping;
using description::UvMapping;

constexpr float inv_2pi = 0.5f * inv_pi;

Vec2 map_point(const UvMapping& mapping, const TexturePoint& at) { return mapping.linear * at.uv + mapping.offset; }

Vec2 map_point(const SphericalTextureMapping& mapping, const TexturePoint& at) {
  const Point p = mapping.world_to_texture.point(at.position);
  // Angle from the tangent: acos loses half of its digits at the poles.
  const float theta = std::atan2(std::hypot(p.x, p.y), p.z);
  const float phi = std::atan2(p.y, p.x);
  return {theta * inv_pi, (phi < 0 ? phi + 2 * pi : phi) * inv_2pi};
}

Vec2 map_point(const CylindricalTextureMapping& mapping, const TexturePoint& at) {
  const Point p = mapping.world_to_texture.point(at.position);
  return {0.5f + std::atan2(p.y, p.x) * inv_2pi, p.z};
}

Vec2 map_point(const PlanarTextureMapping& mapping, const TexturePoint& at) {
  const Point p = mapping.world_to_texture.point(at.position);
  return Vec2(dot(p, mapping.v1), dot(p, mapping.v2)) + mapping.offset;
}

// Upper bound of the map's stretch.
float stretch(const Transform& t) {
  const glm::mat3 m(t.matrix);
  return std::sqrt(length_squared(m[0]) + length_squared(m[1]) + length_squared(m[2]));
}

TextureDetail in_space(const Transform& world_to_texture, float size) {
  TextureDetail detail;
  detail.metres = size / stretch(world_to_texture);
  return detail;
}

TextureDetail detail_at(const UvMapping& mapping, const Vec2& st) {
  // Along u, the detail is limited by whichever of s and t changes faster; likewise along v.
  const Vec2 du = abs(mapping.linear[0]), dv = abs(mapping.linear[1]);
  return {{std::min(st.x / du.x, st.y / du.y), std::min(st.x / dv.x, st.y / dv.y)}, infinity};
}
TextureDetail detail_at(const SphericalTextureMapping& mapping, const Vec2& st) {
  return in_space(mapping.world_to_texture, std::min(st.x, st.y));
}
TextureDetail detail_at(const CylindricalTextureMapping& mapping, const Vec2& st) {
  return in_space(mapping.world_to_texture, std::min(st.x, st.y));
}
TextureDetail detail_at(const PlanarTextureMapping& mapping, const Vec2& st) {
  const float across =
      std::min(st.x / std::sqrt(length_squared(mapping.v1)), st.y / std::sqrt(length_squared(mapping.v2)));
  return in_space(mapping.world_to_texture, across);
}

}  // namespace

Vec2 plane_point(const description::TextureMapping& mapping, const TexturePoint& at) {
  return std::visit([&](const auto& m) { return map_point(m, at); }, mapping);
}

Point solid_point(const SolidMapping& mapping, const TexturePoint& at) {
  return mapping.world_to_texture.point(at.position);
}

float multiples_within(const Footprint& footprint, const description::TextureMapping& mapping, const Vec2& st) {
  const auto* uv = std::get_if<UvMapping>(&mapping);
  if (uv == nullptr) return 0;
  // The rectangle's sides in (u, v), by the inverse of the map.
  const auto& m = uv->linear;
  const float determinant = std::fabs(m[0].x * m[1].y - m[1].x * m[0].y);
  const Vec2 along_s = st.x * abs(Vec2(m[1].y, m[0].y)), along_t = st.y * abs(Vec2(m[1].x, m[0].x));
  const Vec2 sides = max(along_s, along_t);
  const float n = determinant * std::fmin(footprint.uv.x / sides.x, footprint.uv.y / sides.y);
  return std::isfinite(n) ? n : 0.0f;
}

TextureDetail detail_of(const description::TextureMapping& mapping, const Vec2& st) {
  return std::visit([&](const auto& m) { return detail_at(m, st); }, mapping);
}

TextureDetail detail_of(const SolidMapping& mapping, float size) { return in_space(mapping.world_to_texture, size); }

}  // namespace lanthorn
