// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Divides faces into triangles, and computes smooth normals for faces without normals.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "lanthorn/vec.h"
#include "math/vec.h"

namespace lanthorn::obj {

inline constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// A face's corner: indices of position, texture coordinates and normal, the latter two `none` if the file gives none.
struct Corner {
  std::uint32_t v = none, vt = none, vn = none;
  friend bool operator==(const Corner&, const Corner&) = default;
};

/// The smoothing group of a face: a number from the file, or one of these.
inline constexpr std::uint32_t flat_group = 0, group_by_angle = std::numeric_limits<std::uint32_t>::max();

/// A face without normals.
struct BareFace {
  std::size_t first = 0;  ///< index of its first corner
  std::uint32_t count = 0;
  std::uint32_t group = flat_group;
};

/// Gives smooth normals to the corners of these faces: appends to `normals` and sets `vn`. Corners of flat faces keep
/// `none`.
///
/// An edge is smooth if it joins two faces of the same smoothing group, at any angle, or two faces of `group_by_angle`
/// that meet at less than 30 degrees. At a vertex, corners joined by smooth edges share a normal: the mean of their
/// faces' normals, weighted by the corners' angles (Thürmer & Wüthrich 1998, "Computing Vertex Normals from Polygonal
/// Facets").
void add_smooth_normals(const std::vector<Point>& positions, std::span<const BareFace> faces,
                        std::vector<Corner>& corners, std::vector<Normal>& normals);

/// Newell's area vector of a polygon: its length is the area in m²; seen from its tip, the corners run
/// counter-clockwise.
glm::dvec3 area_vector(const std::vector<Point>& corners);

/// Triangulates a simple polygon by ear clipping (Meisters 1975) in the plane of its area vector, preserving its
/// winding; returns indices into `corners`. Polygons that intersect themselves or have more than 1000 corners become
/// triangle fans, and so do polygons that would exceed `tests_left`, which is reduced by the number of corners tested.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Point>& corners, std::uint64_t& tests_left);

}  // namespace lanthorn::obj
