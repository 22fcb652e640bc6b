// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "description/scene_description.h"

namespace lanthorn {

/// The limit of Loop's subdivision of a control mesh (positions and triangles; nothing else of it counts), sampled
/// where `levels` subdivisions have put vertices: limit positions, limit normals, four triangles for each one and
/// level. Edges of one triangle, or of more than two, are boundaries: the limit there is the cubic B-spline of the
/// edges. A vertex where boundaries end or more than two of them meet stays where it is. Triangles that name a vertex
/// twice are left out. As in pbrt-v4, normals point to the side from which the triangles run clockwise. Rules: Loop
/// 1987; weights of extraordinary vertices: Warren 1995; boundaries, limits, tangents: Hoppe et al. 1994. Indices must
/// be in range; `levels` >= 0.
description::TriangleMesh loop_subdivide(const description::TriangleMesh& control, int levels);

}  // namespace lanthorn
