// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// SMPTE RP 177-1993, "Derivation of Basic Television Color Equations" (the matrix to XYZ).
#include "spectrum/chromaticities.h"

#include <algorithm>
#include <cmath>

#include "spectrum/cone_space.h"

namespace lanthorn {

namespace {

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

std::optional<RgbMatrix> rec709_from(const Chromaticities& c) {
  if (are_rec709(c)) return RgbMatrix();
  const std::optional<RgbSpace> from = space_of(c), to = space_of(rec709_chromaticities);
  if (!from) return std::nullopt;
  return to_rgb_matrix(inverse(to->to_xyz) * adaptation(from->white, to->white) * from->to_xyz);
}

}  // namespace lanthorn
