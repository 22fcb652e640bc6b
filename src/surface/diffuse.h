// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "math/frame.h"
#include "math/sampling.h"
#include "surface/closure.h"

namespace lanthorn {

/// Lambertian reflection on both sides: light leaves on the side on which it arrives.
struct Diffuse {
  static constexpr ClosureTraits traits{.is_fibre = false, .transmits = false};

  Spectrum reflectance{};  ///< fraction reflected, in [0,1]
};

/// Lambertian reflection and transmission, the same from either side. Conserves energy if reflectance + transmittance
/// <= 1 in every component; the caller must ensure this.
struct DiffuseTransmission {
  static constexpr ClosureTraits traits{.is_fibre = false, .transmits = true};

  Spectrum reflectance{};    ///< fraction that leaves on the side on which it arrived
  Spectrum transmittance{};  ///< fraction that leaves on the other side
};

inline bool is_smooth(const Diffuse& /*any*/) { return false; }

// Functions of every closure: meanings, units and conventions as for `Bsdf` (bsdf.h).

inline BsdfValue evaluate(const Diffuse& d, const Vec3& wi, const Vec3& wo, Transport /*both are equal*/,
                          BsdfParts /*all*/) {
  if (!same_hemisphere(wi, wo)) return {};
  return {d.reflectance * inv_pi, pdf_cosine_hemisphere(abs_cos_theta(wo)), pdf_cosine_hemisphere(abs_cos_theta(wi))};
}

inline std::optional<BsdfSample> sample(const Diffuse& d, const Vec3& wi, float /*u_lobe: one lobe*/, const Vec2& u,
                                        Transport /*both are equal*/) {
  std::optional<BsdfSample> result;
  const Vec3 up = sample_cosine_hemisphere(u);
  if (up.z == 0 || wi.z == 0) return result;
  BsdfSample& s = result.emplace();
  s.wo = {up.x, up.y, std::copysign(up.z, wi.z)};
  s.weight = d.reflectance;
  s.pdf = pdf_cosine_hemisphere(up.z);
  return result;
}

/// Probability of sampling reflection, proportional to the lobes' largest components; 0 if both are black.
inline float reflection_probability(const DiffuseTransmission& d) {
  const float r = max_component(d.reflectance);
  const float t = max_component(d.transmittance);
  return r > 0 ? r / (r + t) : 0.0f;
}

inline BsdfValue evaluate(const DiffuseTransmission& d, const Vec3& wi, const Vec3& wo, Transport /*both are equal*/,
                          BsdfParts /*all*/) {
  const bool reflected = same_hemisphere(wi, wo);
  const float p = reflection_probability(d), p_lobe = reflected ? p : 1.0f - p;
  return {(reflected ? d.reflectance : d.transmittance) * inv_pi, pdf_cosine_hemisphere(abs_cos_theta(wo)) * p_lobe,
          pdf_cosine_hemisphere(abs_cos_theta(wi)) * p_lobe};
}

inline std::optional<BsdfSample> sample(const DiffuseTransmission& d, const Vec3& wi, float u_lobe, const Vec2& u,
                                        Transport /*both are equal*/) {
  Vec3 wo = sample_cosine_hemisphere(u);
  if (wo.z == 0 || wi.z == 0) return std::nullopt;
  const float p = reflection_probability(d);
  const bool reflected = u_lobe < p;
  const float p_lobe = reflected ? p : 1.0f - p;
  const float density = pdf_cosine_hemisphere(wo.z) * p_lobe;
  wo.z = std::copysign(wo.z, reflected ? wi.z : -wi.z);
  return BsdfSample{.wo = wo,
                    .weight = (reflected ? d.reflectance : d.transmittance) / p_lobe,
                    .pdf = density,
                    .transmission = !reflected};
}

inline Spectrum albedo(const Diffuse& d, const Vec3& /*any*/) { return d.reflectance; }
inline LobeWeights lobe_weights(const Diffuse& d, const Vec3& /*any*/) {
  return {.diffuse = d.reflectance.is_black() ? 0.0f : 1.0f};
}
inline bool has_non_delta(const Diffuse& d) { return !d.reflectance.is_black(); }
inline bool is_dispersive(const Diffuse& /*any*/) { return false; }
inline SplitTerms split_terms(const Diffuse& d, const Vec3& /*any*/) { return {.diffuse = d.reflectance}; }

inline Spectrum albedo(const DiffuseTransmission& d, const Vec3& /*any*/) { return d.reflectance + d.transmittance; }
inline bool has_non_delta(const DiffuseTransmission& d) {
  return !d.reflectance.is_black() || !d.transmittance.is_black();
}
inline LobeWeights lobe_weights(const DiffuseTransmission& d, const Vec3& /*any*/) {
  return {.diffuse = has_non_delta(d) ? 1.0f : 0.0f};
}
inline bool is_dispersive(const DiffuseTransmission& /*any*/) { return false; }
inline SplitTerms split_terms(const DiffuseTransmission& d, const Vec3& /*any*/) {
  return {.diffuse = d.reflectance, .diffuse_behind = d.transmittance};
}

}  // namespace lanthorn
