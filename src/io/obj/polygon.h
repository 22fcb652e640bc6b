// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace lanthorn::obj {

/// Triangles (of indices into `corners`) that cover a simple polygon, with its winding, by cutting off ears (Meisters
/// 1975) in the plane of its area vector. One that crosses itself, or has more than 1000 corners, is fanned.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Point>& corners);

}  // namespace lanthorn::obj
