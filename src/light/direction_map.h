// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>

#include "lanthorn/transform.h"
#include "math/vec.h"

namespace lanthorn {

/// Maps directions from a light's own space to the world: any non-singular linear map followed by normalisation, as in
/// pbrt-v4. Scale has no effect, so the map is stored with determinant 1 or -1.
struct DirectionMap {
  struct Mapped {
    Direction direction{0, 0, 1};
    /// Solid angle in the light's space per solid angle in the world. A density in the light's space times this is the
    /// density in the world.
    float compression = 1;
  };

  glm::mat3 to_world{1.0f};
  glm::mat3 to_light{1.0f};

  DirectionMap() = default;
  explicit DirectionMap(const Transform& light_to_world);

  Mapped world_from_light(const Direction& local) const;
  Mapped light_from_world(const Direction& world) const;
};

}  // namespace lanthorn
