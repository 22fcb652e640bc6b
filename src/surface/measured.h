// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "lanthorn/measured_data.h"
#include "math/bilinear_distribution.h"
#include "spectrum/wavelengths.h"
#include "surface/closure.h"

namespace lanthorn {

/// A measured BRDF prepared for evaluation: f(view, light), not necessarily symmetric. Both directions lie above the
/// surface (z > 0). Immutable.
class MeasuredBrdf {
 public:
  /// `data` must outlive this object and satisfy its documented conditions. The albedo is the mean over `albedo_side`^2
  /// samples for each incident direction.
  explicit MeasuredBrdf(const MeasuredData& data, int albedo_side = 12);

  /// f, and the density of `sample` per solid angle of `light`; without `pdf_reverse`.
  BsdfValue evaluate(const Vec3& view, const Vec3& light, const Wavelengths& w, BsdfParts parts) const;
  /// Samples `light` according to the measured luminance; nullopt if it would lie below the surface.
  std::optional<Vec3> sample(const Vec3& view, const Vec2& u) const;
  /// Approximate fraction of light that is reflected, in [0,1].
  Spectrum albedo(const Vec3& view, const Wavelengths& w) const;
  /// Width of the GGX distribution with the same peak as this distribution of normals; in (0,1].
  float alpha() const { return alpha_; }

 private:
  struct Place;

  Blend incidence(const Vec3& view) const;
  Vec2 normal_in_square(const Vec3& m, const Vec3& view) const;
  std::optional<Place> find(const Vec3& view, const Vec3& light) const;
  std::optional<Place> draw(const Vec3& view, const Vec2& u) const;
  float sampling_pdf(const Vec3& view, const Place& place) const;
  float factor(const Vec3& view, const Place& place) const;
  template <class Lookup>
  Spectrum in_colour_mode(const Wavelengths& w, const Lookup& lookup) const;
  Spectrum reflectance(const Place& place, const Wavelengths& w) const;
  std::vector<float> mean_weights(int side) const;
  float equivalent_alpha() const;

  const MeasuredData* data_;
  BilinearDistributions vndf_, luminance_;
  NodeGrids rgb_;                  ///< the reflectance in Rec.709, if the data is spectral
  std::vector<float> albedo_;      ///< by incident direction and channel
  std::vector<float> rgb_albedo_;  ///< the same in Rec.709, if the data is spectral
  float alpha_ = 1;
};

/// A surface with the same measured BRDF on both sides.
struct Measured {
  static constexpr ClosureTraits traits{.is_fibre = false, .transmits = false};

  const MeasuredBrdf* brdf = nullptr;
  Wavelengths wavelengths;  ///< of the path
};

// Functions of every closure: meanings, units and conventions as for `Bsdf` (bsdf.h). Measurements
// are only approximately reciprocal. `importance` uses the value of `radiance` with the directions exchanged, so that
// light paths and eye paths see the same surface.

BsdfValue evaluate(const Measured& m, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts);
std::optional<BsdfSample> sample(const Measured& m, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport);
Spectrum albedo(const Measured& m, const Vec3& wi);
inline LobeWeights lobe_weights(const Measured& m, const Vec3& /*any*/) {
  return {.glossy = 1, .alpha = m.brdf->alpha()};
}
inline bool has_non_delta(const Measured& /*any*/) { return true; }
inline bool is_dispersive(const Measured& /*any*/) { return false; }
inline SplitTerms split_terms(const Measured& /*any*/, const Vec3& /*any*/) {
  return {.missing = "measured materials"};
}

}  // namespace lanthorn
