// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "description/scene_description.h"
#include "texture/texture_mapping.h"

namespace lanthorn {

/// Quads as two triangles each.
description::TriangleMesh triangulated(description::BilinearMesh mesh);

/// `mesh` with its triangles split until no edge is longer than `edge_length` under `to_world`, and each vertex moved
/// along its unit normal by `height` of the point where it was (world space), in the mesh's own space, as pbrt-v4 does.
/// Without normals the mean of the faces' stands in; afterwards normals are those of the displaced faces. No cracks,
/// but where vertices of one place are several (seams of normals). Throws Error with `location` if that
/// would make more than about 2^24 triangles.
description::TriangleMesh displaced(description::TriangleMesh mesh, float edge_length, const Transform& to_world,
                                    const std::function<float(const TexturePoint&)>& height,
                                    const SourceLocation& location);

}  // namespace lanthorn
