// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/plastic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "math/sampling.h"
#include "math/table_cell.h"

namespace lanthorn {

namespace {

float schlick(float cos) { return sqr(sqr(1 - cos)) * (1 - cos); }

/// Fresnel terms as functions of the cosine: each is a sum of N basis functions, with its own coefficients.
template <std::size_t N>
using Basis = std::array<float, N>;

/// Basis of Schlick's term: the coefficients are f0 and f90.
Basis<2> schlick_basis(float cos) { return {1 - schlick(cos), schlick(cos)}; }

/// Basis of any other term: the coefficients are its values at equidistant square roots of the cosine, linear in
/// between.
constexpr std::size_t film_nodes = 12;
Basis<film_nodes> film_basis(float cos) {
  const TableCell cell = table_cell(std::sqrt(cos), film_nodes);
  Basis<film_nodes> hats{};
  hats[cell.low] = 1 - cell.fraction;
  hats[cell.low + 1] = cell.fraction;
  return hats;
}

constexpr std::size_t widths = 17, cosines = 65;

/// Albedos of the microfacets for the terms of a basis, by width and cosine, and their cosine-weighted means over the
/// hemisphere.
template <std::size_t N>
struct AlbedoTable {
  std::array<std::array<Basis<N>, cosines>, widths> at{};
  std::array<Basis<N>, widths> mean{};
};

// Integrates over visible normals, with n x n evenly spaced samples.
template <std::size_t N>
Basis<N> microfacet_albedo(Basis<N> (*basis)(float), float alpha, float cos) {
  if (alpha == 0) return basis(cos);
  const TrowbridgeReitz microfacets(alpha, alpha);
  const Vec3 i(safe_sqrt(1 - cos * cos), 0, std::max(cos, 1e-4f));
  constexpr int n = 24;
  std::array<double, N> sum{};
  for (int x = 0; x < n; ++x)
    for (int y = 0; y < n; ++y) {
      const Vec2 u((static_cast<float>(x) + 0.5f) / n, (static_cast<float>(y) + 0.5f) / n);
      const Normal m = microfacets.sample(i, u);
      const float cos_m = dot(i, m);
      const Vec3 o = 2 * cos_m * m - i;
      if (cos_m <= 0 || o.z <= 0) continue;
      const float weight = microfacets.g_over_g1(i, o);
      const Basis<N> terms = basis(cos_m);
      for (std::size_t k = 0; k < N; ++k) sum[k] += static_cast<double>(weight * terms[k]);
    }
  Basis<N> result{};
  for (std::size_t k = 0; k < N; ++k) result[k] = static_cast<float>(sum[k] / (n * n));
  return result;
}

// 2 ∫ E cos dcos, exact for values linear between the nodes.
template <std::size_t N>
Basis<N> mean_albedo(const std::array<Basis<N>, cosines>& at) {
  Basis<N> result{};
  constexpr double step = 1.0 / (cosines - 1);
  for (std::size_t k = 0; k < N; ++k) {
    double sum = 0;
    for (std::size_t c = 0; c + 1 < cosines; ++c) {
      const auto first = static_cast<double>(at[c][k]), second = static_cast<double>(at[c + 1][k]);
      sum += step * (static_cast<double>(c) * step * (first + second) + step * (first + 2 * second) / 3);
    }
    result[k] = static_cast<float>(sum);
  }
  return result;
}

template <std::size_t N>
AlbedoTable<N> make_table(Basis<N> (*basis)(float)) {
  AlbedoTable<N> table;
  for (std::size_t w = 0; w < widths; ++w) {
    const float alpha = static_cast<float>(w) / (widths - 1);
    for (std::size_t c = 0; c < cosines; ++c)
      table.at[w][c] = microfacet_albedo(basis, alpha, static_cast<float>(c) / (cosines - 1));
    table.mean[w] = mean_albedo(table.at[w]);
  }
  return table;
}

const AlbedoTable<2>& schlick_table() {
  static const AlbedoTable<2> only = make_table(schlick_basis);
  return only;
}
const AlbedoTable<film_nodes>& film_table() {
  static const AlbedoTable<film_nodes> only = make_table(film_basis);
  return only;
}

/// Albedo of one surface's reflection.
template <std::size_t N>
class ReflectionAlbedo {
 public:
  ReflectionAlbedo(const AlbedoTable<N>& table, const std::array<Spectrum, N>& coefficients, float alpha)
      : table_(table), coefficients_(coefficients), width_(table_cell(alpha, widths)) {}

  /// At a cosine in [0,1].
  Spectrum at(float cos) const {
    const TableCell c = table_cell(cos, cosines);
    const auto across = [&](std::size_t row) {
      return sum(table_.at[row][c.low], table_.at[row][c.low + 1], c.fraction);
    };
    return across(width_.low) * (1 - width_.fraction) + across(width_.low + 1) * width_.fraction;
  }
  Spectrum mean() const { return sum(table_.mean[width_.low], table_.mean[width_.low + 1], width_.fraction); }

 private:
  Spectrum sum(const Basis<N>& low, const Basis<N>& high, float fraction) const {
    Spectrum result;
    for (std::size_t k = 0; k < N; ++k) result += coefficients_[k] * lerp(fraction, low[k], high[k]);
    return result;
  }

