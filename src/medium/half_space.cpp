// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Discrete directions and the doubling method (van de Hulst 1963; Hansen & Travis 1974, "Light scattering in planetary
// atmospheres", section 3.3). Light and medium have no azimuth, so its mean suffices. Radiances are vectors over the
// cosines μ_i of n directions, with weights w_i of a quadrature over (0, 1). A layer reflects radiance by the matrix R
// and transmits it by T.
#include "medium/half_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "surface/fresnel.h"

namespace lanthorn {

namespace {

constexpr std::size_t n = 16;
constexpr std::size_t half = n / 2;
using Vector = std::array<double, n>;
using Matrix = std::array<Vector, n>;

Matrix identity() {
  Matrix m{};
  for (std::size_t i = 0; i < n; ++i) m[i][i] = 1;
  return m;
}
Matrix product(const Matrix& a, const Matrix& b) {
  Matrix m{};
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t j = 0; j < n; ++j) m[i][j] += a[i][k] * b[k][j];
  return m;
}
// a + factor · b
Matrix sum(const Matrix& a, double factor, const Matrix& b) {
  Matrix m;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) m[i][j] = a[i][j] + factor * b[i][j];
  return m;
}
double largest(const Matrix& m) {
  double result = 0;
  for (const Vector& row : m)
    for (const double x : row) result = std::max(result, std::fabs(x));
  return result;
}

// Solves a x = b by Gaussian elimination with partial pivoting. `Right`: Matrix, or an array of rows of any size.
template <class Right>
Right solve(Matrix a, Right b) {
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::fabs(a[i][k]) > std::fabs(a[pivot][k])) pivot = i;
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      for (std::size_t j = 0; j < b[i].size(); ++j) b[i][j] -= factor * b[k][j];
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    for (double& x : b[i]) x /= a[i][i];
  return b;
}

struct Directions {
  Vector cosines{}, weights{};
};

// Value and derivative of the Legendre polynomial of this degree > 0.
std::array<double, 2> legendre(std::size_t degree, double x) {
  double before = 1, value = x;
  for (std::size_t l = 2; l <= degree; ++l) {
    const auto d = static_cast<double>(l);
    const double next = ((2 * d - 1) * x * value - (d - 1) * before) / d;
    before = value;
    value = next;
  }
  return {value, static_cast<double>(degree) * (x * value - before) / (x * x - 1)};
}

// Gauss's quadrature on both sides of the critical angle, where the interface's reflectance has a kink.
Directions directions_for(double eta) {
  const double critical = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 0.5;
  Directions result;
  for (std::size_t i = 0; i < half; ++i) {
    double x = std::cos(3.14159265358979323846 * (static_cast<double>(i) + 0.75) / (half + 0.5));
    for (int newton = 0; newton < 8; ++newton) {
      const auto [value, slope] = legendre(half, x);
      x -= value / slope;
    }
    const double slope = legendre(half, x)[1], place = (1 + x) / 2, weight = 1 / ((1 - x * x) * slope * slope);
    result.cosines[i] = critical * place;
    result.weights[i] = critical * weight;
    result.cosines[half + i] = critical + (1 - critical) * place;
    result.weights[half + i] = (1 - critical) * weight;
  }
  return result;
}

// The change of radiance per optical depth: `forward` of the light in its own hemisphere, `backward` into the other.
struct Rates {
  Matrix forward, backward;
};

// The phase function has n moments g^l. The others are those of a peak in the forward direction, which scatters
// nothing (delta-M, Wiscombe 1977).
Rates rates_of(double albedo, double g, const Directions& d) {
  const double peak = std::pow(std::fabs(g), static_cast<double>(n));
  const double scattered = albedo * (1 - peak) / (1 - albedo * peak);
  Rates result{};
  std::array<Vector, n> p{};  // of each degree
  for (std::size_t i = 0; i < n; ++i) {
    p[0][i] = 1;
    for (std::size_t l = 1; l < n; ++l) p[l][i] = legendre(l, d.cosines[i])[0];
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      double moment = 1;  // g^l
      for (std::size_t l = 0; l < n; ++l, moment *= g) {
        const double term = static_cast<double>(2 * l + 1) * (moment - peak) / (1 - peak) * p[l][i] * p[l][j];
        result.forward[i][j] += term;
        result.backward[i][j] += l % 2 == 0 ? term : -term;
      }
      const double factor = scattered / 2 * d.weights[j] / d.cosines[i];
      result.forward[i][j] *= factor;
      result.backward[i][j] *= factor;
    }
    result.forward[i][i] -= 1 / d.cosines[i];
  }
  return result;
}

// The reflection matrix of the half-space without an interface. A thin layer, to the second order of its depth t,
//   R = B t + (F B + B F) t²/2,   T = 1 + F t + (F² + B²) t²/2,
// is doubled until it transmits nothing.
Matrix reflection_of(const Rates& rates) {
  constexpr double thin = 1.0 / (1 << 14), nothing = 1e-6;
  constexpr int most_doublings = 60;
  const Matrix &f = rates.forward, &b = rates.backward, one = identity();
  const Matrix fb = sum(product(f, b), 1, product(b, f)), squares = sum(product(f, f), 1, product(b, b));
  Matrix r = sum(sum(Matrix{}, thin, b), thin * thin / 2, fb);
  Matrix t = sum(sum(one, thin, f), thin * thin / 2, squares);
  for (int i = 0; i < most_doublings && largest(t) > nothing; ++i) {
    const Matrix into = solve(sum(one, -1, product(r, r)), t);  // radiance that enters the lower layer
    r = sum(r, 1, product(t, product(r, into)));
    t = product(t, into);
  }
  return r;
}

}  // namespace

// With the interface's reflectance F on the inside, the upward radiance U under it is R (D + F U). D ∝ 1 - F, the light
// that enters. 1 - F of U leaves.
double half_space_reflectance(double albedo, double g, double eta) {
  const Directions d = directions_for(eta);
  const Matrix r = reflection_of(rates_of(albedo, g, d));
  Vector passed{};  // 1 - F
  for (std::size_t i = 0; i < n; ++i)
    passed[i] = 1 - static_cast<double>(
                        fresnel_dielectric(static_cast<float>(d.cosines[i]), static_cast<float>(1 / eta)).reflectance);
  Matrix system = identity();
  std::array<std::array<double, 1>, n> source{};
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      system[i][j] -= r[i][j] * (1 - passed[j]);
      source[i][0] += r[i][j] * passed[j];
    }
  const auto up = solve(system, source);
  double entered = 0, left = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double flux = d.cosines[i] * d.weights[i] * passed[i];
    entered += flux;
    left += flux * up[i][0];
  }
  return left / entered;
}

// Where the albedo is near 1, the reflectance is nearly linear in √(1 - albedo). False position (Illinois).
double half_space_albedo(double reflectance, double g, double eta) {
  constexpr double tolerance = 1e-5;
  constexpr int most_steps = 30;
  if (!(reflectance > 0)) return 0;
  if (reflectance >= 1) return 1;
  double low = 0, high = 1, above = 1 - reflectance, below = -reflectance;  // reflectance found - wanted
  for (int i = 0; i < most_steps; ++i) {
    const double s = (low * below - high * above) / (below - above);
    const double error = half_space_reflectance(1 - s * s, g, eta) - reflectance;
    if (std::fabs(error) < tolerance) return 1 - s * s;
    if (error > 0) {
      low = s;
      above = error;
      below /= 2;
    } else {
      high = s;
      below = error;
      above /= 2;
    }
  }
  const double s = (low + high) / 2;
  return 1 - s * s;
}

}  // namespace lanthorn
