// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lanthorn/scene_description.h"

namespace lanthorn {

/// A PLY mesh: its triangles (and larger polygons, fanned into triangles) and its quads, as bilinear patches. Each part
/// has the positions and their attributes only if it has faces.
struct PlyMesh {
  description::TriangleMesh triangles;
  description::BilinearMesh quads;
  std::vector<std::string> warnings;  ///< faces that were changed or left out
};

/// Parses a PLY file in any of its three encodings. Vertices: x, y, z, and where present nx, ny, nz and u, v (also s,
/// t; texture_u, texture_v; texture_s, texture_t), in any order and numeric type; faces: vertex_indices (or
/// vertex_index). Other elements and properties are skipped. Throws Error with `name` and, in the header and in ascii
/// files, the line.
PlyMesh parse_ply(std::string_view bytes, const std::string& name);

/// What a mesh will take, by the header of its file.
struct PlyNeed {
  double faces = 0;  ///< larger polygons count as triangles
  double bytes = 0;  ///< of memory, with its search tree
};
/// `start`: the first bytes of a file. nullopt if they do not hold the header of a PLY file that is not compressed.
std::optional<PlyNeed> need_of_ply(std::string_view start);

}  // namespace lanthorn
