// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "lanthorn/viewer.h"

namespace lanthorn {

namespace {

// A mesh at a place. Nodes may deform the same mesh in different ways.
using MeshPlace = std::pair<std::string, std::array<double, 16>>;

MeshPlace mesh_place(const std::string& mesh, const AnimatedTransform& to_world) {
  MeshPlace place{mesh, {}};
  std::copy_n(&to_world.start.matrix[0][0], 16, place.second.begin());
  return place;
}

}  // namespace

void make_nodes_movable(SceneDescription& scene) {
  using namespace description;
  constexpr std::size_t most = 4096;  // each gets an acceleration structure of its own
  std::map<MeshPlace, std::vector<Shape>> meshes;
  std::vector<Shape> others;
  for (Shape& shape : scene.shapes) {
    const std::size_t end = shape.location.file.find("/primitives/");
    if (end == std::string::npos || shape.displacement)
      others.push_back(std::move(shape));
    else
      meshes[mesh_place(shape.location.file.substr(0, end), shape.object_to_world)].push_back(std::move(shape));
  }
  const bool are_too_many = meshes.size() > most;
  for (auto& [mesh, shapes] : meshes) {
    if (are_too_many) {
      for (Shape& shape : shapes) others.push_back(std::move(shape));
      continue;
    }
    const SourceLocation location{mesh.first};
    const AnimatedTransform place = shapes.front().object_to_world;
    for (Shape& shape : shapes) shape.object_to_world = AnimatedTransform();
    std::string name = scene.materials[shapes.front().material].name;
    scene.instances.push_back({static_cast<Index>(scene.objects.size()), place, location});
    scene.objects.push_back({std::move(name), std::move(shapes)});
  }
  scene.shapes = std::move(others);
}

}  // namespace lanthorn
