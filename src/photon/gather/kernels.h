// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Kernels of density estimation on surfaces, normalised over the disc.
// Jensen, "Realistic Image Synthesis Using Photon Mapping" (2001), ch. 7 · Knaus & Zwicker 2011 · García Hernández et
// al., "Overestimation and Underestimation Biases in Photon Mapping with Non-Constant Kernels" (2014).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>

#include "index/point_index.h"
#include "math/vec.h"

namespace lanthorn {

enum class KernelShape : std::uint8_t {
  box,
  cone,          ///< 1 - d/(k r) (Jensen 2001, eq. 7.8)
  epanechnikov,  ///< 1 - d²/r²
  gaussian,      ///< truncated Gaussian; its standard deviation is the box kernel's radius (Knaus & Zwicker 2011)
};

/// Half height / radius of the disc that is searched for photons. Photons farther from the tangent plane belong to
/// another surface.
inline constexpr float search_flatness = 0.2f;
/// True if a point at `height` (m) over a tangent plane is near enough to it for a disc of radius `reach` (m).
inline bool is_in_disc(float height, float reach) { return std::fabs(height) <= search_flatness * reach; }

/// A radial kernel on the disc of its support radius R. `profile` is dimensionless with mean 1 over the disc, so
/// `weight = profile / (π R²)` (1/m²) integrates to 1.
struct Kernel {
  KernelShape shape = KernelShape::box;
  float cone_slope = 1;  ///< k >= 1 of the cone: its value reaches 0 at k R

  /// Support radius R, beyond which the kernel is 0; `radius`: of the equivalent box kernel. 3σ with σ = radius for
  /// `gaussian`, otherwise the radius itself. Queries use this radius.
  float support(float radius) const { return shape == KernelShape::gaussian ? gaussian_cut * radius : radius; }

  /// Value at u = dist²/R² in [0, 1], relative to the box kernel.
  float profile(float u) const {
    switch (shape) {
      case KernelShape::box:
        return 1;
      case KernelShape::cone:
        return (1 - std::sqrt(u) / cone_slope) / (1 - 2 / (3 * cone_slope));
      case KernelShape::epanechnikov:
        return 2 * (1 - u);
      case KernelShape::gaussian:
        return gaussian_peak * std::exp(-gaussian_rate * u);
    }
    return 0;
  }

  /// Density (1/m²) at squared distance `dist2` from the centre for the support radius² `support2` > 0;
  /// 0 <= dist2 <= support2.
  float weight(float dist2, float support2) const { return profile(dist2 / support2) * inv_pi / support2; }

  /// A photon's contribution to the estimated bias, relative to its contribution to the light; u = dist²/R². The
  /// photons within R/√2 give a second estimate of the light. Where light is smooth, the bias of either estimate is
  /// proportional to the square of its radius (Silverman 1986, eq. 4.8), so that the difference between the two is half
  /// the bias of the wider one. `dimensions`: of the kernel's support.
  float bias_share(float u, int dimensions = 2) const {
    if (u >= 0.5f) return 2;
    constexpr std::array<float, 4> peaks{1, std::numbers::sqrt2_v<float>, 2, 2 * std::numbers::sqrt2_v<float>};
    const float narrow = peaks[static_cast<std::size_t>(dimensions)];  // peak of the narrower kernel over the wider's
    return 2 - 2 * narrow * profile(2 * u) / profile(u);
  }

  friend bool operator==(const Kernel&, const Kernel&) = default;

 private:
  static constexpr float gaussian_cut = 3;  // in units of σ
  static constexpr float gaussian_rate = gaussian_cut * gaussian_cut / 2;
  static constexpr float gaussian_peak = gaussian_rate / (1 - 0.0111089965f);  // over 1 - exp(-rate)
};

/// ∫K² and ∫K x² of a kernel on the unit disc. With support R, the variance of the estimate is `roughness / R²` times
/// the variance of a photon's light per area, and its bias is half of `second R²` times the Laplacian of the light.
struct KernelMoments {
  float roughness = 0, second = 0;
};
KernelMoments moments_of(const Kernel& kernel);

/// A kernel across a line (1 dimension, both sides), over a disc (2) or in a ball (3), with integral 1.
class KernelIn {
 public:
  KernelIn(int dimensions, const Kernel& kernel, float radius);

  /// Radius of the equivalent box kernel, m.
  float radius() const { return radius_; }
  float support() const { return support_; }
  /// Size of the equivalent box kernel: m, m² or m³.
  float box_size() const { return box_size_; }
  /// Density (per m, m² or m³) at squared distance `dist2` from the centre, at most support()².
  float weight(float dist2) const { return scale_ * kernel_.profile(share_of_support(dist2)); }
  /// See Kernel.
  float bias_share(float dist2) const { return kernel_.bias_share(share_of_support(dist2), dimensions_); }

 private:
  float share_of_support(float dist2) const { return std::min(1.0f, dist2 / (support_ * support_)); }

  Kernel kernel_;
  int dimensions_;
  float radius_, support_, box_size_, scale_;
};

/// The photons of an estimate, each to be weighted by `kernel.weight(dist2, support2)`.
struct GatherDisc {
  float support2;  ///< m², > 0
  std::span<const Neighbour> counted;
};

/// The disc of an estimate from `found`, the result of a `nearest` query for k neighbours within max_radius. The k-th
/// neighbour bounds the disc. The sum leaves it out, which makes the estimate unbiased on a uniform field (García
/// Hernández et al. 2014). With fewer neighbours, `max_radius` bounds the disc. nullopt if the sum is empty or all k
/// points coincide with the query point.
std::optional<GatherDisc> gather_disc(std::span<const Neighbour> found, std::size_t k, float max_radius);

}  // namespace lanthorn
