// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "description/scene_description.h"
#include "math/vec.h"

namespace lanthorn {

/// Where a texture is looked up.
struct TexturePoint {
  Point position{0};       ///< world space
  Normal normal{0, 0, 1};  ///< geometric, unit, world space
  Vec2 uv{0};
};

/// Texture coordinates (s, t) of a point.
Vec2 plane_point(const description::TextureMapping& mapping, const TexturePoint& at);
/// The point in texture space.
Point solid_point(const description::SolidMapping& mapping, const TexturePoint& at);

/// How far apart two points may be for a texture to be almost linear between them, in u, v (along the surface's
/// parametrisation) and metres.
struct TextureDetail {
  Vec2 uv{infinity};
  float metres = infinity;

  void refine(const TextureDetail& other) {
    uv = min(uv, other.uv);
    metres = std::min(metres, other.metres);
  }
};
/// Of a texture whose features measure `st` in texture coordinates. Estimated where a mapping is not linear.
TextureDetail detail_of(const description::TextureMapping& mapping, const Vec2& st);
/// Of a texture whose features measure `size` in texture space.
TextureDetail detail_of(const description::SolidMapping& mapping, float size);

}  // namespace lanthorn
