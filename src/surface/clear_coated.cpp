// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/clear_coated.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "math/sampler.h"
#include "math/sampling.h"
#include "surface/fresnel.h"

namespace lanthorn {
namespace {

/// Numbers that draw a visible microfacet, and their weight. Facets at grazing angles to the coat lie densely at
/// u.y = 1, where a mean over evenly spaced numbers would converge slowly: u.y = 1 - s^2.
struct FacetNumbers {
  Vec2 u;
  float weight;

  explicit FacetNumbers(const Vec2& even) : u(even.x, 1 - sqr(even.y)), weight(2 * even.y) {}
};

float layer_transmittance(float thickness, const Vec3& w) { return std::exp(-thickness / abs_cos_theta(w)); }

/// Fraction of the light from `wi`, outside, that enters the coat and reaches the base.
float entering(const Dielectric& coat, float thickness, const Vec3& wi, const Vec2& u) {
  const auto inside = sample_transmission(coat, wi, u, Transport::importance);
  return inside ? inside->weight * layer_transmittance(thickness, inside->wo) : 0.0f;
}

/// Fraction of the light that leaves the base towards `up` and returns to it, reflected by the coat.
float returning(const Dielectric& coat, float thickness, const Vec3& up, const Vec2& u) {
  const auto down = sample_reflection(coat, -up, u);
  return down ? layer_transmittance(thickness, up) * down->weight * layer_transmittance(thickness, down->wo) : 0.0f;
}

Spectrum power(Spectrum x, int n) {
  Spectrum result(1);
  for (; n > 0; n >>= 1, x *= x)
    if (n & 1) result *= x;
  return result;
}

/// Reflectance of the base with all returns of light to it: reflectance (1 + K reflectance + (K reflectance)^2 + ...).
Spectrum with_returns(const ClearCoated& c) {
  constexpr float most = 0.9999f;  // for interfaces that no light leaves
  const Spectrum again = c.reflectance * std::min(c.passage->back(), most);
  return c.reflectance * (Spectrum(1) - power(again, c.arrivals)) / (Spectrum(1) - again);
}

/// The closure with the values that its functions share. Directions are seen from above the coat.
class CoatAndBase {
 public:
  explicit CoatAndBase(const ClearCoated& c)
      : passage_(*c.passage), coat_(passage_.coat()), smooth_(is_smooth(coat_)), base_(with_returns(c)) {}

  bool has_mirror() const { return smooth_; }
  const Dielectric& coat() const { return coat_; }

  /// Fresnel reflectance, as if the coat were smooth.
  float coat_albedo(float cos) const { return fresnel_dielectric(cos, coat_.eta).reflectance; }
  Spectrum base_albedo(float cos) const { return base_ * (passage_.to_base(cos) * passage_.out()); }
  /// The base's share of the albedo.
  float base_share(float cos) const {
    const float base = max_component(base_albedo(cos));
    return base > 0 ? base / (base + coat_albedo(cos)) : 0.0f;
  }
  /// Probability of sampling the coat.
  float coat_probability(float cos) const {
    return lobe_probability(coat_albedo(cos), coat_.alpha_x, max_component(base_albedo(cos)));
  }

  BsdfValue evaluate(const Vec3& i, const Vec3& o, BsdfParts parts) const {
    BsdfValue value;
    if (parts.f) value.f = f(i, o);
    if (parts.pdf) value.pdf = pdf(i, o);
    if (parts.pdf_reverse) value.pdf_reverse = pdf(o, i);
    return value;
  }

 private:
  Spectrum f(const Vec3& i, const Vec3& o) const {
    const float through = passage_.to_base(i.z) * passage_.to_base(o.z) / sqr(coat_.eta);
    const Spectrum below = base_ * (inv_pi * through);
    return smooth_ ? below : below + lanthorn::evaluate(coat_, i, o, Transport::importance, {.f = true}).f;
  }
  float pdf(const Vec3& i, const Vec3& o) const {
    const float coat = coat_probability(i.z);
    const float below = (1 - coat) * pdf_cosine_hemisphere(o.z);
    if (smooth_) return below;
    const TrowbridgeReitz microfacets(coat_.alpha_x, coat_.alpha_y);
    return below + coat * 0.25f * microfacets.visible_d_over_dot(i, normalize(i + o));
  }

