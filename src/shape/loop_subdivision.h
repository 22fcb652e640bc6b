// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lanthorn/scene_description.h"

namespace lanthorn {

/// The limit surface of Loop's subdivision of a control mesh, sampled at the vertices of `levels` subdivisions: limit
/// positions, limit normals, four times as many triangles per level. Uses only the mesh's positions and triangles.
/// Edges of a single triangle, or of more than two, are boundaries; the limit there is the edges' cubic B-spline. A
/// vertex where boundaries end, or where more than two meet, stays fixed. Triangles that contain a vertex twice are
/// left out. As in pbrt-v4, normals point to the side from which the triangles wind clockwise. Rules: Loop 1987;
/// weights of extraordinary vertices: Warren 1995; boundaries, limits, tangents: Hoppe et al. 1994. Indices must be in
/// range; `levels` >= 0.
description::TriangleMesh loop_subdivide(const description::TriangleMesh& control, int levels);

}  // namespace lanthorn
