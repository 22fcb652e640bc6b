// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Equation numbers refer to Chiang et al. 2016. The longitudinal function is from d'Eon et al. 2011, "An
// Energy-Conserving Hair Reflectance Model". Lobe p: light that has crossed the inside of the hair p times; the last
// lobe includes all higher ones.
#include "surface/hair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "surface/fresnel.h"

namespace lanthorn {

namespace {

constexpr std::size_t last_lobe = 3;

float power(float x, int n) {
  float result = 1;
  for (int i = 0; i < n; ++i) result *= x;
  return result;
}

// Modified Bessel function of the first kind and order 0, by its series; its logarithm uses the asymptotic expansion.
float bessel_i0(float x) {
  float sum = 1, term = 1;
  for (int k = 1; k <= 12; ++k) {
    term *= sqr(x / (2 * static_cast<float>(k)));
    sum += term;
  }
  return sum;
}
float log_bessel_i0(float x) { return x > 12 ? x - 0.5f * std::log(2 * pi * x) + 1 / (8 * x) : std::log(bessel_i0(x)); }

struct Inclination {
  float sin = 0, cos = 1;
};
Inclination inclination(const Vec3& w) { return {w.x, safe_sqrt(1 - sqr(w.x))}; }
float azimuth(const Vec3& w) { return std::atan2(w.z, w.y); }

// Longitudinal scattering of variance v (d'Eon et al. 2011, eq. 7), as a density of the sine of the inclination.
float longitudinal(const Inclination& o, const Inclination& i, float v) {
  const float a = i.cos * o.cos / v, b = i.sin * o.sin / v;
  if (v <= 0.1f) return std::exp(log_bessel_i0(a) - b - 1 / v + std::log(1 / v));
  return std::exp(-b) * bessel_i0(a) / (std::sinh(1 / v) * 2 * v);
}

float logistic_cdf(float x, float s) { return 1 / (1 + std::exp(-x / s)); }
// Logistic distribution of scale s, truncated to [-pi, pi].
float trimmed_logistic(float x, float s) {
  const float e = std::exp(-std::fabs(x) / s);
  return e / (s * sqr(1 + e)) / (logistic_cdf(pi, s) - logistic_cdf(-pi, s));
}
float sample_trimmed_logistic(float u, float s) {
  const float low = logistic_cdf(-pi, s), high = logistic_cdf(pi, s);
  const float x = -s * std::log(1 / (low + u * (high - low)) - 1);
  return std::clamp(x, -pi, pi);
}

// The lobes of the hair for one fixed direction.
struct Lobes {
  std::array<float, last_lobe + 1> variance{};  // longitudinal
  std::array<Inclination, last_lobe + 1> o{};   // inclination of the direction, tilted by the cuticle's scales
  std::array<float, last_lobe> turn{};          // azimuth by which a lobe turns the light
  std::array<Spectrum, last_lobe + 1> attenuation{};
  std::array<float, last_lobe + 1> probability{};
  float scale = 0;  // of the azimuthal distribution
  float phi = 0;    // azimuth of the direction

