// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A glTF file with one triangle.
#pragma once

#include <variant>
#include <vector>

#include "lanthorn/scene_description.h"
#include "support/gltf_writer.h"

namespace lanthorn::test {

inline const std::vector<Point> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

/// A file with one mesh, placed once. `change` may change its only primitive.
template <class Change>
GltfWriter one_mesh(const Change& change) {
  GltfWriter file;
  file.mesh(corners, {0, 1, 2});
  file.node({{"mesh", 0}});
  change(file, file.root["meshes"][0]["primitives"][0]);
  return file;
}
inline GltfWriter one_mesh() {
  return one_mesh([](auto&, auto&) {});
}

inline const description::TriangleMesh& mesh_of(const description::Shape& shape) {
  return std::get<description::TriangleMesh>(shape.geometry);
}

}  // namespace lanthorn::test
