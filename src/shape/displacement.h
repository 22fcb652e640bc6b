// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "lanthorn/scene_description.h"
#include "texture/texture_mapping.h"

namespace lanthorn {

/// Splits each quad into two triangles.
description::TriangleMesh triangulated(description::BilinearMesh mesh);

/// A lower bound of the number of triangles that a shape with displacement will have. 0 if it is not a mesh.
double least_displaced_triangles(const description::Shape& shape);

/// Splits the triangles of `mesh` until no edge is longer than `edge_length` under `to_world`, then moves each vertex
/// along its unit normal by `height` in the mesh's own space, as pbrt-v4 does. `height` is evaluated at the vertex's
/// original point (world space). A mesh without normals uses the mean of its faces' normals. Afterwards the normals
/// belong to the displaced faces. The result has no cracks, except where several vertices share a place (seams of
/// normals). Throws Error with `location` if the result would have more than about 2^24 triangles, or if single
/// precision has no edges that are short enough.
description::TriangleMesh displaced(description::TriangleMesh mesh, float edge_length, const Transform& to_world,
                                    const std::function<float(const TexturePoint&)>& height,
                                    const SourceLocation& location);

}  // namespace lanthorn
