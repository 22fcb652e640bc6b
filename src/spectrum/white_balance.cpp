// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// References:
//   CIE 15:2004, eq. 3.1 and 3.2 (chromaticity of daylight).
//   Lam 1985, "Metamerism and Colour Constancy", PhD thesis, University of Bradford (the cone space).
#include "spectrum/white_balance.h"

#include "spectrum/cie.h"

namespace lanthorn {

namespace {

constexpr Matrix3 cones_from_xyz{{{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}}};

// XYZ of the white of this colour temperature, with Y = 1.
Tristimulus white_of(double kelvin) {
  // Daylight is defined by temperatures of the radiation constant of 1931.
  const double t = kelvin * 1.4388 / 1.4380;
  if (t < 4000) {
    const Tristimulus c = to_xyz(blackbody(static_cast<float>(kelvin)));
    return (1 / c.y) * c;
  }
  const double u = 1e3 / t;
  const double x = t <= 7000 ? 0.244063 + u * (0.09911 + u * (2.9678 - 4.6070 * u))
                             : 0.237040 + u * (0.24748 + u * (1.9018 - 2.0064 * u));
  const double y = -3 * x * x + 2.870 * x - 0.275;
  return {x / y, 1, (1 - x - y) / y};
}

RgbMatrix to_rgb_matrix(const Matrix3& m) {
  RgbMatrix result;
  for (std::size_t i = 0; i < 3; ++i)
    result.rows[i] = {static_cast<float>(m.row[i].x), static_cast<float>(m.row[i].y), static_cast<float>(m.row[i].z)};
  return result;
}

}  // namespace

RgbMatrix white_balance(float kelvin, ColorSpace space) {
  const Tristimulus from = cones_from_xyz * white_of(kelvin);
  const Tristimulus to = cones_from_xyz * to_xyz(illuminant_of(space));
  const Matrix3 gains{{{{to.x / from.x, 0, 0}, {0, to.y / from.y, 0}, {0, 0, to.z / from.z}}}};
  return to_rgb_matrix(xyz_to_rec709 * inverse(cones_from_xyz) * gains * cones_from_xyz * rgb_to_xyz(ColorSpace::srgb));
}

RgbMatrix rec709_to_xyz() { return to_rgb_matrix(rgb_to_xyz(ColorSpace::srgb)); }

}  // namespace lanthorn