  Lobes(const Hair& hair, float offset, const Vec3& w);
  float azimuthal(std::size_t p, float phi_i) const {
    if (p == last_lobe) return 1 / (2 * pi);
    return trimmed_logistic(std::remainder(phi_i - phi - turn[p], 2 * pi), scale);
  }
};

Lobes::Lobes(const Hair& hair, float offset, const Vec3& w) : phi(azimuth(w)) {
  const float m = hair.beta_m, n = hair.beta_n;
  const float v = sqr(0.726f * m + 0.812f * m * m + 3.7f * power(m, 20));  // eq. 7
  variance = {v, 0.25f * v, 4 * v, 4 * v};
  for (float& each : variance) each = std::max(each, 1e-6f);
  scale = std::max(std::sqrt(pi / 8) * (0.265f * n + 1.194f * n * n + 5.372f * power(n, 22)), 1e-4f);  // eq. 8

  const Inclination straight = inclination(w);
  const auto tilted = [&](float degrees) {
    const float angle = degrees * pi / 180;
    const float s = std::sin(angle), c = std::cos(angle);
    return Inclination{straight.sin * c + straight.cos * s, std::fabs(straight.cos * c - straight.sin * s)};
  };
  o = {tilted(-2 * hair.alpha), tilted(hair.alpha), tilted(4 * hair.alpha), straight};

  const float h = std::clamp(offset, -0.9999f, 0.9999f);
  const float sin_t = straight.sin / hair.eta, cos_t = safe_sqrt(1 - sqr(sin_t));
  const float eta_across = std::sqrt(sqr(hair.eta) - sqr(straight.sin)) / std::max(straight.cos, 1e-4f);
  const float sin_gamma_t = std::clamp(h / eta_across, -1.0f, 1.0f);
  const float cos_gamma_t = safe_sqrt(1 - sqr(sin_gamma_t));
  const float gamma_o = std::asin(h), gamma_t = std::asin(sin_gamma_t);
  for (std::size_t p = 0; p < last_lobe; ++p)
    turn[p] = 2 * static_cast<float>(p) * gamma_t - 2 * gamma_o + static_cast<float>(p) * pi;

  const Spectrum inside = exp(-(2 * cos_gamma_t / std::max(cos_t, 1e-4f)) * hair.sigma_a);
  // Some light enters even along the hair; otherwise a clear one would divide 0 by 0.
  const float f = std::min(1 - 1e-6f, fresnel_dielectric(straight.cos * safe_sqrt(1 - h * h), hair.eta).reflectance);
  attenuation[0] = Spectrum(f);
  attenuation[1] = sqr(1 - f) * inside;
  for (std::size_t p = 2; p < last_lobe; ++p) attenuation[p] = attenuation[p - 1] * inside * f;
  attenuation[last_lobe] = attenuation[last_lobe - 1] * f * inside / (Spectrum(1) - inside * f);

  float total = 0;
  for (std::size_t p = 0; p <= last_lobe; ++p) total += sum_of(attenuation[p]);
  for (std::size_t p = 0; p <= last_lobe; ++p) probability[p] = sum_of(attenuation[p]) / total;
}

// f if the lobes are those of the eye's direction and `w` leads to the light, and the density with which w is sampled
// from the lobes.
BsdfValue evaluate(const Lobes& lobes, const Vec3& w) {
  const Inclination i = inclination(w);
  const float phi = azimuth(w);
  BsdfValue sum;
  for (std::size_t p = 0; p <= last_lobe; ++p) {
    const float shape = longitudinal(lobes.o[p], i, lobes.variance[p]) * lobes.azimuthal(p, phi);
    sum.f += shape * lobes.attenuation[p];
    sum.pdf += shape * lobes.probability[p];
  }
  sum.f = i.cos > 0 ? sum.f / i.cos : Spectrum();
  return sum;
}

// The offset `h` as the ray `w` sees it.
float seen_along(const Hair& hair, const Vec3& w, float h) { return hair.is_on_surface && w.z < 0 ? -h : h; }

// The offset for which the lobes around wi are sampled. On the way from a light to the eye, each lobe turns the other
// way.
float turning_offset(const Hair& hair, const Vec3& wi, Transport transport) {
  return transport == Transport::radiance ? seen_along(hair, wi, hair.h) : -hair.h_out;
}
// On a surface, the sign of a light walk's offset depends on the side to which it leaves, which is not known yet: it is
// drawn.
bool draws_sign(const Hair& hair, Transport transport) {
  return hair.is_on_surface && transport == Transport::importance;
}

// Density with which a walk from a light chooses wo.
float pdf_of_light_walk(const Hair& hair, const Vec3& wi, const Vec3& wo) {
  const float offset = turning_offset(hair, wi, Transport::importance);
  const float own = evaluate(Lobes(hair, offset, wi), wo).pdf;
  return draws_sign(hair, Transport::importance) ? 0.5f * (own + evaluate(Lobes(hair, -offset, wi), wo).pdf) : own;
}

// The hair as a walk meets it that follows the path the other way.
Hair reversed(Hair hair) {
  std::swap(hair.h, hair.h_out);
  return hair;
}

}  // namespace

float hair_absorption(float reflectance, float n) {
  const float log = std::log(std::clamp(reflectance, 1e-4f, 0.9999f));
  const float divisor =
      5.969f - 0.215f * n + 2.532f * n * n - 10.73f * power(n, 3) + 5.574f * power(n, 4) + 0.245f * power(n, 5);
  return sqr(log / divisor);
}

// The model describes light as the eye sees it: absorption depends on the eye's inclination, so reversing the path
// changes f. For light paths, f is evaluated with the roles of the directions exchanged.
BsdfValue evaluate(const Hair& hair, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts) {
  if (transport == Transport::importance)
    return reversed(evaluate(reversed(hair), wo, wi, Transport::radiance, reversed(parts)));
  BsdfValue value;
  if (parts.f || parts.pdf) value = evaluate(Lobes(hair, turning_offset(hair, wi, transport), wi), wo);
  if (parts.pdf_reverse) value.pdf_reverse = pdf_of_light_walk(reversed(hair), wo, wi);
  return value;
}

std::optional<BsdfSample> sample(const Hair& hair, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport) {
  float offset = turning_offset(hair, wi, transport);
  if (draws_sign(hair, transport)) {
    const bool is_turned = u_lobe >= 0.5f;
    if (is_turned) offset = -offset;
    u_lobe = 2 * u_lobe - (is_turned ? 1.0f : 0.0f);
  }
  const Lobes lobes(hair, offset, wi);
  std::size_t p = 0;
  while (p < last_lobe && u_lobe >= lobes.probability[p]) u_lobe -= lobes.probability[p++];
  const float u_azimuth = std::clamp(u_lobe / lobes.probability[p], 0.0f, one_minus_epsilon);

  // d'Eon et al. 2013, "Importance Sampling for Physically-Based Hair Fiber Models".
  const float v = lobes.variance[p];
  const float cos = 1 + v * std::log(std::max(u.x, 1e-5f) + (1 - u.x) * std::exp(-2 / v));
  const float sin = safe_sqrt(1 - cos * cos), around = std::cos(2 * pi * u.y);
  const float sin_i = std::clamp(-cos * lobes.o[p].sin + sin * around * lobes.o[p].cos, -1.0f, 1.0f);
  const float cos_i = safe_sqrt(1 - sin_i * sin_i);
  const float turn =
      p < last_lobe ? lobes.turn[p] + sample_trimmed_logistic(u_azimuth, lobes.scale) : 2 * pi * u_azimuth;
  const float phi = lobes.phi + turn;
  const Vec3 wo(sin_i, cos_i * std::cos(phi), cos_i * std::sin(phi));

  if (!(cos_i > 0)) return std::nullopt;
  // The lobes have the density, unless the sign was drawn, and f for a walk from the eye.
  const bool sign_is_known = !draws_sign(hair, transport);
  BsdfValue value = sign_is_known ? evaluate(lobes, wo) : BsdfValue();
  if (transport == Transport::importance) {
    const BsdfValue seen = evaluate(hair, wi, wo, transport, {.f = true, .pdf = !sign_is_known});
    value = {seen.f, sign_is_known ? value.pdf : seen.pdf};
  }
  std::optional<BsdfSample> s = sample_of_all(wo, cos_i, value);
  if (s) s->transmission = !same_hemisphere(wi, wo);
  return s;
}

Spectrum albedo(const Hair& hair, const Vec3& wi) {
  const Lobes lobes(hair, hair.h, wi);
  Spectrum sum;
  for (const Spectrum& a : lobes.attenuation) sum += a;
  return sum;
}

}  // namespace lanthorn
