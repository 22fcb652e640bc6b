// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/default_view.h"

#include <cmath>
#include <variant>

#include "math/vec.h"

namespace lanthorn {

namespace {

using namespace description;

constexpr float field_of_view = 40;  // degrees
constexpr float elevation = 15 * pi / 180;
constexpr float margin = 1.05f;

void extend(Bounds& bounds, const Shape& shape, const Transform& to_world) {
  const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
  if (mesh == nullptr) return;
  const Transform place = to_world * shape.object_to_world.start;
  for (const Point& p : mesh->positions) bounds.extend(place.point(p));
}

Bounds bounds_of(const SceneDescription& scene) {
  Bounds bounds;
  for (const Shape& shape : scene.shapes) extend(bounds, shape, {});
  std::vector<Bounds> objects(scene.objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i)
    for (const Shape& shape : scene.objects[i].shapes) extend(objects[i], shape, {});
  for (const Instance& instance : scene.instances)
    if (const Bounds& object = objects[instance.object]; !object.empty())
      bounds.extend(instance.object_to_world.start.bounds(object));
  return bounds;
}

Point corner(const Bounds& b, unsigned i) {
  return {i & 1u ? b.max.x : b.min.x, i & 2u ? b.max.y : b.min.y, i & 4u ? b.max.z : b.min.z};
}

void warn(SceneDescription& scene, const char* message) {
  Warning& warning = scene.warnings.emplace_back();
  warning.location.file = scene.filename;
  warning.message = message;
}

}  // namespace

void add_default_camera(SceneDescription& scene) {
  Bounds bounds = bounds_of(scene);
  if (bounds.empty() || !std::isfinite(length_squared(bounds.extent()))) bounds = {Point(-1), Point(1)};
  const Point centre = bounds.centre();
  const Direction towards_eye(0, std::sin(elevation), std::cos(elevation));
  const Vec3 right(1, 0, 0), up = cross(towards_eye, right);  // as seen in the picture
  const float aspect = static_cast<float>(scene.view.film.width) / static_cast<float>(scene.view.film.height);
  const float tangent = std::tan(field_of_view / 2 * pi / 180) / margin;
  const float tangent_x = tangent * std::max(aspect, 1.0f), tangent_y = tangent / std::min(aspect, 1.0f);
  float distance = 1e-3f;
  for (unsigned i = 0; i < 8; ++i) {
    const Vec3 p = corner(bounds, i) - centre;
    const float nearer = dot(p, towards_eye);
    distance =
        std::max({distance, nearer + std::fabs(dot(p, right)) / tangent_x, nearer + std::fabs(dot(p, up)) / tangent_y});
  }
  // World space is right-handed, camera space left-handed: x runs to the right of the picture in both.
  const Mat4 camera_to_world(glm::vec4(right, 0), glm::vec4(up, 0), glm::vec4(-towards_eye, 0),
                             glm::vec4(centre + distance * towards_eye, 1));
  scene.view.camera.node = PerspectiveCamera{.fov = field_of_view};
  scene.view.camera.camera_to_world = AnimatedTransform(Transform(camera_to_world));
  scene.view.camera.location.file = scene.filename;
  warn(scene, "the file has no camera: one in front of the model is used");
}

void add_default_environment(SceneDescription& scene) {
  InfiniteLight environment;
  environment.radiance.spectrum = RgbSpectrum{{1, 1, 1}};
  Light& light = scene.lights.emplace_back();
  light.node = environment;
  light.location.file = scene.filename;
  warn(scene, "the file has no light: a uniform environment of radiance 1 is used");
}

}  // namespace lanthorn
