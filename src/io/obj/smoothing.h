// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Normals of faces that have none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "lanthorn/vec.h"

namespace lanthorn::obj {

inline constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// A face's corner: indices of position, texture coordinates and normal, the latter two `none` where the file has none.
struct Corner {
  std::uint32_t v = none, vt = none, vn = none;
  friend bool operator==(const Corner&, const Corner&) = default;
};

/// The smoothing group of a face: a number of the file's, or one of these.
inline constexpr std::uint32_t flat_group = 0, group_by_angle = std::numeric_limits<std::uint32_t>::max();

/// A face without normals.
struct BareFace {
  std::size_t first = 0;  ///< of its corners
  std::uint32_t count = 0;
  std::uint32_t group = flat_group;
};

/// Gives smooth normals to the corners of these faces: appends to `normals` and sets `vn`. Faces that are flat keep
/// `none`.
///
/// An edge is smooth if it joins two faces of one smoothing group, whatever their angle, or two faces of
/// `group_by_angle` that meet at less than 30 degrees. At a vertex, corners that smooth edges join share a normal: the
/// mean of their faces' normals, weighted by the corners' angles (Thürmer & Wüthrich 1998, "Computing Vertex Normals
/// from Polygonal Facets").
void add_smooth_normals(const std::vector<Point>& positions, std::span<const BareFace> faces,
                        std::vector<Corner>& corners, std::vector<Normal>& normals);

}  // namespace lanthorn::obj
