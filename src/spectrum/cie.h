// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The standard observer, the daylight illuminants and the RGB colour spaces as compile-time constants.
#pragma once

#include <array>
#include <cstddef>

#include "spectrum/curve.h"

namespace lanthorn {

/// CIE XYZ, or a point of another linear three-channel space.
struct Tristimulus {
  double x = 0, y = 0, z = 0;

  friend constexpr Tristimulus operator+(const Tristimulus& a, const Tristimulus& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend constexpr Tristimulus operator*(double s, const Tristimulus& a) { return {s * a.x, s * a.y, s * a.z}; }
};

/// Row-major 3x3 matrix.
struct Matrix3 {
  std::array<Tristimulus, 3> row{};

  friend constexpr Tristimulus operator*(const Matrix3& m, const Tristimulus& v) {
    const auto dot = [&](const Tristimulus& r) { return r.x * v.x + r.y * v.y + r.z * v.z; };
    return {dot(m.row[0]), dot(m.row[1]), dot(m.row[2])};
  }
  friend constexpr Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
    Matrix3 m;
    for (std::size_t i = 0; i < 3; ++i)
      m.row[i] = a.row[i].x * b.row[0] + a.row[i].y * b.row[1] + a.row[i].z * b.row[2];
    return m;
  }
};

constexpr Matrix3 inverse(const Matrix3& m) {
  const auto& [a, b, c] = m.row;
  const double determinant =
      a.x * (b.y * c.z - b.z * c.y) - a.y * (b.x * c.z - b.z * c.x) + a.z * (b.x * c.y - b.y * c.x);
  const double s = 1 / determinant;
  return {{s * Tristimulus{b.y * c.z - b.z * c.y, a.z * c.y - a.y * c.z, a.y * b.z - a.z * b.y},
           s * Tristimulus{b.z * c.x - b.x * c.z, a.x * c.z - a.z * c.x, a.z * b.x - a.x * b.z},
           s * Tristimulus{b.x * c.y - b.y * c.x, a.y * c.x - a.x * c.y, a.x * b.y - a.y * b.x}}};
}

inline constexpr std::size_t spectrum_samples = 471;  ///< every nanometre of [lambda_min, lambda_max]
inline constexpr std::size_t five_nm_samples = 95;    ///< every fifth

/// CIE 1931 2-degree colour matching functions at lambda_min + i nm.
inline constexpr std::array<Tristimulus, spectrum_samples> cie_1931 = {{
#include "spectrum/data/cie1931.inc"
}};

/// Sum of y-bar over the table, 106.8569: integrals over nm are divided by it to obtain Y.
inline constexpr double cie_y_integral = [] {
  double sum = 0;
  for (const Tristimulus& c : cie_1931) sum += c.y;
  return sum;
}();

/// XYZ of a spectrum, scaled such that equal energy 1 has Y = 1.
constexpr Tristimulus to_xyz(const DenseSpectrum& s) {
  Tristimulus sum;
  for (std::size_t i = 0; i < spectrum_samples; ++i) sum = sum + double{s.values[i]} * cie_1931[i];
  return (1 / cie_y_integral) * sum;
}

/// A spectrum from samples every 5 nm from lambda_min, interpolated linearly (as CIE 15 requires for its illuminants)
/// and scaled to Y = 1.
constexpr DenseSpectrum light_from_five_nm(const std::array<double, five_nm_samples>& samples) {
  DenseSpectrum light;
  for (std::size_t i = 0; i < spectrum_samples; ++i) {
    const std::size_t k = i / 5;
    const double t = static_cast<double>(i % 5) / 5;
    light.values[i] = static_cast<float>(t == 0 ? samples[k] : (1 - t) * samples[k] + t * samples[k + 1]);
  }
  const double y = to_xyz(light).y;
  for (float& v : light.values) v = static_cast<float>(v / y);
  return light;
}

/// CIE daylight of chromaticity (x, y), Y = 1 (CIE 15:2004, equations 3.3 to 3.5).
constexpr DenseSpectrum daylight(double x, double y) {
  constexpr std::array<Tristimulus, five_nm_samples> components = {{
#include "spectrum/data/cie_daylight.inc"
  }};
  const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
  const double m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
  const double m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
  std::array<double, five_nm_samples> samples{};
  for (std::size_t i = 0; i < five_nm_samples; ++i)
    samples[i] = components[i].x + m1 * components[i].y + m2 * components[i].z;
  return light_from_five_nm(samples);
}

/// CIE standard illuminant D65, Y = 1: the white of sRGB, Display P3 and Rec. 2020.
inline constexpr DenseSpectrum illuminant_d65 = light_from_five_nm({
#include "spectrum/data/cie_d65.inc"
});
/// White of ACES2065-1 (Academy TB-2018-001), close to daylight of 6000 K; Y = 1.
inline constexpr DenseSpectrum illuminant_aces = daylight(0.32168, 0.33767);

constexpr const DenseSpectrum& illuminant_of(ColorSpace space) {
  return space == ColorSpace::aces2065_1 ? illuminant_aces : illuminant_d65;
}

/// Matrix from linear RGB of a colour space to XYZ. Its white is the chromaticity of its tabulated illuminant, so that
/// the illuminant itself has RGB (1,1,1) up to rounding.
constexpr Matrix3 rgb_to_xyz(ColorSpace space) {
  struct Chromaticity {
    double x, y;
  };
  constexpr std::array<std::array<Chromaticity, 3>, 4> primaries = {{
      {{{0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}}},           // ITU-R BT.709
      {{{0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}}},        // SMPTE RP 431-2
      {{{0.708, 0.292}, {0.17, 0.797}, {0.131, 0.046}}},    // ITU-R BT.2020
      {{{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}}},  // SMPTE ST 2065-1
  }};
  Matrix3 columns;
  for (std::size_t i = 0; i < 3; ++i) {
    const Chromaticity& p = primaries[static_cast<std::size_t>(space)][i];
    columns.row[i] = {p.x / p.y, 1, (1 - p.x - p.y) / p.y};
  }
  const auto& [r, g, b] = columns.row;
  Matrix3 m{{{{r.x, g.x, b.x}, {r.y, g.y, b.y}, {r.z, g.z, b.z}}}};
  const Tristimulus scale = inverse(m) * to_xyz(illuminant_of(space));
  for (Tristimulus& row : m.row) row = {row.x * scale.x, row.y * scale.y, row.z * scale.z};
  return m;
}

inline constexpr Matrix3 xyz_to_rec709 = inverse(rgb_to_xyz(ColorSpace::srgb));

}  // namespace lanthorn
