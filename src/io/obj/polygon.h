// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace lanthorn::obj {

/// Newell's area vector of a polygon: as long as its area, m², towards where the corners run counter-clockwise.
glm::dvec3 area_vector(const std::vector<Point>& corners);

/// Triangles (of indices into `corners`) that cover a simple polygon, with its winding, by ear clipping (Meisters 1975)
/// in the plane of its area vector. Polygons that intersect themselves or have more than 1000 corners become triangle
/// fans, and so do those for which `tests_left` does not suffice: it is reduced by the number of corners tested.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Point>& corners, std::uint64_t& tests_left);

}  // namespace lanthorn::obj
