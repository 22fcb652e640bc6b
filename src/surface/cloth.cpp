// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/cloth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "math/sampling.h"
#include "math/table_cell.h"

namespace lanthorn {

namespace {

// D V for directions above the surface.
float fibres(float alpha, const Vec3& i, const Vec3& o) {
  const Vec3 h = normalize(i + o);
  const float exponent = 1 / alpha;
  const float d = (2 + exponent) * std::pow(std::max(0.0f, 1 - h.z * h.z), 0.5f * exponent) * 0.5f * inv_pi;
  return d / (4 * (i.z + o.z - i.z * o.z));
}

constexpr std::size_t roughness_nodes = 24, cosine_nodes = 48;

using SheenTable = std::array<std::array<float, cosine_nodes>, roughness_nodes>;

// The nodes are evenly spaced roughnesses, the roots of alpha.
float alpha_of(std::size_t node) {
  const float low = std::sqrt(Cloth::least_alpha);
  return sqr(lerp(static_cast<float>(node) / (roughness_nodes - 1), low, 1.0f));
}

// Integrates over the hemisphere with n x n directions, evenly spaced in solid angle.
float integrate(float alpha, float cos) {
  constexpr int n = 64;
  const Vec3 i(safe_sqrt(1 - cos * cos), 0, std::max(cos, 1e-3f));
  double sum = 0;
  for (int x = 0; x < n; ++x)
    for (int y = 0; y < n; ++y) {
      const float z = (static_cast<float>(x) + 0.5f) / n, phi = pi * (static_cast<float>(y) + 0.5f) / n;
      const float r = safe_sqrt(1 - z * z);
      sum += static_cast<double>(fibres(alpha, i, {r * std::cos(phi), r * std::sin(phi), z}) * z);
    }
  return static_cast<float>(2.0 * static_cast<double>(pi) * sum / (n * n));
}

const SheenTable& table() {
  static const SheenTable only = [] {
    SheenTable t{};
    for (std::size_t w = 0; w < roughness_nodes; ++w)
      for (std::size_t c = 0; c < cosine_nodes; ++c)
        t[w][c] = integrate(alpha_of(w), static_cast<float>(c) / (cosine_nodes - 1));
    return t;
  }();
  return only;
}

// Albedo of D V alone, which may exceed 1.
float raw_albedo(float alpha, float cos) {
  const float low = std::sqrt(Cloth::least_alpha);
  const TableCell w = table_cell((std::sqrt(alpha) - low) / (1 - low), roughness_nodes),
                  c = table_cell(cos, cosine_nodes);
  const SheenTable& t = table();
  const auto across = [&](std::size_t row) { return lerp(c.fraction, t[row][c.low], t[row][c.low + 1]); };
  return lerp(w.fraction, across(w.low), across(w.low + 1));
}

// Factor of the base's light between two directions.
float rest(const Cloth& c, float cos_i, float cos_o) {
  return 1 - max_component(c.sheen) * std::max(sheen_albedo(c.alpha, cos_i), sheen_albedo(c.alpha, cos_o));
}

// Probability of sampling the fibres rather than the base.
float fibre_probability(const Cloth& c, const Vec3& wi) {
  const float e = max_component(c.sheen) * sheen_albedo(c.alpha, abs_cos_theta(wi));
  const float below = (1 - e) * max_component(albedo(c.base, wi));
  return e + below > 0 ? e / (e + below) : 0;
}

}  // namespace

float sheen_albedo(float alpha, float cos) { return std::min(1.0f, raw_albedo(alpha, cos)); }

BsdfValue evaluate(const Cloth& c, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts) {
  if (!same_hemisphere(wi, wo)) return {};
  const BsdfValue base = evaluate(c.base, wi, wo, transport, parts);
  const auto density = [&](const Vec3& w, float below) {
    const float choose = fibre_probability(c, w);
    return choose * 0.5f * inv_pi + (1 - choose) * below;
  };
  BsdfValue value;
  if (parts.f) {
    const float side = std::copysign(1.0f, wi.z);
    const Vec3 i = side * wi, o = side * wo;
    const float excess = std::max({1.0f, raw_albedo(c.alpha, i.z), raw_albedo(c.alpha, o.z)});
    value.f = c.sheen * (fibres(c.alpha, i, o) / excess) + rest(c, i.z, o.z) * base.f;
  }
  if (parts.pdf) value.pdf = density(wi, base.pdf);
  if (parts.pdf_reverse) value.pdf_reverse = density(wo, base.pdf_reverse);
  return value;
}

std::optional<BsdfSample> sample(const Cloth& c, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport) {
  if (wi.z == 0) return std::nullopt;
  const float choose = fibre_probability(c, wi);
  Vec3 wo;
  if (u_lobe < choose) {
    const float r = safe_sqrt(1 - u.x * u.x), phi = 2 * pi * u.y;
    wo = {r * std::cos(phi), r * std::sin(phi), std::copysign(u.x, wi.z)};
  } else {
    const float again = std::min((u_lobe - choose) / (1 - choose), one_minus_epsilon);
    std::optional<BsdfSample> below = sample(c.base, wi, again, u, transport);
    if (!below) return std::nullopt;
    if (below->delta) {
      below->weight *= rest(c, abs_cos_theta(wi), abs_cos_theta(wi)) / (1 - choose);
      below->pdf *= 1 - choose;
      return below;
    }
    wo = below->wo;
  }
  return sample_of_all(wo, abs_cos_theta(wo), evaluate(c, wi, wo, transport, {.f = true, .pdf = true}));
}

Spectrum albedo(const Cloth& c, const Vec3& wi) {
  const float e = sheen_albedo(c.alpha, abs_cos_theta(wi));
  return e * c.sheen + (1 - e * max_component(c.sheen)) * albedo(c.base, wi);
}

LobeWeights lobe_weights(const Cloth& c, const Vec3& wi) {
  const float choose = fibre_probability(c, wi);
  LobeWeights weights = lobe_weights(c.base, wi);
  weights.diffuse = choose + (1 - choose) * weights.diffuse;
  weights.glossy *= 1 - choose;
  weights.delta *= 1 - choose;
  return weights;
}

SplitTerms split_terms(const Cloth& c, const Vec3& wi) {
  SplitTerms terms = split_terms(c.base, wi);
  const float fibres = sheen_albedo(c.alpha, abs_cos_theta(wi)), base = 1 - fibres * max_component(c.sheen);
  terms.diffuse *= base;
  terms.f0 *= base;
  terms.f90 *= base;
  terms.sheen = c.sheen * fibres;
  return terms;
}

}  // namespace lanthorn