  const AlbedoTable<N>& table_;
  std::array<Spectrum, N> coefficients_;
  TableCell width_;
};

Spectrum fresnel(const Plastic& p, float cos) {
  if (p.film && p.f90 > 0) return p.f90 * film_reflectance(p.film, cos, index_from_reflectance(p.f0 / Spectrum(p.f90)));
  return p.f0 + (Spectrum(p.f90) - p.f0) * schlick(cos);
}

/// Calls `f` with the albedo of the reflection.
template <class F>
auto with_albedo(const Plastic& p, const F& f) {
  if (!p.film) return f(ReflectionAlbedo<2>(schlick_table(), {p.f0, Spectrum(p.f90)}, p.alpha));
  std::array<Spectrum, film_nodes> values;
  for (std::size_t k = 0; k < film_nodes; ++k) values[k] = fresnel(p, sqr(static_cast<float>(k) / (film_nodes - 1)));
  return f(ReflectionAlbedo<film_nodes>(film_table(), values, p.alpha));
}

// Probability of sampling the reflection, of the albedo `e`, rather than the base.
float specular_probability(const Plastic& p, const Spectrum& e) {
  return lobe_probability(max_component(e), p.alpha, max_component((Spectrum(1) - e) * p.reflectance));
}

// The base's f, and the probabilities of sampling the reflection from either direction.
struct BaseValue {
  Spectrum f{};
  float specular_i = 1, specular_o = 1;
};

BaseValue evaluate_base(const Plastic& p, float cos_i, float cos_o, BsdfParts parts) {
  if (p.reflectance.is_black()) return {};
  return with_albedo(p, [&](const auto& reflection) {
    BaseValue value;
    const Spectrum one(1);
    const Spectrum e_i = parts.f || parts.pdf ? reflection.at(cos_i) : one;
    const Spectrum e_o = parts.f || parts.pdf_reverse ? reflection.at(cos_o) : one;
    if (parts.f) {
      const Spectrum rest = map(one - reflection.mean(), [](float x) { return std::max(x, 1e-6f); });
      value.f = p.reflectance * inv_pi * (one - e_i) * (one - e_o) / rest;
    }
    if (parts.pdf) value.specular_i = specular_probability(p, e_i);
    if (parts.pdf_reverse) value.specular_o = specular_probability(p, e_o);
    return value;
  });
}

}  // namespace

Spectrum specular_albedo(const Plastic& p, float cos) {
  return with_albedo(p, [&](const auto& reflection) { return reflection.at(cos); });
}

BsdfValue evaluate(const Plastic& p, const Vec3& wi, const Vec3& wo, Transport /*symmetric*/, BsdfParts parts) {
  if (!same_hemisphere(wi, wo)) return {};
  const float side = std::copysign(1.0f, wi.z);
  const Vec3 i = side * wi, o = side * wo;
  const BaseValue base = evaluate_base(p, i.z, o.z, parts);
  const BsdfValue below{base.f, (1 - base.specular_i) * pdf_cosine_hemisphere(o.z),
                        (1 - base.specular_o) * pdf_cosine_hemisphere(i.z)};
  if (is_smooth(p)) return below;
  const HalfwayReflection reflection({p.alpha, p.alpha}, i, o);
  return {parts.f ? below.f + fresnel(p, reflection.cos_i()) * reflection.f() : Spectrum(),
          below.pdf + base.specular_i * reflection.pdf(),
          below.pdf_reverse + base.specular_o * reflection.pdf_reverse()};
}

std::optional<BsdfSample> sample(const Plastic& p, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport) {
  if (wi.z == 0) return std::nullopt;
  const float side = std::copysign(1.0f, wi.z);
  const Vec3 i = side * wi;
  const float choose = evaluate_base(p, i.z, i.z, {.pdf = true}).specular_i;
  Vec3 o;
  if (u_lobe < choose) {
    if (is_smooth(p))
      return BsdfSample{.wo = {-wi.x, -wi.y, wi.z}, .weight = fresnel(p, i.z) / choose, .pdf = choose, .delta = true};
    const Normal m = TrowbridgeReitz(p.alpha, p.alpha).sample(i, u);
    o = 2 * dot(i, m) * m - i;
    if (dot(i, m) <= 0) return std::nullopt;
  } else {
    o = sample_cosine_hemisphere(u);
  }
  if (o.z <= 0) return std::nullopt;
  return sample_of_all(side * o, o.z, evaluate(p, wi, side * o, transport, {.f = true, .pdf = true}));
}

Spectrum albedo(const Plastic& p, const Vec3& wi) {
  const Spectrum reflected = specular_albedo(p, abs_cos_theta(wi));
  return reflected + (Spectrum(1) - reflected) * p.reflectance;
}

LobeWeights lobe_weights(const Plastic& p, const Vec3& wi) {
  const Spectrum e = specular_albedo(p, abs_cos_theta(wi));
  const float reflected = max_component(e), below = max_component((Spectrum(1) - e) * p.reflectance);
  if (reflected + below <= 0) return {};
  const float share = reflected / (reflected + below);
  const LobeWeights surface = microfacet_lobe(p.alpha, p.alpha);
  return {
      .diffuse = 1 - share, .glossy = share * surface.glossy, .delta = share * surface.delta, .alpha = surface.alpha};
}

SplitTerms split_terms(const Plastic& p, const Vec3& wi) {
  const Spectrum reflected = specular_albedo(p, abs_cos_theta(wi));
  return {.diffuse = (Spectrum(1) - reflected) * p.reflectance, .f0 = p.f0, .f90 = Spectrum(p.f90), .alpha = p.alpha};
}

}  // namespace lanthorn
