// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lanthorn/scene_description.h"
#include "math/vec.h"

namespace lanthorn {

/// The part of a surface over which the value of a texture may be averaged: a parallelogram with sides along u and v,
/// of these lengths in u and v. 0: none.
struct Footprint {
  Vec2 uv{0};
};

/// Point of a texture look-up.
struct TexturePoint {
  Point position{0};       ///< world space
  Normal normal{0, 0, 1};  ///< geometric, unit, world space
  Vec2 uv{0};
  glm::vec4 color{1};  ///< of the mesh's vertices
  Footprint footprint{};
};

/// Texture coordinates (s, t) of a surface point.
Vec2 plane_point(const description::TextureMapping& mapping, const TexturePoint& at);
/// The point in texture space.
Point solid_point(const description::SolidMapping& mapping, const TexturePoint& at);

/// Distance between two points over which a texture is almost linear: in u, in v (of the surface's parametrisation) and
/// in metres.
struct TextureDetail {
  Vec2 uv{infinity};
  float metres = infinity;

  void refine(const TextureDetail& other) {
    uv = min(uv, other.uv);
    metres = std::min(metres, other.metres);
  }
};
/// Largest n such that a rectangle of n · `st` in texture coordinates lies within the footprint; 0 unless the mapping
/// is a `UvMapping`.
float multiples_within(const Footprint& footprint, const description::TextureMapping& mapping, const Vec2& st);
/// Detail of a texture whose features have size `st` in texture coordinates. An estimate if the mapping is not linear.
TextureDetail detail_of(const description::TextureMapping& mapping, const Vec2& st);
/// Detail of a texture whose features have size `size` in texture space.
TextureDetail detail_of(const description::SolidMapping& mapping, float size);

}  // namespace lanthorn
