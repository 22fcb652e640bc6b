// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/picking.h"

#include <tuple>

#include "math/vec.h"

namespace lanthorn {

namespace {

// True if the ray meets the box within the distance `farthest`.
bool meets(const Bounds& box, const Point& origin, const Vec3& direction, float farthest) {
  float near = 0, far = farthest;
  for (int i = 0; i < 3; ++i) {
    const float inverse = 1 / direction[i];
    float a = (box.min[i] - origin[i]) * inverse, b = (box.max[i] - origin[i]) * inverse;
    if (a > b) std::swap(a, b);
    // A ray in the plane of a side gives NaN, which changes nothing.
    if (a > near) near = a;
    if (b < far) far = b;
  }
  constexpr float slack = 1 + 1e-5f;
  return near <= far * slack;
}

using Place = std::tuple<std::string, int, int>;
Place place_of(const SourceLocation& at) { return {at.file, at.line, at.column}; }

}  // namespace

std::optional<float> hit_triangle(const Point& origin, const Vec3& direction, const Point& a, const Point& b,
                                  const Point& c) {
  const Vec3 ab = b - a, ac = c - a, p = cross(direction, ac);
  const float determinant = dot(ab, p);
  // For triangles with hardly any area, as at the poles of spheres, and for rays in their plane, only rounding is left.
  constexpr float least = 1e-6f;
  if (determinant * determinant <= least * least * length_squared(ab) * length_squared(p)) return std::nullopt;
  const Vec3 t = origin - a, q = cross(t, ab);
  const float u = dot(t, p) / determinant, v = dot(direction, q) / determinant;
  const float distance = dot(ac, q) / determinant;
  if (!(u >= 0 && v >= 0 && u + v <= 1 && distance > 0)) return std::nullopt;
  return distance;
}

Picker::Picker(const Scene& scene) : model_(model_of(scene)), instances_(description_of(scene).instances) {
  const SceneDescription& description = description_of(scene);
  std::map<Place, description::Index> emitters;
  const auto note = [&](const std::vector<description::Shape>& shapes) {
    for (const description::Shape& shape : shapes)
      if (shape.area_light) emitters[place_of(shape.location)] = *shape.area_light;
  };
  note(description.shapes);
  for (const description::Object& object : description.objects) note(object.shapes);
  for (const SceneMesh& mesh : model_.meshes) {
    Bounds box;
    for (const Point& p : mesh.positions) box.extend(p);
    boxes_.push_back(box);
    const auto emitter = emitters.find(place_of(mesh.location));
    area_lights_.push_back(mesh.emits && emitter != emitters.end() ? std::optional(emitter->second) : std::nullopt);
  }
}

std::optional<SurfacePick> Picker::pick(const Ray& ray,
                                        const description::Table<description::Instance>& instances) const {
  std::optional<SurfacePick> nearest;
  float distance = infinity;
  for (const SceneModel::Instance& instance : model_.instances) {
    Transform to_world = instance.to_world;
    if (instance.instance && !instances.empty()) {
      const AnimatedTransform& now = instances[*instance.instance].object_to_world;
      if (!(now == instances_[*instance.instance].object_to_world)) to_world = now.start;
    }
    // Not of unit length: distances are measured in world space.
    const Transform to_local = to_world.inverted();
    const Point origin = to_local.point(ray.origin);
    const Vec3 direction = to_local.vector(ray.direction);
    for (std::size_t m = instance.first_mesh; m < instance.first_mesh + instance.mesh_count; ++m) {
      if (!meets(boxes_[m], origin, direction, distance)) continue;
      const SceneMesh& mesh = model_.meshes[m];
      for (const auto& [a, b, c] : mesh.triangles) {
        const auto hit = hit_triangle(origin, direction, mesh.positions[a], mesh.positions[b], mesh.positions[c]);
        if (!hit || *hit >= distance) continue;
        distance = *hit;
        nearest = SurfacePick{distance, m, instance.instance, area_lights_[m]};
      }
    }
  }
  return nearest;
}

}  // namespace lanthorn
