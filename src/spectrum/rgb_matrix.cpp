// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// References:
//   CIE 15:2004, eq. 3.1 and 3.2 (chromaticity of daylight).
//   Lam 1985, "Metamerism and Colour Constancy", PhD thesis, University of Bradford (the cone space).
//   SMPTE RP 177-1993, "Derivation of Basic Television Color Equations" (the matrix to XYZ).
#include "spectrum/rgb_matrix.h"

#include <algorithm>
#include <cmath>

#include "spectrum/cie.h"

namespace lanthorn {

namespace {

constexpr Matrix3 cones_from_xyz{{{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}}};

/// Maps XYZ seen under the white `from` to XYZ that looks alike under the white `to` (von Kries).
constexpr Matrix3 adaptation(const Tristimulus& from, const Tristimulus& to) {
  const Tristimulus a = cones_from_xyz * from, b = cones_from_xyz * to;
  const Matrix3 gains{{{{b.x / a.x, 0, 0}, {0, b.y / a.y, 0}, {0, 0, b.z / a.z}}}};
  return inverse(cones_from_xyz) * gains * cones_from_xyz;
}

RgbMatrix to_rgb_matrix(const Matrix3& m) {
  RgbMatrix result;
  for (std::size_t i = 0; i < 3; ++i)
    result.rows[i] = {static_cast<float>(m.row[i].x), static_cast<float>(m.row[i].y), static_cast<float>(m.row[i].z)};
  return result;
}

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

constexpr float rounding = 0.0005f;  // of chromaticities that are given by three digits

bool are_rec709(const Chromaticities& c) {
  return std::equal(c.begin(), c.end(), rec709_chromaticities.begin(),
                    [](float a, float b) { return std::fabs(a - b) <= rounding; });
}

// X, Y, Z of a chromaticity, with the sum 1. Unlike XYZ of luminance 1, it exists for every primary, such as the blue
// (0, 0) of files in XYZ.
Tristimulus point(float x, float y) {
  const double dx{x}, dy{y};
  return {dx, dy, 1 - dx - dy};
}

double determinant(const Tristimulus& a, const Tristimulus& b, const Tristimulus& c) {
  return a.x * (b.y * c.z - b.z * c.y) - a.y * (b.x * c.z - b.z * c.x) + a.z * (b.x * c.y - b.y * c.x);
}

struct RgbSpace {
  Matrix3 to_xyz;  ///< from linear colours
  Tristimulus white;
};

std::optional<RgbSpace> space_of(const Chromaticities& c) {
  // Rec.709's primaries span .112, those of ACES2065-1 .4: twice the triangle in the diagram.
  constexpr double least_span = 1e-4, least_response = 1e-3;
  constexpr float most = 16;  // of a coordinate: far outside the diagram
  if (!std::all_of(c.begin(), c.end(), [](float x) { return std::fabs(x) <= most; })) return std::nullopt;
  const Tristimulus r = point(c[0], c[1]), g = point(c[2], c[3]), b = point(c[4], c[5]), w = point(c[6], c[7]);
  if (!(std::fabs(determinant(r, g, b)) >= least_span) || !(w.y >= least_response)) return std::nullopt;
  const Tristimulus white = (1 / w.y) * w, cones = cones_from_xyz * white;
  if (!(std::min({cones.x, cones.y, cones.z}) >= least_response)) return std::nullopt;
  const Matrix3 primaries{{{{r.x, g.x, b.x}, {r.y, g.y, b.y}, {r.z, g.z, b.z}}}};
  const Tristimulus amounts = inverse(primaries) * white;
  return RgbSpace{primaries * Matrix3{{{{amounts.x, 0, 0}, {0, amounts.y, 0}, {0, 0, amounts.z}}}}, white};
}

}  // namespace

RgbMatrix white_balance(float kelvin, ColorSpace space) {
  const Matrix3 adapted = adaptation(white_of(kelvin), to_xyz(illuminant_of(space)));
  return to_rgb_matrix(xyz_to_rec709 * adapted * rgb_to_xyz(ColorSpace::srgb));
}

RgbMatrix rec709_to_xyz() { return to_rgb_matrix(rgb_to_xyz(ColorSpace::srgb)); }

std::optional<RgbMatrix> rec709_from(const Chromaticities& c) {
  if (are_rec709(c)) return RgbMatrix();
  const std::optional<RgbSpace> from = space_of(c), to = space_of(rec709_chromaticities);
  if (!from) return std::nullopt;
  return to_rgb_matrix(inverse(to->to_xyz) * adaptation(from->white, to->white) * from->to_xyz);
}

}  // namespace lanthorn
