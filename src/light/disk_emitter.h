// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "lanthorn/transform.h"
#include "light/emitter_sample.h"

namespace lanthorn {

/// Disk or ring at object-space height z, azimuth in [0, phi_max]; natural normal: the image of object-space +z.
struct DiskEmitter {
  Point centre{0};
  Vec3 axis_x{1, 0, 0}, axis_y{0, 1, 0};  ///< world-space images of the object's unit vectors
  Normal normal{0, 0, 1};
  float radius = 1, inner_radius = 0;  ///< object space
  float phi_max = 2 * pi;              ///< radians
  float area = 0;                      ///< m², world

  DiskEmitter() = default;
  DiskEmitter(const Transform& object_to_world, float height, float radius, float inner_radius = 0,
              float phi_max = 2 * pi);

  EmitterPoint sample_area(const Vec2& u) const;
  std::optional<Vec2> invert_sample_area(const Point& point) const;
  Bounds bounds() const;
  NormalCone normal_cone() const;

 private:
  bool is_whole() const { return inner_radius == 0 && phi_max > 2 * pi * (1 - 1e-6f); }
};

}  // namespace lanthorn
