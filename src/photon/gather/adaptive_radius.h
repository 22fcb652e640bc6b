// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Adaptive radii of progressive photon mapping, one for each pixel or hit point: the photons of earlier passes
// determine them. (Radii that depend on the pass number alone are in radius_schedule.h.) The picture is the mean over
// passes of plain density estimates, each with the radius before its pass. This equals Hachisuka's τ_N / (π r²_N N):
// with τ' = (τ + τ_M) r'²/r² it telescopes to the mean of τ_M / (π r²). The statistics therefore store no light.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "math/frame.h"
#include "math/vec.h"
#include "photon/gather/disc_tests.h"
#include "photon/gather/kernels.h"
#include "photon/gather/photon_gather.h"

namespace lanthorn {

/// Settings shared by all points.
struct AdaptiveRadiusSettings {
  float alpha = 2.0f / 3;  ///< share of new photons that are kept, in (0, 1]
  Kernel kernel;
  KernelMoments moments = moments_of(kernel);
};

/// One radius for each point. `Tally` collects statistics during a gather; `update` takes them after it. `radius` is
/// the radius of the equivalent box kernel; `reach` is the distance up to which the tally needs photons. `is_possible`:
/// whether a render whose first radii are at most `largest` (m) can have produced this object; its bytes may come from
/// a file.
template <class R>
concept AdaptiveRadius = std::is_trivially_copyable_v<R> && std::constructible_from<R, float> &&
    std::constructible_from<typename R::Tally, const R&, const AdaptiveRadiusSettings&> &&
    requires(R radius, typename R::Tally tally, const AdaptiveRadiusSettings& s, MetPhoton photon, Frame frame) {
  { std::as_const(radius).radius() } -> std::same_as<float>;
  { std::as_const(radius).reach(s) } -> std::same_as<float>;
  { std::as_const(radius).is_possible(1.0f) } -> std::same_as<bool>;
  tally.see(photon, frame);
  radius.update(tally, s);
};

/// True for radii (m) that a search for photons can use: finite, at least 0 and at most `largest`.
inline bool is_radius(float radius, float largest) { return radius >= 0 && radius <= largest && std::isfinite(radius); }
/// True if the number can be a sum of non-negative numbers: finite and at least 0.
template <class Number>
bool is_positive_sum(Number sum) {
  return sum >= 0 && std::isfinite(sum);
}

/// Progressive photon mapping (Hachisuka, Ogaki & Jensen 2008, eqs. 8 to 10; per pixel: Hachisuka & Jensen 2009): of M
/// new photons αM are kept, N' = N + αM, and the new radius preserves the density: r'² = r² N' / (N + M).
class HachisukaRadius {
 public:
  explicit HachisukaRadius(float first) : radius_(static_cast<double>(first)) {}

  struct Tally {
    std::uint32_t photons = 0;
    Tally(const HachisukaRadius&, const AdaptiveRadiusSettings&) {}
    void see(const MetPhoton&, const Frame&) { ++photons; }
  };
  float radius() const { return static_cast<float>(radius_); }
  float reach(const AdaptiveRadiusSettings& s) const { return s.kernel.support(radius()); }
  void update(const Tally& tally, const AdaptiveRadiusSettings& s) {
    if (tally.photons == 0) return;
    const double kept = photons_ + static_cast<double>(s.alpha) * tally.photons;
    radius_ *= std::sqrt(kept / (photons_ + tally.photons));
    photons_ = kept;
  }
  bool is_possible(float largest) const { return is_radius(radius(), largest) && is_positive_sum(photons_); }

 private:
  // Both members have the same size, because saved states hold the object's bytes, which must not have padding.
  double radius_;
  double photons_ = 0;  // N
};

/// The radius of least mean squared error, after Kaplanyan & Dachsbacher 2013 ("Adaptive progressive photon mapping"):
/// variance and bias of the estimate are estimated from the photons, the bias by the Laplacian of the light.
///
/// With support R, a pass has variance v ρ / R² (v the mean of Σ light² / area, ρ = ∫K² of the kernel on the unit disc)
/// and bias b R², b = μ Δ/2 (μ = ∫K x²). With R_k ~ k^(-1/6) over N passes, the mean of the passes has variance
/// (3/4) v ρ / (N R²_N) and bias (3/2) b R²_N; their squared error is least for R⁶ = v ρ / (6 N b²).
class LeastErrorRadius {
 public:
  explicit LeastErrorRadius(float first) : first_(first), widest_(first), radius_(first) {}

  struct Tally {
    float support2, reach2;
    float squares = 0;             // Σ light² within the support
    float laplacian = 0;           // Σ light · stencil within `reach`
    float laplacian_variance = 0;  // Σ (light · stencil)²
    Tally(const LeastErrorRadius& r, const AdaptiveRadiusSettings& s)
        : support2(sqr(s.kernel.support(r.radius()))), reach2(sqr(r.reach(s))) {}
    void see(const MetPhoton& photon, const Frame&) {
      const float light = sum_of(photon.light);
      if (photon.dist2 <= support2) squares += sqr(light);
      // A stencil of mean 0 whose second moment gives Δ: (24/π)(2u - 1)/h⁴, u = d²/h².
      const float d = light * (24 * inv_pi) * (2 * photon.dist2 / reach2 - 1) / sqr(reach2);
      laplacian += d;
      laplacian_variance += sqr(d);
    }
  };
  float radius() const { return radius_; }
  /// The estimate of the Laplacian needs more photons than the estimate of the light: those within up to twice the
  /// radius.
  float reach(const AdaptiveRadiusSettings& s) const { return s.kernel.support(std::min(2 * radius_, widest_)); }
  void update(const Tally& tally, const AdaptiveRadiusSettings& s);
  bool is_possible(float largest) const {
    return is_radius(first_, largest) && is_radius(widest_, first_) && is_radius(radius_, first_) &&
           is_positive_sum(squares_) && std::isfinite(laplacian_) && is_positive_sum(laplacian_variance_);
  }

 private:
  float first_, widest_, radius_;
  std::uint32_t gathers_ = 0;
  float squares_ = 0, laplacian_ = 0, laplacian_variance_ = 0;  // sums over gathers, the first per area
};

/// A radius that shrinks where the photons within it are not uniformly distributed (Lin et al. 2020, see
/// `rejects_uniformity`). If the counts of photons reject a uniform density, the radius shrinks and the counts start
/// again at zero.
class ChiSquaredRadius {
 public:
  explicit ChiSquaredRadius(float first) : first_(first), radius_(first) {}

  struct Tally {
    float half2;
    SectorCounts counts{};
    Tally(const ChiSquaredRadius& r, const AdaptiveRadiusSettings& s) : half2(sqr(r.reach(s)) / 2) {}
    void see(const MetPhoton& photon, const Frame& frame) {
      ++counts[sector_of(frame.to_local(photon.offset), photon.dist2 > half2)];
    }
  };
  float radius() const { return radius_; }
  float reach(const AdaptiveRadiusSettings& s) const { return s.kernel.support(radius_); }
  void update(const Tally& tally, const AdaptiveRadiusSettings& s);
  bool is_possible(float largest) const { return is_radius(first_, largest) && is_radius(radius_, first_); }

 private:
  float first_, radius_;
  std::uint32_t gathers_ = 0;
  SectorCounts counts_{};
};

}  // namespace lanthorn
