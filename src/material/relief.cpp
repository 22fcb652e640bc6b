// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reference:
//   Blinn 1978, "Simulation of Wrinkled Surfaces".
#include "material/relief.h"

#include <algorithm>
#include <cmath>

namespace lanthorn {

namespace {

// Raises a normal below the surface's horizon to just above it. This is continuous, unlike flipping the normal.
Normal above_horizon(const Normal& n, const Normal& geometric) {
  constexpr float lowest = 0.01f;
  const float cosine = dot(n, geometric);
  return cosine >= lowest ? n : normalize(n + (lowest - cosine) * geometric);
}

Frame normal_mapped(const NormalMapInput& map, const SurfaceGeometry& surface, const TexturePoint& at) {
  const Frame smooth = Frame::from_normal_tangent(surface.shading_normal, surface.tangent);
  Normal local = TextureGraph::evaluate(map, at);
  if (dot(smooth.t, surface.dpdv) < 0) local.y = -local.y;
  return Frame::from_normal_tangent(above_horizon(smooth.to_world(local), surface.normal), surface.tangent);
}

// Half the distance of the central difference in u or v: small compared with the detail, but large enough that rounding
// of the coordinates is not visible.
float half_step(float detail_uv, float detail_metres, float coordinate, const Point& position, float metres_per_uv) {
  constexpr float largest = 0.0005f;
  float step = std::min(largest, detail_uv);
  float rounding = 0x1p-15f * std::fabs(coordinate);
  if (metres_per_uv > 0) {
    step = std::min(step, detail_metres / metres_per_uv);
    rounding = std::max(rounding, 0x1p-16f * max_component(abs(position)) / metres_per_uv);
  }
  return std::max({step, std::min(rounding, 16 * largest), 0x1p-20f});
}

Frame displaced(const Relief& relief, const TextureGraph& textures, const SurfaceGeometry& surface,
                const TexturePoint& at) {
  const Normal& n = surface.shading_normal;
  std::array<Vec3, 2> along{surface.dpdu, surface.dpdv};
  if (!(length_squared(cross(along[0], along[1])) > 0)) {
    const Frame any(n);
    along = {any.s, any.t};
  }
  const auto slope = [&](int axis) {
    const Vec3& tangent = along[static_cast<unsigned>(axis)];
    const float half = half_step(relief.detail.uv[axis], relief.detail.metres, at.uv[axis], at.position,
                                 std::sqrt(length_squared(tangent)));
    TexturePoint before = at, after = at;
    before.uv[axis] -= half;
    after.uv[axis] += half;
    const float width = after.uv[axis] - before.uv[axis];
    before.position -= 0.5f * width * tangent;
    after.position += 0.5f * width * tangent;
    return (textures.evaluate(relief.displacement, after) - textures.evaluate(relief.displacement, before)) / width;
  };
  const auto raised = [&](int axis) {
    const Vec3& tangent = along[static_cast<unsigned>(axis)];
    return tangent + (slope(axis) - dot(tangent, n)) * n;
  };
  const Vec3 dpdu = raised(0), dpdv = raised(1);
  Vec3 normal = cross(dpdu, dpdv);
  const float length = std::sqrt(length_squared(normal));
  if (!(length > 0) || !std::isfinite(length)) return Frame::from_normal_tangent(n, surface.tangent);
  normal /= dot(normal, n) < 0 ? -length : length;
  const Vec3& tangent = surface.tangent == surface.dpdu ? dpdu : surface.tangent;
  return Frame::from_normal_tangent(above_horizon(normal, surface.normal), tangent);
}

}  // namespace

Frame shading_frame(const Relief& relief, const TextureGraph& textures, const SurfaceGeometry& surface,
                    const TexturePoint& at) {
  return relief.normal_map ? normal_mapped(*relief.normal_map, surface, at) : displaced(relief, textures, surface, at);
}

}  // namespace lanthorn
