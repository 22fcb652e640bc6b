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

/// A box around all triangle meshes where they are when the shutter opens, in the space that `from_world` maps to.
/// Boxes of instances are those of their objects.
Bounds bounds_of(const SceneDescription& scene, const Transform& from_world = {});
/// Of each shape by itself, in the space that shapes are placed in; empty for shapes of other kinds.
std::vector<Bounds> bounds_of(const std::vector<description::Shape>& shapes);
/// In several spaces.
std::vector<Bounds> bounds_of(const SceneDescription& scene, std::span<const Transform> from_world);

/// All triangle meshes of a scene where they are when the shutter opens. Refers to the description.
class Surfaces {
 public:
  explicit Surfaces(const SceneDescription& scene) : Surfaces(scene, nullptr) {}
  /// The meshes that emit as one of these area lights.
  Surfaces(const SceneDescription& scene, const std::set<description::Index>& area_lights)
      : Surfaces(scene, &area_lights) {}

  /// Of all meshes, m².
  double area() const { return cumulative_.empty() ? 0 : cumulative_.back(); }
  /// Of the meshes that emit as each of the description's area lights, m².
  const std::vector<double>& emitting_areas() const { return emitting_; }

  struct Sample {
    Point position{0};
    Normal normal{0};  ///< geometric, outside
    description::Index material = 0;
    std::optional<description::Index> area_light;
    std::size_t placed = 0, piece = 0, triangle = 0;  ///< where it lies, for `meshes_of`
  };
  /// `count` points, evenly distributed over the area; none if there is no area.
  std::vector<Sample> samples(std::size_t count) const;
  /// For each of these samples the number of the separate mesh that it lies on, from 0 on: triangles are of one mesh if
  /// they have corners at the same place. In groups of more than four million vertices, shapes count as meshes.
  std::vector<std::uint32_t> meshes_of(const std::vector<Sample>& samples) const;

 private:
  struct Piece {
    const description::TriangleMesh* mesh = nullptr;
    description::Index material = 0;
    std::optional<description::Index> area_light;
    Transform place;                 // to the space of its group
    std::vector<double> cumulative;  // areas of its triangles there
  };
  struct Group {
    std::vector<Piece> pieces;
    std::vector<double> cumulative;
    std::vector<std::pair<description::Index, double>> emitting;  // areas by area light
  };
  struct Placed {
    std::size_t group = 0;
    Transform to_world;
    double stretch = 1;  // of areas; the mean of all directions
  };

  // Null: all meshes.
  Surfaces(const SceneDescription& scene, const std::set<description::Index>* area_lights);
  static Group make_group(const std::vector<description::Shape>& shapes, const std::set<description::Index>* lights);
  void place(std::size_t group, const Transform& to_world);
  // Of each triangle of each piece a number that only triangles of the same mesh share.
  static std::vector<std::vector<std::uint32_t>> meshes_in(const Group& group);
  Sample sample(std::size_t placed_index, double area, const Vec2& u) const;

  std::vector<Group> groups_;
  std::vector<Placed> placed_;
  std::vector<double> cumulative_;  // areas of placed_
  std::vector<double> emitting_;
};

}  // namespace lanthorn
