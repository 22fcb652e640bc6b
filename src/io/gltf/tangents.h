// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "lanthorn/scene_description.h"

namespace lanthorn::gltf {

/// Gives the mesh the file's tangents, whose w is the side of the bitangent (one per position, or none), rotated about
/// the normals by `turn` radians: counter-clockwise as seen from outside if w is 1. Without tangents in the file, those
/// to be rotated run along u. Needs the mesh's normals and, in that case, its texture coordinates (u, 1 - v).
void set_tangents(description::TriangleMesh& mesh, std::vector<glm::vec4> tangents, float turn);

}  // namespace lanthorn::gltf
