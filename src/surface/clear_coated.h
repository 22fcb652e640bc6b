// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A clear dielectric coat over a Lambertian base in closed form. The base forgets where light came from, so that all
// walks between coat and base together are a product of three factors: the light that reaches the base, the reflections
// back and forth, and the light that leaves.
//   Saunderson 1942: Calculation of the Color of Pigmented Plastics [S42]
//   Guo, Hasan, Zhao 2018: Position-Free Monte Carlo Simulation for Arbitrary Layered BSDFs [G18]
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "math/table_cell.h"
#include "surface/closure.h"
#include "surface/dielectric.h"

namespace lanthorn {

/// Tabulated transmission of a clear coat. Built once for each coat, in some milliseconds. Accurate to 0.1 %.
class CoatPassage {
 public:
  /// `coat`: without film, dispersion and tint, of equal widths. `thickness` > 0: optical depth of the absorbing layer
  /// below it, along the normal.
  CoatPassage(const Dielectric& coat, float thickness);

  const Dielectric& coat() const { return coat_; }
  /// Fraction of the light from outside, from a direction of this cosine in [0,1], that reaches the base.
  float to_base(float cos) const {
    const TableCell cell = table_cell(std::sqrt(cos), to_base_.size());
    return lerp(cell.fraction, to_base_[cell.low], to_base_[cell.low + 1]);
  }
  /// Fractions of the Lambertian light that leaves the base: `out` leaves the coat at its first attempt, `back` returns
  /// to the base instead.
  float out() const { return out_; }
  float back() const { return back_; }

 private:
  Dielectric coat_;
  std::array<float, 257> to_base_{};  ///< at equidistant roots of the cosine
  float out_ = 0, back_ = 0;
};

/// The coat's reflection, and the light of the base below it, which reaches the base up to `arrivals` times: the mean
/// of the estimate of `Coated<Diffuse>` by walks of up to 2 `arrivals` segments, if its layer does not scatter. With T
/// the fraction of light that reaches the base and K the fraction that comes back to it [S42],
///   f = coat's reflection + reflectance / pi T(wi) T(wo) / eta^2 (1 + K reflectance + (K reflectance)^2 + ...).
/// Symmetric, the same from both sides.
struct ClearCoated {
  static constexpr ClosureTraits traits{.is_fibre = false, .transmits = false};

  const CoatPassage* passage = nullptr;  ///< not null
  Spectrum reflectance{};                ///< of the base, in [0,1]
  int arrivals = 5;                      ///< how often light may reach the base
};

inline bool is_smooth(const ClearCoated& c) { return is_smooth(c.passage->coat()); }

// Functions of every closure: meanings, units and conventions as for `Bsdf` (bsdf.h).

BsdfValue evaluate(const ClearCoated& c, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts);
std::optional<BsdfSample> sample(const ClearCoated& c, const Vec3& wi, float u_lobe, const Vec2& u,
                                 Transport transport);
Spectrum albedo(const ClearCoated& c, const Vec3& wi);
LobeWeights lobe_weights(const ClearCoated& c, const Vec3& wi);
inline bool has_non_delta(const ClearCoated& c) {
  return has_non_delta(c.passage->coat()) || (!c.reflectance.is_black() && c.arrivals > 0);
}
inline bool is_dispersive(const ClearCoated& /*any*/) { return false; }
inline SplitTerms split_terms(const ClearCoated& c, const Vec3& wi) {
  return split_terms_of_coat(c.passage->coat(), albedo(c, wi), wi);
}

}  // namespace lanthorn
