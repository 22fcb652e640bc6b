// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Cube maps in OpenGL's layout: faces +X -X +Y -Y +Z -Z, rows from the top. The texel that OpenGL looks up for a
// direction holds the radiance from that direction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "lanthorn/image.h"
#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

inline constexpr int cube_faces = 6;

/// A position on a cube: coordinates in [0,1]² from the upper left corner of the face.
struct CubePoint {
  int face = 0;
  Vec2 at{0};
};
CubePoint cube_point(const Vec3& direction);
/// Where a direction meets the plane of this face, possibly outside the face; nullopt if it is more than 75 degrees off
/// the face's axis.
std::optional<Vec2> place_on_face(int face, const Direction& direction);
/// The texel of a map of this `size` at a position.
struct CubeTexel {
  int face = 0, x = 0, y = 0;
};
CubeTexel cube_texel(const CubePoint& place, int size);
/// Unit direction. `at` may lie outside the face, in its plane.
Direction cube_direction(int face, const Vec2& at);

/// Radiance by direction. Each face has a border of one texel, so that bilinear look-ups need no other face.
class CubeMap {
 public:
  explicit CubeMap(int size);

  int size() const { return size_; }
  /// Index of a texel in `data`; x and y from -1 (border) to size.
  std::size_t index(int face, int x, int y) const {
    const auto across = static_cast<std::size_t>(stride());
    const std::size_t row = static_cast<std::size_t>(face) * across + static_cast<std::size_t>(y + 1);
    return row * across + static_cast<std::size_t>(x + 1);
  }
  int stride() const { return size_ + 2; }
  Spectrum& texel(int face, int x, int y) { return texels_[index(face, x, y)]; }
  const Spectrum& texel(int face, int x, int y) const { return texels_[index(face, x, y)]; }
  const Spectrum* data() const { return texels_.data(); }
  Spectrum& texel(const CubeTexel& t) { return texel(t.face, t.x, t.y); }
  Direction direction(int face, int x, int y) const {
    const float scale = 1 / static_cast<float>(size_);
    return cube_direction(face, {(static_cast<float>(x) + 0.5f) * scale, (static_cast<float>(y) + 0.5f) * scale});
  }

  /// Fills the borders from the neighbouring faces: call it once all texels are set.
  void close_seams();
  /// Bilinear and seamless.
  Spectrum lookup(const Direction& direction) const;

 private:
  int size_;
  std::vector<Spectrum> texels_;
};

/// Solid angles of the texels of one face of `size`, row by row, sr; the same for all faces.
std::vector<float> cube_solid_angles(int size);

/// The finest map, with closed seams, and successive halves down to one texel: means weighted by solid angle, so that
/// all have the same integral over the sphere. The size must be a power of two.
using CubePyramid = std::vector<CubeMap>;
CubePyramid cube_pyramid(CubeMap finest);

/// Six faces side by side, channels R, G, B.
Image strip_of(const CubeMap& map);
/// Inverse of `strip_of`, with closed seams. Precondition: width = 6 height, three channels.
CubeMap cube_of(const Image& strip);

}  // namespace lanthorn
