// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Trowbridge-Reitz (GGX) microfacets with Smith's shadowing.
//   Walter, Marschner, Li, Torrance 2007: Microfacet Models for Refraction through Rough Surfaces [W07]
//   Heitz 2014: Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs [H14]
//   Heitz 2018: Sampling the GGX Distribution of Visible Normals [H18]
//   Dupuy & Benyoub 2023: Sampling Visible GGX Normals with Spherical Caps [D23]
#pragma once

#include <algorithm>

#include "math/frame.h"
#include "surface/closure.h"

namespace lanthorn {

/// GGX slope width for a scene file's perceptual roughness: alpha = sqrt(roughness).
inline float roughness_to_alpha(float roughness) { return safe_sqrt(roughness); }

/// Below this width a lobe is a delta function.
inline constexpr float smooth_alpha_limit = 1e-3f;
inline bool effectively_smooth(float alpha_x, float alpha_y) { return std::max(alpha_x, alpha_y) < smooth_alpha_limit; }

/// Width of the isotropic distribution that replaces an anisotropic one.
inline float geometric_alpha(float alpha_x, float alpha_y) { return std::sqrt(alpha_x * alpha_y); }
/// LobeWeights of a closure with a single microfacet lobe.
inline LobeWeights microfacet_lobe(float alpha_x, float alpha_y) {
  if (effectively_smooth(alpha_x, alpha_y)) return {.delta = 1};
  return {.glossy = 1, .alpha = geometric_alpha(alpha_x, alpha_y)};
}

/// The distribution of microfacet normals. Directions must lie on the side of the normal (z > 0); callers negate
/// directions on the other side, which by symmetry gives the same.
class TrowbridgeReitz {
 public:
  /// RMS-like slope widths along local x and y; values below 1e-4 are raised to it.
  TrowbridgeReitz(float alpha_x, float alpha_y) : ax_(std::max(alpha_x, 1e-4f)), ay_(std::max(alpha_y, 1e-4f)) {}

  /// Density of microfacet area per solid angle of normal `m` and per macroscopic area, 1/sr [H14 eq. 85].
  float d(const Normal& m) const {
    const float e = sqr(m.x / ax_) + sqr(m.y / ay_) + m.z * m.z;
    return 1.0f / (pi * ax_ * ay_ * e * e);
  }

  /// |(alpha_x x, alpha_y y, z)|: the length of w in the space in which the microsurface is a hemisphere. All of
  /// Smith's terms are rational functions of this length and z, without division by a small cosine.
  float stretched_length(const Vec3& w) const { return std::sqrt(sqr(ax_ * w.x) + sqr(ay_ * w.y) + w.z * w.z); }

  /// Smith's Lambda: ratio of masked to visible projected area [H14 eq. 86].
  float lambda(const Vec3& w) const { return 0.5f * (stretched_length(w) / w.z - 1.0f); }
  /// Fraction of the microsurface visible from w [H14 eq. 43].
  float g1(const Vec3& w) const { return 2 * w.z / (w.z + stretched_length(w)); }
  /// Fraction visible from both, with height-correlated masking and shadowing [H14 eq. 99].
  float g(const Vec3& wi, const Vec3& wo) const {
    return 2 * wi.z * wo.z / (wo.z * stretched_length(wi) + wi.z * stretched_length(wo));
  }
  /// g(wi, wo) / (wi.z wo.z), finite at grazing angles.
  float g_over_cosines(const Vec3& wi, const Vec3& wo) const {
    return 2 / (wo.z * stretched_length(wi) + wi.z * stretched_length(wo));
  }
  /// g(wi, wo) / g1(wi): sample weight for normals sampled among those visible from wi. At most 1.
  float g_over_g1(const Vec3& wi, const Vec3& wo) const {
    const float li = stretched_length(wi);
    return wo.z * (wi.z + li) / (wo.z * li + wi.z * stretched_length(wo));
  }

  /// Density of the normals visible from w, divided by dot(w, m). Times dot(w, m): pdf of `sample` per solid angle of
  /// m. Divided by 4: pdf of the reflected direction [H18 eq. 3 and 17].
  float visible_d_over_dot(const Vec3& w, const Normal& m) const { return 2 * d(m) / (w.z + stretched_length(w)); }

  /// Samples a normal among those visible from w [D23, listing 3].
  Normal sample(const Vec3& w, const Vec2& u) const {
    const Vec3 v = Vec3(ax_ * w.x, ay_ * w.y, w.z) / stretched_length(w);
    const float phi = 2 * pi * u.x;
    const float z = (1.0f - u.y) * (1.0f + v.z) - v.z;
    const float r = safe_sqrt(1.0f - z * z);
    const Vec3 h = Vec3(r * std::cos(phi), r * std::sin(phi), z) + v;
    return normalize(Vec3(ax_ * h.x, ay_ * h.y, std::max(h.z, 1e-9f)));
  }

 private:
  float ax_;
  float ay_;
};

/// Reflection between two directions above the surface, by the microfacet half-way between them: what f and both
/// densities share.
class HalfwayReflection {
 public:
  HalfwayReflection(const TrowbridgeReitz& microfacets, const Vec3& i, const Vec3& o)
      : m_(normalize(i + o)),
        d_(microfacets.d(m_)),
        i_(i),
        o_(o),
        length_i_(microfacets.stretched_length(i)),
        length_o_(microfacets.stretched_length(o)) {}

  float cos_i() const { return dot(i_, m_); }
  float cos_o() const { return dot(o_, m_); }
  /// f without the Fresnel factor [W07 eq. 20].
  float f() const { return 0.25f * d_ * (2 / (o_.z * length_i_ + i_.z * length_o_)); }
  /// Density of sampling o from i by a normal visible from i, and of i from o.
  float pdf() const { return 0.25f * (2 * d_ / (i_.z + length_i_)); }
  float pdf_reverse() const { return 0.25f * (2 * d_ / (o_.z + length_o_)); }

 private:
  Normal m_;
  float d_;
  Vec3 i_, o_;
  float length_i_, length_o_;
};

}  // namespace lanthorn
