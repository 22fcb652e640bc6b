// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/bsdf.h"

#include <gtest/gtest.h>

#include <array>
#include <complex>
#include <vector>

#include "math/hash.h"
#include "math/sampling.h"
#include "support/bsdf_sampler.h"
#include "support/jacobian.h"
#include "surface/fresnel.h"
#include "surface/microfacet.h"

namespace lanthorn::bsdf_test {
namespace {

using test::at_angles;
using test::bsdf_sampler;
using test::DirectionSampler;
using test::jacobian_test;

const Spectrum gold_eta(0.143f, 0.374f, 1.442f, 1.65f);
const Spectrum gold_k(3.98f, 2.39f, 1.60f, 1.88f);
const Spectrum colour(0.8f, 0.5f, 0.2f, 0.1f);
const ThinFilm oil(1.7f, 430, Wavelengths::spectral(0.4f));
const CoatPassage smooth_coat({}, 0.1f);
const CoatPassage rough_coat({.eta = 1.5f, .alpha_x = 0.3f, .alpha_y = 0.3f}, 0.1f);

struct Named {
  const char* name;
  Bsdf bsdf;
};

std::vector<Named> exact_closures() {
  return {{"diffuse", Diffuse{colour}},
          {"diffuse transmission", DiffuseTransmission{0.5f * colour, Spectrum(0.2f, 0.5f, 0.1f, 0.1f)}},
          {"rough gold", Conductor{gold_eta, gold_k, 0.3f, 0.3f}},
          {"anisotropic gold", Conductor{gold_eta, gold_k, 0.05f, 0.5f}},
          {"rough glass", Dielectric{.eta = 1.5f, .alpha_x = 0.3f, .alpha_y = 0.3f}},
          {"anisotropic glass", Dielectric{.eta = 1.3f, .alpha_x = 0.5f, .alpha_y = 0.1f}},
          {"rough bubble", Dielectric{.eta = 0.7f, .alpha_x = 0.2f, .alpha_y = 0.2f}},
          {"tinted rough glass", Dielectric{.eta = 1.5f, .alpha_x = 0.3f, .alpha_y = 0.3f, .tint = colour}},
          {"frosted pane", ThinDielectric{.eta = 1.5f, .alpha_x = 0.3f, .alpha_y = 0.15f, .tint = colour}},
          {"oily plastic", Plastic{.reflectance = colour, .alpha = 0.3f, .film = oil}},
          {"anodised metal", Plastic{.f0 = colour, .alpha = 0.2f, .film = oil}},
          {"oily rough glass", Dielectric{.eta = 1.5f, .alpha_x = 0.3f, .alpha_y = 0.2f, .tint = colour, .film = oil}},
          {"oily frosted pane", ThinDielectric{.alpha_x = 0.3f, .alpha_y = 0.15f, .tint = colour, .film = oil}},
          {"glazed", Plastic{.reflectance = colour, .alpha = 0.3f}},
          {"velvet", Cloth{{.reflectance = colour, .alpha = 0.4f}, Spectrum(0.2f, 0.6f, 0.9f, 0.3f), 0.3f}},
          {"rough clear coat", ClearCoated{&rough_coat, colour}},
          {"coloured glaze", Plastic{.reflectance = colour, .f0 = 0.5f * colour, .f90 = 0.7f, .alpha = 0.12f}}};
}

std::vector<Named> delta_closures() {
  return {{"mirror", Conductor{gold_eta, gold_k}},
          {"glass", Dielectric{}},
          {"bubble", Dielectric{.eta = 0.7f}},
          {"nothing", Dielectric{.eta = 1, .alpha_x = 0.3f, .alpha_y = 0.3f}},
          {"pane", ThinDielectric{}},
          {"tinted pane", ThinDielectric{.tint = colour}},
          {"tinted glass", Dielectric{.tint = colour}},
          {"oily glass", Dielectric{.film = oil}},
          {"oily pane", ThinDielectric{.film = oil}},
          {"soap bubble", Dielectric{.eta = 1, .film = oil}},
          {"oily mirror", Plastic{.f0 = colour, .film = oil}},
          {"lacquered mirror", CoatedConductor{.base = under_coat({gold_eta, gold_k, 0, 0}, 1.5f)}}};
}

std::vector<Named> layered_closures() {
  const Conductor rough_gold = under_coat({gold_eta, gold_k, 0.3f, 0.2f}, 1.5f);
  const Dielectric rough{.eta = 1.5f, .alpha_x = 0.25f, .alpha_y = 0.25f};
  return {{"plastic", CoatedDiffuse{.base = {colour}}},
          {"clear coat", ClearCoated{&smooth_coat, colour}},
          {"rough plastic", CoatedDiffuse{.coat = rough, .base = {colour}}},
          {"milky plastic", CoatedDiffuse{.base = {colour}, .thickness = 0.5f, .albedo = Spectrum(0.8f), .g = 0.4f}},
          {"rough milky plastic",
           CoatedDiffuse{.coat = rough, .base = {colour}, .thickness = 0.5f, .albedo = Spectrum(0.8f), .g = 0.4f}},
          {"lacquered gold", CoatedConductor{.base = rough_gold}},
          {"rough lacquered gold", CoatedConductor{.coat = rough, .base = rough_gold}},
          {"lacquered glaze", CoatedPlastic{.base = {.reflectance = colour, .alpha = 0.2f}}},
          {"lacquered tile", CoatedPlastic{.base = {.reflectance = colour, .f0 = Spectrum(0.3f)}}},
          {"rough lacquer on a mirror",
           CoatedConductor{.coat = rough, .base = under_coat({gold_eta, gold_k, 0, 0}, 1.5f)}}};
}

std::vector<Named> all_closures() {
  std::vector<Named> all = exact_closures();
  for (const auto& list : {delta_closures(), layered_closures()}) all.insert(all.end(), list.begin(), list.end());
  return all;
}

std::vector<Vec3> directions() {
  return {at_angles(1, 20), at_angles(40, 70), at_angles(80, -100), at_angles(120, 10), at_angles(165, 200)};
}

void expect_near(const Spectrum& a, const Spectrum& b, float relative, const std::string& what) {
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(a[i], b[i], relative * std::fmax(std::fabs(b[i]), 1e-3f)) << what;
}

TEST(Fresnel, DielectricHasItsKnownValues) {
  EXPECT_NEAR(fresnel_dielectric(1, 1.5f).reflectance, 0.04f, 1e-6f);
  EXPECT_NEAR(fresnel_dielectric(1, 1 / 1.5f).reflectance, 0.04f, 1e-6f);
  // At Brewster's angle only the perpendicular component is reflected: ((1 - eta^2) / (1 + eta^2))^2 / 2.
  const float brewster = std::cos(std::atan(1.5f));
  EXPECT_NEAR(fresnel_dielectric(brewster, 1.5f).reflectance, 0.5f * sqr((1 - 2.25f) / (1 + 2.25f)), 1e-6f);
  EXPECT_EQ(fresnel_dielectric(0.5f, 1 / 1.5f).reflectance, 1);  // 60 degrees lies beyond the critical angle, 41.8
  EXPECT_NEAR(fresnel_dielectric(0, 1.5f).reflectance, 1, 1e-6f);
}

TEST(Fresnel, ConductorMatchesComplexArithmetic) {
  for (const float cos : {1.0f, 0.9f, 0.5f, 0.1f, 0.001f}) {
    const Spectrum r = fresnel_conductor(cos, gold_eta, gold_k);
    for (int i = 0; i < 4; ++i) {
      const std::complex<double> n(gold_eta[i], gold_k[i]);
      const double c = cos;
      const auto root = std::sqrt(n * n - (1 - c * c));
      const double perpendicular = std::norm((c - root) / (c + root));
      const double parallel = std::norm((n * n * c - root) / (n * n * c + root));
      EXPECT_NEAR(r[i], 0.5 * (perpendicular + parallel), 2e-5) << cos;
    }
  }
  // The component that RGB mode does not use stays black and is never NaN.
  const Spectrum rgb = fresnel_conductor(1, Spectrum(0.2f, 0.4f, 1.4f, 0), Spectrum(4, 2.4f, 1.6f, 0));
  EXPECT_TRUE(is_finite(rgb));
  EXPECT_EQ(rgb[3], 0);
  EXPECT_NEAR(fresnel_conductor(0.3f, Spectrum(1.5f), Spectrum(0))[0], fresnel_dielectric(0.3f, 1.5f).reflectance,
              1e-6f);
}

TEST(Fresnel, ConductorOfGivenReflectance) {
  const Conductor c = conductor_from_reflectance(Spectrum(0.9f, 0.3f, 0, 1), 0, 0);
  expect_near(fresnel_conductor(1, c.eta, c.k), Spectrum(0.9f, 0.3f, 0, 0.9999f), 1e-4f, "normal incidence");
}

TEST(Microfacet, ProjectedAreaIsOne) {
  HashRng rng(1);
  for (const auto& [ax, ay] : {std::pair(0.5f, 0.5f), std::pair(0.2f, 0.6f)}) {
    const TrowbridgeReitz microfacets(ax, ay);
    const int n = 512;
    double facing = 0;
    double seen = 0;
    const Vec3 w = at_angles(60, 30);
    for (int i = 0; i < n * n; ++i) {  // stratified over cos(theta)^2, phi
      const Vec2 u = (Vec2(i % n, i / n) + rng.next2()) / static_cast<float>(n);
      const float r = std::sqrt(u.x);
      const Normal m(r * std::cos(2 * pi * u.y), r * std::sin(2 * pi * u.y), std::sqrt(1 - u.x));
      facing += static_cast<double>(microfacets.d(m) * pi);
      seen += static_cast<double>(microfacets.d(m) * microfacets.g1(w) * std::fmax(0.0f, dot(w, m)) / m.z * pi);
    }
    EXPECT_NEAR(facing / (n * n), 1, 2e-3);
    EXPECT_NEAR(seen / (n * n), w.z, 2e-3);
  }
}

TEST(Microfacet, ShadowingTermsAgree) {
  const TrowbridgeReitz microfacets(0.2f, 0.6f);
  const Vec3 i = at_angles(70, 10);
  const Vec3 o = at_angles(50, 130);
  EXPECT_NEAR(microfacets.g1(i), 1 / (1 + microfacets.lambda(i)), 1e-6f);
  EXPECT_NEAR(microfacets.g(i, o), 1 / (1 + microfacets.lambda(i) + microfacets.lambda(o)), 1e-6f);
  EXPECT_NEAR(microfacets.g_over_cosines(i, o), microfacets.g(i, o) / (i.z * o.z), 1e-5f);
  EXPECT_NEAR(microfacets.g_over_g1(i, o), microfacets.g(i, o) / microfacets.g1(i), 1e-6f);
}

TEST(Bsdf, SampleIsFTimesCosineOverPdf) {
  HashRng rng(2);
  for (const auto& [name, bsdf] : exact_closures()) {
    for (const Vec3& wi : directions()) {
      for (const Transport transport : {Transport::radiance, Transport::importance}) {
        for (int n = 0; n < 200; ++n) {
          const float u1 = rng.next();
          const auto s = sample(bsdf, wi, u1, rng.next2(), transport);
          if (!s || abs_cos_theta(s->wo) < 1e-3f) continue;
          EXPECT_TRUE(s->pdf_is_exact);
          EXPECT_FALSE(s->delta);
          EXPECT_EQ(s->transmission, !same_hemisphere(wi, s->wo));
          EXPECT_NEAR(length_squared(s->wo), 1, 1e-5f);
          EXPECT_NEAR(evaluate(bsdf, wi, s->wo, Transport::radiance).pdf, s->pdf, 5e-3f * s->pdf) << name;
          expect_near(evaluate(bsdf, wi, s->wo, transport).f * (abs_cos_theta(s->wo) / s->pdf), s->weight, 5e-3f, name);
        }
      }
    }
  }
}

TEST(Bsdf, IsAdjoint) {
  HashRng rng(3);
  auto closures = exact_closures();
  for (const auto& closure : layered_closures()) closures.push_back(closure);
  int positive = 0;
  for (const auto& [name, bsdf] : closures) {
    for (int n = 0; n < 300; ++n) {
      const Vec3 a = sample_uniform_sphere(rng.next2());
      const Vec3 b = sample_uniform_sphere(rng.next2());
      const Spectrum there = evaluate(bsdf, a, b, Transport::radiance).f;
      expect_near(there, evaluate(bsdf, b, a, Transport::importance).f, 2e-3f, name);
      if (same_hemisphere(a, b)) expect_near(there, evaluate(bsdf, b, a, Transport::radiance).f, 2e-3f, name);
      if (!there.is_black()) ++positive;
    }
  }
  EXPECT_GT(positive, 1500);
}

TEST(Bsdf, PartsTogetherAreThoseAskedForAlone) {
  HashRng rng(5);
  for (const auto& [name, bsdf] : all_closures())
    for (int n = 0; n < 100; ++n) {
      const Vec3 wi = sample_uniform_sphere(rng.next2()), wo = sample_uniform_sphere(rng.next2());
      for (const Transport transport : {Transport::radiance, Transport::importance}) {
        const BsdfValue all = evaluate(bsdf, wi, wo, transport);
        const BsdfValue two = evaluate(bsdf, wi, wo, transport, {.f = true, .pdf = true});
        expect_near(all.f, evaluate(bsdf, wi, wo, transport, {.f = true}).f, 1e-6f, name);
        expect_near(all.f, two.f, 1e-6f, name);
        EXPECT_NEAR(all.pdf, evaluate(bsdf, wi, wo, transport, {.pdf = true}).pdf, 1e-5f * all.pdf) << name;
        EXPECT_NEAR(all.pdf, two.pdf, 1e-5f * all.pdf) << name;
        const float reverse = evaluate(bsdf, wi, wo, transport, {.pdf_reverse = true}).pdf_reverse;
        EXPECT_NEAR(all.pdf_reverse, reverse, 1e-5f * reverse) << name;
        const float forward = evaluate(bsdf, wo, wi, transport, {.pdf = true}).pdf;
        EXPECT_NEAR(all.pdf_reverse, forward, 1e-5f * forward) << name;
      }
    }
}

// Sampling, both densities and f are consistent for eye and light paths, and nothing is scattered below the geometric
// plane.
TEST(Bent, IsOneFunctionOfEyeAndLight) {
  const Normal plane = at_angles(25, 40);
  HashRng rng(6);
  int bent_away = 0;
  for (const Bsdf& bsdf :
       {Bsdf(Bent<Conductor>{{gold_eta, gold_k, 0.3f, 0.2f}, plane}),
        Bsdf(Bent<Plastic>{{.reflectance = colour}, plane, plane}), Bsdf(Bent<Diffuse>{{colour}, plane, plane})})
    for (int n = 0; n < 3000; ++n) {
      const Vec3 wi = sample_uniform_sphere(rng.next2());
      const float u1 = rng.next();
      const Transport transport = n % 2 == 0 ? Transport::radiance : Transport::importance;
      const Transport other = n % 2 == 0 ? Transport::importance : Transport::radiance;
      const auto s = sample(bsdf, wi, u1, rng.next2(), transport);
      if (!s || s->delta || abs_cos_theta(s->wo) < 1e-3f || abs_cos_theta(wi) < 1e-3f) continue;
      const bool is_metal = std::holds_alternative<Bent<Conductor>>(bsdf);
      ASSERT_GT(dot(wi, plane) * dot(s->wo, plane), 0);
      bent_away += !same_hemisphere(wi, s->wo);
      EXPECT_NEAR(evaluate(bsdf, wi, s->wo, transport).pdf, s->pdf, 5e-3f * s->pdf);
      const Spectrum f = evaluate(bsdf, wi, s->wo, transport).f;
      expect_near(f * (abs_cos_theta(s->wo) / s->pdf), s->weight, 5e-3f, "weight");
      expect_near(evaluate(bsdf, s->wo, wi, other).f, f, 1e-4f, "adjoint");
      const float reverse = evaluate(bsdf, s->wo, wi, other).pdf;
      EXPECT_NEAR(evaluate(bsdf, wi, s->wo, transport).pdf_reverse, reverse, 1e-5f * reverse);
      const BsdfValue all = evaluate(bsdf, wi, s->wo, transport);
      if (f.is_black()) continue;  // behind the shading normal
      EXPECT_NEAR(all.pdf, s->pdf, 5e-3f * s->pdf);
      EXPECT_NEAR(all.pdf_reverse, reverse, 1e-5f * reverse);
      if (!is_metal) continue;
      const Vec3 under = s->wo - 2 * dot(s->wo, plane) * plane;
      EXPECT_TRUE(evaluate(bsdf, wi, under, transport).f.is_black());
      EXPECT_EQ(evaluate(bsdf, wi, under, transport).pdf, 0);
    }
  EXPECT_GT(bent_away, 100);
}

// Every closure is either transparent or has an opaque form whose light stays on one side of the facet.
TEST(Bent, NothingPassesAnOpaqueClosure) {
  const Normal plane = at_angles(35, 0);
  HashRng rng(7);
  for (const auto& [name, bsdf] : all_closures()) {
    EXPECT_EQ(is_bendable(bsdf), is_opaque(bsdf)) << name;
    if (!is_opaque(bsdf)) continue;
    PointBsdf facet(&bsdf);
    EXPECT_FALSE(bend(facet, {0, 0, 1}, {0, 0, 1})) << name;
    EXPECT_TRUE(bend(facet, plane, plane)) << name;
    for (int n = 0; n < 300; ++n) {
      const Vec3 wi = sample_uniform_sphere(rng.next2()), wo = sample_uniform_sphere(rng.next2());
      const float u = rng.next();
      for (const Transport transport : {Transport::radiance, Transport::importance}) {
        const auto s = sample(facet, wi, u, rng.next2(), transport);
        EXPECT_TRUE(!s || s->weight.is_black() || dot(wi, plane) * dot(s->wo, plane) >= 0) << name;
        if (dot(wi, plane) * dot(wo, plane) > 0) continue;
        EXPECT_TRUE(evaluate(facet, wi, wo, transport).f.is_black()) << name;
        EXPECT_EQ(evaluate(facet, wi, wo, transport).pdf, 0) << name;
      }
    }
  }
  PointBsdf sheet(DiffuseTransmission{colour});  // nothing is transmitted
  EXPECT_TRUE(is_bendable(sheet) && bend(sheet, plane, plane) && is_opaque(sheet));
}

// Between two points of one hair, the path runs along it.
TEST(Hair, IsFiniteAlongTheHair) {
  for (const Spectrum& sigma_a : {Spectrum(0), Spectrum(0.3f, 0.6f, 1, 0)}) {
    const Hair hair{.sigma_a = sigma_a, .h = 0.2f, .h_out = -0.7f};
    for (const Vec3& along : {Vec3(1, 0, 0), Vec3(-1, 0, 0)})
      for (const Transport transport : {Transport::radiance, Transport::importance})
        for (const auto& [wi, wo] : {std::pair{along, at_angles(40, 20)}, {at_angles(40, 20), along}, {along, along}}) {
          const BsdfValue values = evaluate(hair, wi, wo, transport);
          EXPECT_TRUE(std::isfinite(sum_of(values.f)) && std::isfinite(values.pdf + values.pdf_reverse));
        }
  }
}

TEST(Bsdf, RefractionScalesRadianceByTheSquaredIndexRatio) {
  const Dielectric glass{.eta = 1.5f, .alpha_x = 0.3f, .alpha_y = 0.3f};
  const Vec3 above = at_angles(30, 0);
  const Vec3 below = at_angles(155, 180);
  const float f = evaluate(glass, above, below, Transport::importance).f[0];
  ASSERT_GT(f, 0);
  EXPECT_NEAR(evaluate(glass, above, below, Transport::radiance).f[0] * 2.25f, f, 1e-4f * f);
  const float back = evaluate(glass, below, above, Transport::importance).f[0];
  EXPECT_NEAR(evaluate(glass, below, above, Transport::radiance).f[0] / 2.25f, back, 1e-4f * back);
}

TEST(Bsdf, DeltaLobesAreInvisibleToEvaluate) {
  HashRng rng(4);
  for (const auto& [name, bsdf] : delta_closures()) {
    EXPECT_FALSE(has_non_delta(bsdf)) << name;
    for (const Vec3& wi : directions()) {
      for (int n = 0; n < 20; ++n) {
        const float u1 = rng.next();
        const auto s = sample(bsdf, wi, u1, rng.next2(), Transport::radiance);
        if (!s) continue;
        EXPECT_TRUE(s->delta) << name;
        EXPECT_GT(s->pdf, 0) << name;
        EXPECT_EQ(evaluate(bsdf, wi, s->wo, Transport::radiance).pdf, 0) << name;
        EXPECT_TRUE(evaluate(bsdf, wi, s->wo, Transport::radiance).f.is_black()) << name;
        EXPECT_EQ(s->transmission, !same_hemisphere(wi, s->wo)) << name;
      }
    }
  }
}

TEST(Bsdf, LobeWeightsAddToOneAndAlbedoIsPhysical) {
  for (const auto& [name, bsdf] : all_closures()) {
    for (const Vec3& wi : directions()) {
      const LobeWeights w = lobe_weights(bsdf, wi);
      EXPECT_NEAR(w.diffuse + w.glossy + w.delta, 1, 1e-5f) << name;
      EXPECT_EQ(w.diffuse + w.glossy > 0, has_non_delta(bsdf)) << name;
      EXPECT_EQ(w.alpha > 0, w.glossy > 0) << name;
      EXPECT_LE(max_component(albedo(bsdf, wi)), 1.0001f) << name;
    }
  }
  const LobeWeights black = lobe_weights(Diffuse{}, at_angles(0, 0));
  EXPECT_EQ(black.diffuse + black.glossy + black.delta, 0);
  EXPECT_TRUE(is_dispersive(CoatedDiffuse{.coat = {.dispersive = true}}));
  EXPECT_FALSE(is_dispersive(Dielectric{}));
}

TEST(Bsdf, GrazingAndDegenerateDirectionsStayFinite) {
  HashRng rng(5);
  const std::array<Vec3, 4> grazing{Vec3(1, 0, 0), Vec3(1, 0, 1e-7f), at_angles(89.99, 30), at_angles(90.01, 30)};
  for (const auto& [name, bsdf] : all_closures()) {
    for (const Vec3& wi : grazing) {
      for (int n = 0; n < 50; ++n) {
        const float u1 = rng.next();
        const auto s = sample(bsdf, wi, u1, n == 0 ? Vec2(0) : rng.next2(), Transport::radiance);
        if (!s) continue;
        EXPECT_TRUE(is_finite(s->weight)) << name;
        EXPECT_TRUE(std::isfinite(s->pdf) && s->pdf > 0) << name << ' ' << s->pdf;
        EXPECT_TRUE(is_finite(evaluate(bsdf, wi, s->wo, Transport::radiance).f)) << name;
      }
    }
  }
}

TEST(Dielectric, RefractsBySnellsLaw) {
  for (const float eta : {1.5f, 0.7f}) {
    for (const Vec3& wi : directions()) {
      const auto s = sample(Dielectric{.eta = eta}, wi, one_minus_epsilon, {0.5f, 0.5f}, Transport::radiance);
      ASSERT_TRUE(s);
      if (!s->transmission) continue;  // total internal reflection
      const float ratio = wi.z > 0 ? eta : 1 / eta;
      EXPECT_EQ(s->eta, ratio);
      EXPECT_NEAR(s->wo.x * ratio, -wi.x, 1e-6f);
      EXPECT_NEAR(s->wo.y * ratio, -wi.y, 1e-6f);
      EXPECT_NEAR(s->weight[0], 1 / (ratio * ratio), 1e-6f);
      EXPECT_NEAR(s->pdf, 1 - fresnel_dielectric(abs_cos_theta(wi), ratio).reflectance, 1e-6f);
    }
  }
  const auto passed = sample(Dielectric{.eta = 1}, at_angles(50, 0), 0, {0.5f, 0.5f}, Transport::radiance);
  ASSERT_TRUE(passed && passed->transmission);
  EXPECT_EQ(passed->wo, -at_angles(50, 0));
}

TEST(ThinDielectric, SumsTheReflectionsBetweenItsFaces) {
  const float r = 0.04f;
  const float t = 1 - r;
  EXPECT_NEAR(thin_reflectance({1.5f}, 1)[0], r + t * t * r / (1 - r * r), 1e-6f);
  EXPECT_EQ(thin_reflectance({1.5f}, 0)[0], 1);
  const Vec3 i = at_angles(50, 20);
  const float reflected = thin_reflectance({1.5f}, i.z)[0];
  expect_near(albedo(ThinDielectric{.tint = colour}, i), Spectrum(reflected) + (1 - reflected) * colour, 1e-5f, "tint");
}

// For light from either side, in spectral and in RGB mode.
TEST(Dielectric, AFilmReflectsAndTheRestPasses) {
  for (const Wavelengths& w : {Wavelengths::spectral(0.2f), Wavelengths::rgb(0.5f)}) {
    const Dielectric glass{.eta = 1.5f, .tint = colour, .film = {1.8f, 500, w}};
    const auto passed = sample(glass, at_angles(50, 0), one_minus_epsilon, {0.5f, 0.5f}, Transport::importance);
    const Spectrum r = film_reflectance(glass.film, at_angles(50, 0).z, Spectrum(1.5f));
    ASSERT_TRUE(passed && passed->transmission);
    const auto back = sample(glass, passed->wo, one_minus_epsilon, {0.5f, 0.5f}, Transport::importance);
    ASSERT_TRUE(back && back->transmission);
    const auto reflected = sample(glass, passed->wo, 0, {0.5f, 0.5f}, Transport::importance);
    ASSERT_TRUE(reflected && !reflected->transmission);
    for (const auto& s : {*passed, *back})
      expect_near(s.weight * s.pdf, (Spectrum(1) - r) * colour, 1e-4f, "what passes");
    expect_near(reflected->weight * reflected->pdf, r, 1e-4f, "what does not");
  }
}

TEST(Coated, TwoSegmentsHaveAClosedForm) {
  const Vec3 i = at_angles(35, 10);
  const Vec3 o = at_angles(60, 150);
  const auto [ri, cos_i] = fresnel_dielectric(i.z, 1.5f);
  const auto [ro, cos_o] = fresnel_dielectric(o.z, 1.5f);
  const float through = (1 - ri) * (1 - ro) / 2.25f * std::exp(-0.1f / cos_i - 0.1f / cos_o);
  const CoatedDiffuse plastic{.base = {colour}, .thickness = 0.1f, .max_depth = 2};
  expect_near(evaluate(plastic, i, o, Transport::radiance).f, colour * (inv_pi * through), 1e-4f, "diffuse base");
  expect_near(evaluate(ClearCoated{&smooth_coat, colour, 1}, i, o, Transport::radiance).f, colour * (inv_pi * through),
              1e-4f, "diffuse base, without walks");
  EXPECT_TRUE(evaluate(ClearCoated{&smooth_coat, colour, 0}, i, o, Transport::radiance).f.is_black());
  const Conductor metal{gold_eta, gold_k, 0.4f, 0.2f};
  const Vec3 inside_i(i.x / 1.5f, i.y / 1.5f, cos_i);
  const Vec3 inside_o(o.x / 1.5f, o.y / 1.5f, cos_o);
  expect_near(
      evaluate(CoatedConductor{.base = metal, .thickness = 0.1f, .max_depth = 2}, -i, -o, Transport::radiance).f,
      evaluate(metal, inside_i, inside_o, Transport::radiance).f * through, 1e-4f, "metal base, from below");
}

// Lobe weights follow the albedo, not the probabilities with which lobes are sampled.
TEST(Coated, ClearCoatsHaveTheirLobesByAlbedo) {
  for (const CoatPassage* passage : {&smooth_coat, &rough_coat})
    for (const Vec3& wi : directions()) {
      const ClearCoated coated{passage, colour};
      const float reflected = fresnel_dielectric(std::fabs(wi.z), 1.5f).reflectance;
      const LobeWeights lobes = lobe_weights(coated, wi);
      EXPECT_NEAR(lobes.diffuse, 1 - reflected / max_component(albedo(coated, wi)), 1e-5f);
      EXPECT_NEAR(lobes.diffuse + lobes.glossy + lobes.delta, 1, 1e-6f);
    }
}

TEST(Coated, EvalIsAPureFunction) {
  for (const auto& [name, bsdf] : layered_closures()) {
    const Vec3 i = at_angles(35, 10);
    const Vec3 o = at_angles(60, 150);
    EXPECT_EQ(evaluate(bsdf, i, o, Transport::radiance).f, evaluate(bsdf, i, o, Transport::radiance).f) << name;
    EXPECT_EQ(evaluate(bsdf, i, o, Transport::radiance).f, evaluate(bsdf, -i, -o, Transport::importance).f) << name;
    const auto a = sample(bsdf, i, 0.7f, {0.2f, 0.6f}, Transport::radiance);
    const auto b = sample(bsdf, i, 0.7f, {0.2f, 0.6f}, Transport::importance);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    EXPECT_EQ(a->wo, b->wo) << name;
    EXPECT_EQ(a->weight, b->weight) << name;
  }
}

TEST(Jacobian, WarpsOfTheUnitSquare) {
  EXPECT_TRUE(
      jacobian_test(DirectionSampler{[](float, const Vec2& u) { return std::optional(sample_concentric_disk(u)); },
                                     [](const Vec2&) { return inv_pi; }}));
  EXPECT_TRUE(
      jacobian_test(DirectionSampler{[](float, const Vec2& u) { return std::optional(sample_uniform_triangle(u)); },
                                     [](const Vec2&) { return 2.0f; }}));
  EXPECT_TRUE(
      jacobian_test(DirectionSampler{[](float, const Vec2& u) { return std::optional(sample_uniform_sphere(u)); },
                                     [](const Vec3&) { return pdf_uniform_sphere; }}));
  EXPECT_TRUE(
      jacobian_test(DirectionSampler{[](float, const Vec2& u) { return std::optional(sample_cosine_hemisphere(u)); },
                                     [](const Vec3& w) { return pdf_cosine_hemisphere(w.z); }}));
  for (const float h : {1.0f, 0.1f, 1e-3f}) {
    EXPECT_TRUE(
        jacobian_test(DirectionSampler{[h](float, const Vec2& u) { return std::optional(sample_uniform_cone(u, h)); },
                                       [h](const Vec3&) { return pdf_uniform_cone(h); }}))
        << h;
  }
}

TEST(Jacobian, Closures) {
  for (const Vec3& wi : directions()) {
    EXPECT_TRUE(jacobian_test(bsdf_sampler(Diffuse{colour}, wi)));
    EXPECT_TRUE(jacobian_test(bsdf_sampler(Conductor{gold_eta, gold_k, 0.3f, 0.3f}, wi)));
    EXPECT_TRUE(jacobian_test(bsdf_sampler(Conductor{gold_eta, gold_k, 0.1f, 0.5f}, wi)));
    for (const float eta : {1.5f, 0.7f}) {
      const Dielectric d{.eta = eta, .alpha_x = 0.3f, .alpha_y = 0.2f};
      const auto direction = [](const std::optional<InterfaceSample>& s) -> std::optional<Vec3> {
        if (!s) return std::nullopt;
        return s->wo;
      };
      const DirectionSampler refraction{
          [&](float, const Vec2& u) { return direction(sample_transmission(d, wi, u, Transport::radiance)); },
          [&](const Vec3& wo) { return pdf_transmission(d, wi, wo); }};
      EXPECT_TRUE(jacobian_test(refraction, {.step = 1e-3f}));
    }
  }
}

}  // namespace
}  // namespace lanthorn::bsdf_test
