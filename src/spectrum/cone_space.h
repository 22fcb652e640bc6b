// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Lam 1985, "Metamerism and Colour Constancy", PhD thesis, University of Bradford (the cone space).
#pragma once

#include "spectrum/cie.h"
#include "spectrum/white_balance.h"

namespace lanthorn {

inline constexpr Matrix3 cones_from_xyz{
    {{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}}};

/// Maps XYZ seen under the white `from` to XYZ that looks alike under the white `to` (von Kries).
constexpr Matrix3 adaptation(const Tristimulus& from, const Tristimulus& to) {
  const Tristimulus a = cones_from_xyz * from, b = cones_from_xyz * to;
  const Matrix3 gains{{{{b.x / a.x, 0, 0}, {0, b.y / a.y, 0}, {0, 0, b.z / a.z}}}};
  return inverse(cones_from_xyz) * gains * cones_from_xyz;
}

inline RgbMatrix to_rgb_matrix(const Matrix3& m) {
  RgbMatrix result;
  for (std::size_t i = 0; i < 3; ++i)
    result.rows[i] = {static_cast<float>(m.row[i].x), static_cast<float>(m.row[i].y), static_cast<float>(m.row[i].z)};
  return result;
}

}  // namespace lanthorn
