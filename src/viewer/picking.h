// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Finds the thing under a click.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lanthorn/scene.h"
#include "math/ray.h"

namespace lanthorn {

/// A surface under a pixel.
struct SurfacePick {
  float distance = 0;  ///< along the ray, m
  std::size_t mesh = 0;
  std::optional<description::Index> instance;    ///< into the description's instances
  std::optional<description::Index> area_light;  ///< into the description's area lights, if the surface emits
};

/// Finds surfaces by testing all triangles for each ray: quick enough for clicks.
class Picker {
 public:
  explicit Picker(const Scene& scene);

  /// The nearest surface along the ray. `instances`: those of the constructor's scene, if they may have moved since.
  std::optional<SurfacePick> pick(const Ray& ray,
                                  const description::Table<description::Instance>& instances = {}) const;

  const SceneModel& model() const { return model_; }

 private:
  SceneModel model_;
  description::Table<description::Instance> instances_;
  std::vector<Bounds> boxes_;                                   // of the meshes
  std::vector<std::optional<description::Index>> area_lights_;  // of the meshes
};

/// Distance along the ray to either side of a triangle, in units of the direction's length, which need not be 1.
/// nullopt if the ray misses it (Möller & Trumbore 1997).
std::optional<float> hit_triangle(const Point& origin, const Vec3& direction, const Point& a, const Point& b,
                                  const Point& c);

}  // namespace lanthorn
