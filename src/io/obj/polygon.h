// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace lanthorn::obj {

/// Newell's area vector of a polygon: its length is the area in m²; seen from its tip, the corners run
/// counter-clockwise.
glm::dvec3 area_vector(const std::vector<Point>& corners);

/// Triangulates a simple polygon by ear clipping (Meisters 1975) in the plane of its area vector, preserving its
/// winding; returns indices into `corners`. Polygons that intersect themselves or have more than 1000 corners become
/// triangle fans, and so do polygons that would exceed `tests_left`, which is reduced by the number of corners tested.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Point>& corners, std::uint64_t& tests_left);

}  // namespace lanthorn::obj
