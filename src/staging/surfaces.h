// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Areas of a described scene's meshes, and points on them, without building the scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "lanthorn/scene_description.h"

namespace lanthorn {

/// Bounding box of all triangle meshes at shutter open, in the space that `from_world` maps to. Instances contribute
/// the boxes of their objects.
Bounds bounds_of(const SceneDescription& scene, const Transform& from_world = {});
/// Bounding box of each shape, in the space that shapes are placed in; empty for other kinds of shapes.
std::vector<Bounds> bounds_of(const std::vector<description::Shape>& shapes);
/// Like the first function, for several spaces.
std::vector<Bounds> bounds_of(const SceneDescription& scene, std::span<const Transform> from_world);

/// A shape of the scene, or an instance.
struct Part {
  Bounds box;
  std::size_t place = 0;  ///< in the scene's list of shapes or instances
  bool is_instance = false;
};
/// The triangle meshes and instances with their bounding boxes in world space, which are not empty.
std::vector<Part> parts_of(const SceneDescription& scene);

/// All triangle meshes of a scene, positioned as when the shutter opens. Refers to the description.
class Surfaces {
 public:
  explicit Surfaces(const SceneDescription& scene) : Surfaces(scene, nullptr) {}
  /// Includes only the meshes that emit as one of these area lights.
  Surfaces(const SceneDescription& scene, const std::set<description::Index>& area_lights)
      : Surfaces(scene, &area_lights) {}

  /// Area of all meshes, m².
  double area() const { return cumulative_.empty() ? 0 : cumulative_.back(); }
  /// Area of the meshes that emit as each of the description's area lights, m².
  const std::vector<double>& emitting_areas() const { return emitting_; }

  struct Sample {
    Point position{0};
    Normal normal{0};  ///< geometric, outside
    description::Index material = 0;
    std::optional<description::Index> area_light;
    std::size_t placed = 0, piece = 0, triangle = 0;  ///< its location, for `meshes_of`
  };
  /// `count` points, uniformly distributed over the area; none if the area is 0.
  std::vector<Sample> samples(std::size_t count) const;
  /// For each sample the number, from 0 on, of the connected mesh that contains it: triangles that share a corner
  /// position belong to the same mesh. In groups of more than four million vertices, each shape counts as a mesh.
  std::vector<std::uint32_t> meshes_of(const std::vector<Sample>& samples) const;

 private:
  struct Piece {
    const description::TriangleMesh* mesh = nullptr;
    description::Index material = 0;
    std::optional<description::Index> area_light;
    Transform place;                 // to the space of its group
    std::vector<double> cumulative;  // running sums of its triangles' areas in that space
  };
  struct Group {
    std::vector<Piece> pieces;
    std::vector<double> cumulative;
    std::vector<std::pair<description::Index, double>> emitting;  // areas by area light
  };
  struct Placed {
    std::size_t group = 0;
    Transform to_world;
    double stretch = 1;  // scaling of areas, averaged over all directions
  };

  // `area_lights` null: all meshes.
  Surfaces(const SceneDescription& scene, const std::set<description::Index>* area_lights);
  static Group make_group(const std::vector<description::Shape>& shapes, const std::set<description::Index>* lights);
  void place(std::size_t group, const Transform& to_world);
  // For each triangle of each piece, an identifier of its mesh.
  static std::vector<std::vector<std::uint32_t>> meshes_in(const Group& group);
  Sample sample(std::size_t placed_index, double area, const Vec2& u) const;

  std::vector<Group> groups_;
  std::vector<Placed> placed_;
  std::vector<double> cumulative_;  // areas of placed_
  std::vector<double> emitting_;
};

}  // namespace lanthorn