  const CoatPassage& passage_;
  const Dielectric& coat_;
  bool smooth_;
  Spectrum base_;
};

/// w seen from above.
Vec3 above(const Vec3& w) { return std::copysign(1.0f, w.z) * w; }

}  // namespace

CoatPassage::CoatPassage(const Dielectric& coat, float thickness) : coat_(coat) {
  const int n = is_smooth(coat) ? 1 : 16;
  for (std::size_t k = 0; k < to_base_.size(); ++k) {
    const float root = static_cast<float>(k) / static_cast<float>(to_base_.size() - 1), cos = sqr(root);
    const Vec3 wi(safe_sqrt(1 - cos * cos), 0, std::max(cos, 1e-6f));
    double sum = 0;
    for (int x = 0; x < n; ++x)
      for (int y = 0; y < n; ++y) {
        const FacetNumbers facet(Vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) /
                                 static_cast<float>(n));
        sum += static_cast<double>(facet.weight * entering(coat, thickness, wi, facet.u));
      }
    to_base_[k] = static_cast<float>(sum / (n * n));
  }
  // Sobol' points, because the returning light depends on three numbers. cos^2 of a cosine-distributed direction is
  // uniform.
  constexpr std::uint32_t points = 1u << 14;
  double back = 0, out = 0;
  for (std::uint32_t i = 0; i < points; ++i) {
    Sampler numbers = Sampler::for_pass(0, i);
    const FacetNumbers facet(numbers.next2());
    const float cos2 = numbers.next();
    const Vec3 up(std::sqrt(1 - cos2), 0, std::sqrt(cos2));
    back += static_cast<double>(facet.weight * returning(coat, thickness, up, facet.u));
    out += static_cast<double>(to_base(up.z));
  }
  out_ = static_cast<float>(out / points) / sqr(coat.eta);
  back_ = static_cast<float>(back / points);
}

BsdfValue evaluate(const ClearCoated& c, const Vec3& wi, const Vec3& wo, Transport /*symmetric*/, BsdfParts parts) {
  return same_hemisphere(wi, wo) ? CoatAndBase(c).evaluate(above(wi), above(wo), parts) : BsdfValue();
}

std::optional<BsdfSample> sample(const ClearCoated& c, const Vec3& wi, float u_lobe, const Vec2& u,
                                 Transport /*symmetric*/) {
  if (wi.z == 0) return std::nullopt;
  const float side = std::copysign(1.0f, wi.z);
  const Vec3 i = side * wi;
  const CoatAndBase lobes(c);
  const float coat = lobes.coat_probability(i.z);
  Vec3 o;
  if (u_lobe >= coat) {
    o = sample_cosine_hemisphere(u);
  } else {
    const auto reflected = sample_reflection(lobes.coat(), i, u);
    if (!reflected || reflected->weight == 0) return std::nullopt;
    if (lobes.has_mirror())
      return BsdfSample{
          .wo = side * reflected->wo, .weight = Spectrum(reflected->weight / coat), .pdf = coat, .delta = true};
    o = reflected->wo;
  }
  if (!(o.z > 0)) return std::nullopt;
  return sample_of_all(side * o, o.z, lobes.evaluate(i, o, {.f = true, .pdf = true}));
}

Spectrum albedo(const ClearCoated& c, const Vec3& wi) {
  const CoatAndBase lobes(c);
  const float cos = abs_cos_theta(wi);
  return Spectrum(lobes.coat_albedo(cos)) + lobes.base_albedo(cos);
}

LobeWeights lobe_weights(const ClearCoated& c, const Vec3& wi) {
  const CoatAndBase lobes(c);
  const float base = lobes.base_share(abs_cos_theta(wi));
  if (base == 0 && lobes.coat_albedo(abs_cos_theta(wi)) == 0) return {};
  const LobeWeights coat = lobe_weights(lobes.coat(), wi);
  return {.diffuse = base, .glossy = (1 - base) * coat.glossy, .delta = (1 - base) * coat.delta, .alpha = coat.alpha};
}

}  // namespace lanthorn
