// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lanthorn/scene_description.h"

namespace lanthorn {

/// A PLY mesh: its triangles (including fanned larger polygons) and its quads, as bilinear patches. Each part has
/// positions and their attributes only if it has faces.
struct PlyMesh {
  description::TriangleMesh triangles;
  description::BilinearMesh quads;
  std::vector<std::string> warnings;  ///< about faces that were changed or omitted
};

/// Parses a PLY file in any of its three encodings. Reads from vertices x, y, z, and where present nx, ny, nz and u, v
/// (also s, t; texture_u, texture_v; texture_s, texture_t), in any order and numeric type; from faces vertex_indices
/// (or vertex_index). Skips other elements and properties. Throws Error with `name` and, in the header and in ascii
/// files, the line.
PlyMesh parse_ply(std::string_view bytes, const std::string& name);

/// The size of a mesh according to its file's header.
struct PlyNeed {
  double faces = 0;  ///< larger polygons count as triangles
  double bytes = 0;  ///< of memory, including its acceleration structure
};
/// `start`: the first bytes of a file. nullopt if they do not contain the header of an uncompressed PLY file.
std::optional<PlyNeed> need_of_ply(std::string_view start);

}  // namespace lanthorn
