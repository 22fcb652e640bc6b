// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Moves everything in a scene's description that has a world position.
#include <array>
#include <cmath>
#include <variant>

#include "lanthorn/scene.h"

namespace lanthorn {

namespace {

// The point that determines the origin: the centre of the camera's subject, or the camera's position.
DVec3 place_of(const description::Camera& camera) {
  const Point near = camera.subject && !camera.subject->empty() ? camera.subject->centre() : Point(0);
  return DVec3(camera.camera_to_world.start.matrix * glm::dvec4(near, 1.0));
}

// Along each axis on which the place is far away: a multiple of 1/64 of it, rounded down to a power of 2. Subtracting
// such a multiple from coordinates of the same magnitude is exact in single precision.
DVec3 origin_near(const DVec3& place) {
  // Coordinates below this have a spacing of at most 2^-13, 0.1 mm in metres.
  constexpr double nearest = 1024, farthest = 1e12;
  DVec3 origin(0.0);
  for (int i = 0; i < 3; ++i) {
    const double distance = std::fabs(place[i]);
    if (!(distance >= nearest && distance <= farthest)) continue;
    const double unit = std::ldexp(1.0, std::ilogb(distance) - 6);
    origin[i] = unit * std::round(place[i] / unit);
  }
  return origin;
}

class OriginMover {
 public:
  explicit OriginMover(const DVec3& origin) : from_world_(translate(-origin)) {}

  void move(Transform& to_world) const { to_world = from_world_ * to_world; }
  void move(AnimatedTransform& to_world) const {
    move(to_world.start);
    move(to_world.end);
  }
  void move(std::array<Point, 4>& corners) const {
    for (Point& p : corners) p = from_world_.point(p);
  }
  void move(description::Light& light) const {
    move(light.light_to_world);
    if (auto* sky = std::get_if<description::InfiniteLight>(&light.node); sky != nullptr && sky->portal)
      move(*sky->portal);
  }
  template <class Texture>
  void move_texture(Texture& texture) const {
    std::visit(
        [&](auto& node) {
          if constexpr (requires { node.mapping; }) move_mapping(node.mapping);
        },
        texture.node);
  }

 private:
  template <class... Mappings>
  void move_mapping(std::variant<Mappings...>& mapping) const {
    std::visit([&](auto& m) { move_mapping(m); }, mapping);
  }
  void move_mapping(description::UvMapping&) const {}
  template <class Mapping>
  void move_mapping(Mapping& mapping) const {
    mapping.world_to_texture = mapping.world_to_texture * from_world_.inverted();
  }

  Transform from_world_;
};

}  // namespace

void move_origin(SceneDescription& scene) {
  const DVec3 origin = origin_near(place_of(scene.view.camera));
  if (origin == DVec3(0.0)) return;
  const OriginMover mover(origin);
  for (description::FloatTexture& texture : scene.float_textures) mover.move_texture(texture);
  for (description::SpectrumTexture& texture : scene.spectrum_textures) mover.move_texture(texture);
  for (description::Medium& medium : scene.media) mover.move(medium.medium_to_world);
  for (description::Shape& shape : scene.shapes) mover.move(shape.object_to_world);
  for (description::Instance& instance : scene.instances) mover.move(instance.object_to_world);
  for (description::Light& light : scene.lights) mover.move(light);
  for (description::Light& light : scene.own_lights) mover.move(light);
  mover.move(scene.view.camera.camera_to_world);
  scene.origin += origin;
}

}  // namespace lanthorn
