// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "spectrum/sigmoid_fit.h"

#include <cmath>

namespace lanthorn {
namespace {

/// CIELAB's f (CIE 15:2004, section 8.2.1) and its derivative.
struct Compressed {
  double value, derivative;
};
Compressed compress(double t) {
  constexpr double delta = 6.0 / 29.0;
  if (t <= delta * delta * delta) return {t / (3 * delta * delta) + 4.0 / 29.0, 1 / (3 * delta * delta)};
  const double root = std::cbrt(t);
  return {root, 1 / (3 * root * root)};
}

/// L*, a*, b* (named x, y, z) and their derivatives with respect to the three coefficients.
struct Lab {
  Tristimulus value;
  std::array<Tristimulus, 3> derivative;
};
Lab to_lab(const Tristimulus& xyz, const Tristimulus& white, const std::array<Tristimulus, 3>& derivative) {
  const Compressed x = compress(xyz.x / white.x), y = compress(xyz.y / white.y), z = compress(xyz.z / white.z);
  Lab lab{{116 * y.value - 16, 500 * (x.value - y.value), 200 * (y.value - z.value)}, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    const double dx = x.derivative * derivative[k].x / white.x;
    const double dy = y.derivative * derivative[k].y / white.y;
    const double dz = z.derivative * derivative[k].z / white.z;
    lab.derivative[k] = {116 * dy, 500 * (dx - dy), 200 * (dy - dz)};
  }
  return lab;
}

double dot(const Tristimulus& a, const Tristimulus& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Solves (J^T J + damping diag(J^T J)) step = J^T residual for J with the given columns (Marquardt 1963).
Tristimulus damped_step(const std::array<Tristimulus, 3>& j, const Tristimulus& residual, double damping) {
  Matrix3 normal{{{{dot(j[0], j[0]), dot(j[0], j[1]), dot(j[0], j[2])},
                   {dot(j[1], j[0]), dot(j[1], j[1]), dot(j[1], j[2])},
                   {dot(j[2], j[0]), dot(j[2], j[1]), dot(j[2], j[2])}}}};
  constexpr double tiny = 1e-20;  // keeps the matrix regular where the sigmoid is flat
  normal.row[0].x += damping * normal.row[0].x + tiny;
  normal.row[1].y += damping * normal.row[1].y + tiny;
  normal.row[2].z += damping * normal.row[2].z + tiny;
  return inverse(normal) * Tristimulus{dot(j[0], residual), dot(j[1], residual), dot(j[2], residual)};
}

}  // namespace

SigmoidFit::SigmoidFit(ColorSpace space) : to_xyz_(rgb_to_xyz(space)), white_(to_xyz(illuminant_of(space))) {
  const DenseSpectrum& light = illuminant_of(space);
  for (std::size_t i = 0; i < spectrum_samples; ++i) {
    const Tristimulus c = (double{light.values[i]} / cie_y_integral) * cie_1931[i];
    const std::size_t k = i / 5;
    const double t = static_cast<double>(i % 5) / 5;
    const std::array<double, 3> xyz = {c.x, c.y, c.z};
    for (std::size_t channel = 0; channel < 3; ++channel) {
      weight_[channel][k] += (1 - t) * xyz[channel];
      if (t > 0) weight_[channel][k + 1] += t * xyz[channel];
    }
  }
}

SigmoidFit::Colour SigmoidFit::colour(const UnitSigmoid& a) const {
  std::array<double, five_nm_samples> s, ds;
  for (std::size_t i = 0; i < five_nm_samples; ++i) {
    const double t = static_cast<double>(i) / (five_nm_samples - 1);
    const double q = (a[0] * t + a[1]) * t + a[2];
    const double r = 1 / std::sqrt(1 + q * q);
    s[i] = 0.5 + 0.5 * q * r;
    ds[i] = 0.5 * r * r * r;
  }
  Colour c;
  const auto accumulate = [&](std::size_t channel, double Tristimulus::*member) {
    double value = 0, d0 = 0, d1 = 0, d2 = 0;
    for (std::size_t i = 0; i < five_nm_samples; ++i) {
      const double t = static_cast<double>(i) / (five_nm_samples - 1);
      const double d = weight_[channel][i] * ds[i];
      value += weight_[channel][i] * s[i];
      d0 += d * t * t;
      d1 += d * t;
      d2 += d;
    }
    c.xyz.*member = value;
    c.derivative[0].*member = d0;
    c.derivative[1].*member = d1;
    c.derivative[2].*member = d2;
  };
  accumulate(0, &Tristimulus::x);
  accumulate(1, &Tristimulus::y);
  accumulate(2, &Tristimulus::z);
  return c;
}

UnitSigmoid SigmoidFit::fit(const Tristimulus& rgb, const UnitSigmoid& start) const {
  constexpr int max_steps = 60;
  constexpr double max_coefficient = 1e5;  // beyond it the curve is a step and float evaluation loses digits
  const Tristimulus target = to_lab(to_xyz_ * rgb, white_, {}).value;
  UnitSigmoid best = start;
  Colour c = colour(best);
  Lab lab = to_lab(c.xyz, white_, c.derivative);
  Tristimulus residual = target + -1 * lab.value;
  double error = dot(residual, residual);
  double damping = 1e-3;
  for (int step = 0; step < max_steps && error > 1e-14 && damping < 1e8; ++step) {
    const Tristimulus d = damped_step(lab.derivative, residual, damping);
    const UnitSigmoid candidate = {best[0] + d.x, best[1] + d.y, best[2] + d.z};
    const Colour moved = colour(candidate);
    const Lab moved_lab = to_lab(moved.xyz, white_, moved.derivative);
    const Tristimulus moved_residual = target + -1 * moved_lab.value;
    const double moved_error = dot(moved_residual, moved_residual);
    const bool bounded = std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z) < max_coefficient &&
                         std::fabs(candidate[0]) < max_coefficient && std::fabs(candidate[1]) < max_coefficient;
    if (moved_error < error && bounded) {
      best = candidate;
      lab = moved_lab;
      residual = moved_residual;
      error = moved_error;
      damping *= 0.1;
    } else {
      damping *= 10;
    }
  }
  return best;
}

Tristimulus SigmoidFit::rgb_of(const UnitSigmoid& a) const { return inverse(to_xyz_) * colour(a).xyz; }

std::array<float, 3> in_nanometres(const UnitSigmoid& a) {
  constexpr double scale = 1.0 / (lambda_max - lambda_min);
  constexpr double shift = lambda_min * scale;
  return {static_cast<float>(a[0] * scale * scale), static_cast<float>((a[1] - 2 * a[0] * shift) * scale),
          static_cast<float>((a[0] * shift - a[1]) * shift + a[2])};
}

}  // namespace lanthorn
