// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Renders points and lines as surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lanthorn/scene_description.h"

namespace lanthorn::gltf {

/// Lines between vertices; a line from a vertex to itself is a point.
using Strokes = std::vector<std::array<std::uint32_t, 2>>;

/// Maximum number of triangles that `thickened` makes of a stroke.
inline constexpr std::size_t triangles_of_stroke = 12;

/// Octahedra for points and six-sided prisms for lines, of the given radius, with smooth normals. `vertices`:
/// positions, texture coordinates and colours; `place` transforms them before they are thickened.
description::TriangleMesh thickened(const description::TriangleMesh& vertices, const Strokes& strokes,
                                    const Transform& place, float radius);

}  // namespace lanthorn::gltf
