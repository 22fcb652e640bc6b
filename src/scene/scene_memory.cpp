// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>
#include <vector>

#include "base/memory.h"
#include "shape/triangle_memory.h"

namespace lanthorn {

namespace {

// Adds the shapes of one of Embree's scenes.
void add(const std::vector<description::Shape>& shapes, SceneMemory& memory) {
  std::uint64_t triangles = 0;
  for (const description::Shape& shape : shapes) {
    if (const auto* mesh = std::get_if<description::TriangleMesh>(&shape.geometry)) {
      const bool has_attributes =
          !(mesh->normals.empty() && mesh->uvs.empty() && mesh->tangents.empty() && mesh->colors.empty());
      memory.geometry += mesh_bytes(static_cast<double>(mesh->positions.size()),
                                    static_cast<double>(mesh->triangles.size()), has_attributes);
      triangles += mesh->triangles.size();
    } else if (const auto* patches = std::get_if<description::BilinearMesh>(&shape.geometry)) {
      memory.geometry += static_cast<double>(patches->positions.size()) * sizeof(Vertex) +
                         static_cast<double>(patches->patches.size()) * sizeof(patches->patches[0]);
      triangles += 2 * patches->patches.size();
    }
  }
  memory.triangles += triangles;
  memory.trees += static_cast<double>(triangles) * tree_bytes_per_triangle;
  memory.building = std::max(memory.building, static_cast<double>(triangles) * building_bytes_per_triangle);
}

}  // namespace

SceneMemory expected_memory(const SceneDescription& scene) {
  SceneMemory memory;
  add(scene.shapes, memory);
  for (const description::Object& object : scene.objects) add(object.shapes, memory);
  return memory;
}

void require_geometry_memory(const SceneDescription& scene) {
  const SceneMemory memory = expected_memory(scene);
  require_memory(memory.geometry + memory.trees + memory.building, {scene.filename},
                 fmt::format("the geometry ({} triangles) with its search trees", memory.triangles));
}

}  // namespace lanthorn
