// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// References:
//   CIE 15:2004, eq. 3.1 and 3.2 (chromaticity of daylight).
#include "spectrum/white_balance.h"

#include "spectrum/cone_space.h"

namespace lanthorn {

namespace {

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

}  // namespace

RgbMatrix white_balance(float kelvin, ColorSpace space) {
  const Matrix3 adapted = adaptation(white_of(kelvin), to_xyz(illuminant_of(space)));
  return to_rgb_matrix(xyz_to_rec709 * adapted * rgb_to_xyz(ColorSpace::srgb));
}

RgbMatrix rec709_to_xyz() { return to_rgb_matrix(rgb_to_xyz(ColorSpace::srgb)); }

}  // namespace lanthorn
