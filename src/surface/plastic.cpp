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

/// Albedo of the microfacets for a Fresnel term of the form a f0 + b f90, tabulated by width and cosine.
struct Albedo {
  float a = 0, b = 0;
};

constexpr std::size_t widths = 17, cosines = 65;

/// Albedos on a grid, and their cosine-weighted means over the hemisphere.
struct AlbedoTable {
  std::array<std::array<Albedo, cosines>, widths> at{};
  std::array<Albedo, widths> mean{};
};

// Integrates over visible normals, with n x n evenly spaced samples.
Albedo microfacet_albedo(float alpha, float cos) {
  if (alpha == 0) return {1 - schlick(cos), schlick(cos)};
  const TrowbridgeReitz microfacets(alpha, alpha);
  const Vec3 i(safe_sqrt(1 - cos * cos), 0, std::max(cos, 1e-4f));
  constexpr int n = 24;
  double a = 0, b = 0;
  for (int x = 0; x < n; ++x)
    for (int y = 0; y < n; ++y) {
      const Vec2 u((static_cast<float>(x) + 0.5f) / n, (static_cast<float>(y) + 0.5f) / n);
      const Normal m = microfacets.sample(i, u);
      const float cos_m = dot(i, m);
      const Vec3 o = 2 * cos_m * m - i;
      if (cos_m <= 0 || o.z <= 0) continue;
      const float weight = microfacets.g_over_g1(i, o);
      a += weight * (1 - schlick(cos_m));
      b += weight * schlick(cos_m);
    }
  return {static_cast<float>(a / (n * n)), static_cast<float>(b / (n * n))};
}

AlbedoTable make_table() {
  AlbedoTable table;
  for (std::size_t w = 0; w < widths; ++w) {
    const float alpha = static_cast<float>(w) / (widths - 1);
    double a = 0, b = 0;
    for (std::size_t c = 0; c < cosines; ++c) {
      const float cos = static_cast<float>(c) / (cosines - 1);
      table.at[w][c] = microfacet_albedo(alpha, cos);
    }
    // 2 ∫ E cos dcos, exact for values linear between the nodes.
    for (std::size_t c = 0; c + 1 < cosines; ++c) {
      const double low = static_cast<double>(c) / (cosines - 1), step = 1.0 / (cosines - 1);
      const auto integrate = [&](double first, double second) {
        return step * (low * (first + second) + step * (first + 2 * second) / 3);
      };
      a += integrate(static_cast<double>(table.at[w][c].a), static_cast<double>(table.at[w][c + 1].a));
      b += integrate(static_cast<double>(table.at[w][c].b), static_cast<double>(table.at[w][c + 1].b));
    }
    table.mean[w] = {static_cast<float>(a), static_cast<float>(b)};
  }
  return table;
}

const AlbedoTable& table() {
  static const AlbedoTable only = make_table();
  return only;
}

Spectrum with_fresnel(const Plastic& p, const Albedo& low, const Albedo& high, float fraction) {
  return p.f0 * lerp(fraction, low.a, high.a) + Spectrum(p.f90 * lerp(fraction, low.b, high.b));
}

Spectrum mean_specular_albedo(const Plastic& p) {
  const TableCell w = table_cell(p.alpha, widths);
  return with_fresnel(p, table().mean[w.low], table().mean[w.low + 1], w.fraction);
}

Spectrum diffuse(const Plastic& p, float cos_i, float cos_o) {
  const Spectrum one(1);
  const Spectrum rest = map(one - mean_specular_albedo(p), [](float x) { return std::max(x, 1e-6f); });
  return p.reflectance * inv_pi * (one - specular_albedo(p, cos_i)) * (one - specular_albedo(p, cos_o)) / rest;
}

Spectrum fresnel(const Plastic& p, float cos) { return p.f0 + (Spectrum(p.f90) - p.f0) * schlick(cos); }

Spectrum specular(const Plastic& p, const Vec3& i, const Vec3& o) {
  const Normal m = normalize(i + o);
  const TrowbridgeReitz microfacets(p.alpha, p.alpha);
  return fresnel(p, dot(i, m)) * (0.25f * microfacets.d(m) * microfacets.g_over_cosines(i, o));
}

// Probability of sampling the reflection rather than the base.
float specular_probability(const Plastic& p, float cos_i) {
  const Spectrum e = specular_albedo(p, cos_i);
  const float reflected = max_component(e), below = max_component((Spectrum(1) - e) * p.reflectance);
  return reflected + below > 0 ? reflected / (reflected + below) : 0;
}

}  // namespace

Spectrum specular_albedo(const Plastic& p, float cos) {
  const TableCell w = table_cell(p.alpha, widths), c = table_cell(cos, cosines);
  const AlbedoTable& t = table();
  const auto across = [&](std::size_t row) {
    return with_fresnel(p, t.at[row][c.low], t.at[row][c.low + 1], c.fraction);
  };
  return across(w.low) * (1 - w.fraction) + across(w.low + 1) * w.fraction;
}

Spectrum eval(const Plastic& p, const Vec3& wi, const Vec3& wo, Transport /*symmetric*/) {
  if (!same_hemisphere(wi, wo)) return Spectrum();
  const float side = std::copysign(1.0f, wi.z);
  const Vec3 i = side * wi, o = side * wo;
  const Spectrum below = diffuse(p, i.z, o.z);
  return is_smooth(p) ? below : below + specular(p, i, o);
}

float pdf(const Plastic& p, const Vec3& wi, const Vec3& wo) {
  if (!same_hemisphere(wi, wo)) return 0;
  const float side = std::copysign(1.0f, wi.z);
  const Vec3 i = side * wi, o = side * wo;
  const float choose = specular_probability(p, i.z);
  const float below = (1 - choose) * pdf_cosine_hemisphere(o.z);
  if (is_smooth(p)) return below;
  const TrowbridgeReitz microfacets(p.alpha, p.alpha);
  return below + choose * 0.25f * microfacets.visible_d_over_dot(i, normalize(i + o));
}

std::optional<BsdfSample> sample(const Plastic& p, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport) {
  if (wi.z == 0) return std::nullopt;
  const float side = std::copysign(1.0f, wi.z);
  const Vec3 i = side * wi;
  const float choose = specular_probability(p, i.z);
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
  const float density = pdf(p, wi, side * o);
  if (!(density > 0)) return std::nullopt;
  return BsdfSample{.wo = side * o, .weight = eval(p, wi, side * o, transport) * (o.z / density), .pdf = density};
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

}  // namespace lanthorn
