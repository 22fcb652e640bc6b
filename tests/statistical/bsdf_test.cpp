// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Closures: chi-squared tests of samples against densities, and z-tests of energy.
#include "surface/bsdf.h"

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "math/hash.h"
#include "math/sampling.h"
#include "support/bsdf_sampler.h"
#include "support/chi2.h"
#include "support/measured_conductor.h"
#include "support/statistics.h"
#include "surface/fresnel.h"
#include "surface/microfacet.h"

namespace lanthorn::bsdf_test {
namespace {

using test::at_angles;
using test::bsdf_sampler;
using test::chi2_test;
using test::DirectionSampler;
using test::Mean;

double limit_of(int checks) { return test::z_limit(test::sidak(test::false_alarm_rate, checks)); }

const Spectrum gold_eta(0.143f, 0.374f, 1.442f, 1.65f);
const Spectrum gold_k(3.98f, 2.39f, 1.60f, 1.88f);
const Spectrum colour(0.8f, 0.5f, 0.2f, 0.1f);
const ThinFilm oil(1.7f, 430, Wavelengths::spectral(0.4f));
const CoatPassage smooth_coat({}, 0.1f);
const CoatPassage rough_coat({.eta = 1.5f, .alpha_x = 0.3f, .alpha_y = 0.3f}, 0.1f);
/// Reflects everything: k is much larger than eta, and both are large.
const Spectrum white_eta(1e-3f);
const Spectrum white_k(1e3f);

struct Widths {
  float x, y;
};
const std::vector<Widths> widths{{0.01f, 0.01f}, {0.1f, 0.1f}, {0.5f, 0.5f}, {1, 1}, {0.05f, 0.6f}};
const std::vector<Vec3> directions{at_angles(0, 0),    at_angles(35, 70),  at_angles(75, -100),
                                   at_angles(87, 160), at_angles(150, 10), at_angles(100, -30)};

std::string describe(const Vec3& wi, const Widths& a) {
  return "wi.z " + std::to_string(wi.z) + " alpha " + std::to_string(a.x) + ' ' + std::to_string(a.y);
}

TEST(Chi2, Warps) {
  const test::Chi2Options options{.tests = 5};
  EXPECT_TRUE(chi2_test(DirectionSampler{[](float, const Vec2& u) { return std::optional(sample_uniform_sphere(u)); },
                                         [](const Vec3&) { return pdf_uniform_sphere; }},
                        options));
  EXPECT_TRUE(
      chi2_test(DirectionSampler{[](float, const Vec2& u) { return std::optional(sample_cosine_hemisphere(u)); },
                                 [](const Vec3& w) { return w.z > 0 ? pdf_cosine_hemisphere(w.z) : 0.0f; }},
                options));
  for (const float h : {1.0f, 0.1f, 1e-3f}) {
    const DirectionSampler cone{[h](float, const Vec2& u) { return std::optional(sample_uniform_cone(u, h)); },
                                [h](const Vec3& w) { return 1 - w.z < h ? pdf_uniform_cone(h) : 0.0f; }};
    EXPECT_TRUE(chi2_test(cone, options)) << h;
  }
}

TEST(Chi2, VisibleNormals) {
  const test::Chi2Options options{.tests = static_cast<int>(4 * widths.size())};
  for (const Widths& a : widths) {
    const TrowbridgeReitz microfacets(a.x, a.y);
    for (const Vec3& w : {directions[0], directions[1], directions[2], directions[3]}) {
      const DirectionSampler normals{[&](float, const Vec2& u) { return std::optional(microfacets.sample(w, u)); },
                                     [&](const Vec3& m) {
                                       const float cos = dot(w, m);
                                       return m.z > 0 && cos > 0 ? cos * microfacets.visible_d_over_dot(w, m) : 0.0f;
                                     }};
      EXPECT_TRUE(chi2_test(normals, options)) << describe(w, a);
    }
  }
}

TEST(Chi2, DiffuseClosures) {
  const test::Chi2Options options{.samples = 50000, .tests = static_cast<int>(2 * directions.size())};
  for (const Vec3& wi : directions) {
    EXPECT_TRUE(chi2_test(bsdf_sampler(Diffuse{colour}, wi), options));
    EXPECT_TRUE(chi2_test(bsdf_sampler(DiffuseTransmission{Spectrum(0.3f), Spectrum(0.6f)}, wi), options));
  }
}

TEST(Chi2, Conductor) {
  const test::Chi2Options options{.samples = 50000, .tests = static_cast<int>(directions.size() * widths.size())};
  for (const Vec3& wi : directions)
    for (const Widths& a : widths)
      EXPECT_TRUE(chi2_test(bsdf_sampler(Conductor{gold_eta, gold_k, a.x, a.y}, wi), options)) << describe(wi, a);
}

// Tests eye and light walks, at angles where the plane mirrors much of the lobe and where it does not.
TEST(Chi2, Bent) {
  const Normal plane = at_angles(25, 0);
  const std::vector<Bsdf> closures{Bent<Conductor>{{gold_eta, gold_k, 0.1f, 0.1f}, plane},
                                   Bent<Conductor>{{gold_eta, gold_k, 0.5f, 0.3f}, plane},
                                   Bent<Plastic>{{.reflectance = colour}, plane},
                                   Bent<Plastic>{{.reflectance = colour, .alpha = 0.3f}, plane, plane},
                                   Bent<Diffuse>{{colour}, plane, plane},
                                   Bent<Diffuse>{{colour}, plane, at_angles(10, 0)},
                                   Bent<Cloth>{{{.reflectance = colour, .alpha = 0.3f}, colour, 0.4f}, plane, plane}};
  const std::vector<Vec3> above{at_angles(0, 0), at_angles(60, 180), at_angles(80, 10), at_angles(84, 100),
                                at_angles(97, 0)};
  const test::Chi2Options options{.samples = 50000, .tests = static_cast<int>(2 * closures.size() * above.size())};
  for (const Bsdf& bsdf : closures)
    for (const Vec3& wi : above)
      for (const Transport transport : {Transport::radiance, Transport::importance}) {
        // Light from below the shading normal is reflected by metals alone.
        if (wi.z < 0 && transport == Transport::importance && !std::holds_alternative<Bent<Conductor>>(bsdf)) continue;
        EXPECT_TRUE(chi2_test(bsdf_sampler(bsdf, wi, transport), options)) << bsdf.index() << ' ' << wi.z;
      }
}

TEST(Chi2, Dielectric) {
  const test::Chi2Options options{.samples = 50000, .tests = static_cast<int>(2 * directions.size() * widths.size())};
  for (const Vec3& wi : directions)
    for (const Widths& a : widths)
      for (const float eta : {1.5f, 0.8f})
        EXPECT_TRUE(chi2_test(bsdf_sampler(Dielectric{eta, a.x, a.y}, wi), options))
            << describe(wi, a) << " eta " << eta;
}

TEST(Chi2, ThinDielectric) {
  const test::Chi2Options options{.samples = 50000, .tests = static_cast<int>(directions.size() * widths.size())};
  for (const Vec3& wi : directions)
    for (const Widths& a : widths)
      EXPECT_TRUE(chi2_test(bsdf_sampler(ThinDielectric{1.5f, a.x, a.y, colour}, wi), options)) << describe(wi, a);
}

TEST(Chi2, Cloth) {
  const test::Chi2Options options{.samples = 50000, .tests = static_cast<int>(3 * directions.size())};
  for (const Vec3& wi : directions)
    for (const float alpha : {0.02f, 0.2f, 1.0f})
      EXPECT_TRUE(
          chi2_test(bsdf_sampler(Cloth{{.reflectance = colour, .alpha = 0.3f}, 0.8f * colour, alpha}, wi), options))
          << wi.z << " alpha " << alpha;
}

TEST(Chi2, Plastic) {
  const test::Chi2Options options{.samples = 50000, .tests = static_cast<int>(4 * directions.size())};
  for (const Vec3& wi : directions)
    for (const float alpha : {0.0f, 0.02f, 0.3f, 1.0f})
      EXPECT_TRUE(chi2_test(bsdf_sampler(Plastic{.reflectance = colour, .alpha = alpha}, wi), options))
          << wi.z << " alpha " << alpha;
}

TEST(Chi2, ClearCoated) {
  const test::Chi2Options options{.samples = 50000, .tests = static_cast<int>(3 * directions.size())};
  for (const float alpha : {0.0f, 0.02f, 0.4f}) {
    const CoatPassage passage({.eta = 1.5f, .alpha_x = alpha, .alpha_y = alpha}, 0.2f);
    for (const Vec3& wi : directions)
      EXPECT_TRUE(chi2_test(bsdf_sampler(ClearCoated{&passage, colour}, wi), options)) << wi.z << " alpha " << alpha;
  }
}

TEST(Chi2, ThinFilms) {
  const test::Chi2Options options{.samples = 50000, .tests = static_cast<int>(3 * directions.size())};
  for (const Vec3& wi : directions) {
    EXPECT_TRUE(chi2_test(bsdf_sampler(Plastic{.reflectance = colour, .alpha = 0.3f, .film = oil}, wi), options));
    EXPECT_TRUE(chi2_test(bsdf_sampler(Dielectric{.alpha_x = 0.2f, .alpha_y = 0.3f, .film = oil}, wi), options));
    EXPECT_TRUE(chi2_test(bsdf_sampler(ThinDielectric{.alpha_x = 0.2f, .alpha_y = 0.2f, .film = oil}, wi), options));
  }
}

TEST(Chi2, Measured) {
  const std::vector<test::MetalIndex> gold{{0.143f, 3.98f}, {0.374f, 2.39f}, {1.442f, 1.60f}};
  const std::vector<test::MeasuredConductor> surfaces{
      {.alpha_x = 0.1f, .alpha_y = 0.1f, .indices = gold},
      {.alpha_x = 0.7f, .alpha_y = 0.7f, .indices = gold, .elevations = 5, .normals = 24, .warped = 10},
      {.alpha_x = 0.5f, .alpha_y = 0.15f, .indices = gold, .azimuths = 9},
      {.alpha_x = 0.5f, .alpha_y = 0.15f, .indices = gold, .azimuths = 4, .symmetry = 4}};
  const test::Chi2Options options{.samples = 50000, .tests = static_cast<int>(directions.size() * surfaces.size())};
  for (const test::MeasuredConductor& surface : surfaces) {
    const MeasuredData data = test::measure(surface);
    const MeasuredBrdf brdf(data);
    for (const Vec3& wi : directions)
      EXPECT_TRUE(chi2_test(bsdf_sampler(Measured{&brdf, Wavelengths::rgb(0.5f)}, wi), options))
          << describe(wi, {surface.alpha_x, surface.alpha_y});
  }
}

/// Fraction scattered from wi: the mean weight of samples, with or without delta lobes.
Mean sampled_albedo(const Bsdf& bsdf, const Vec3& wi, int n, bool with_delta,
                    Transport transport = Transport::importance) {
  HashRng rng(test::seed(7));
  Mean mean;
  for (int i = 0; i < n; ++i) {
    const float u1 = rng.next();
    const auto s = sample(bsdf, wi, u1, rng.next2(), transport);
    mean.add(s && (with_delta || !s->delta) ? static_cast<double>(s->weight[0]) : 0.0);
  }
  return mean;
}

/// Like `sampled_albedo`, but integrates eval over cosine-distributed directions; for lobes that are not very narrow.
Mean integrated_albedo(const Bsdf& bsdf, const Vec3& wi, int n) {
  HashRng rng(test::seed(8));
  Mean mean;
  for (int i = 0; i < n; ++i) {
    Vec3 wo = sample_cosine_hemisphere(rng.next2());
    if (wo.z == 0) continue;
    wo.z = std::copysign(wo.z, wi.z);
    mean.add(static_cast<double>(evaluate(bsdf, wi, wo, Transport::importance).f[0] * pi));
  }
  return mean;
}

struct Named {
  const char* name;
  Bsdf bsdf;
};
std::vector<Named> layered_closures() {
  const Conductor metal = under_coat({gold_eta, gold_k, 0.4f, 0.25f}, 1.5f);
  const Conductor mirror = under_coat({gold_eta, gold_k, 0, 0}, 1.5f);
  const Dielectric rough{.eta = 1.5f, .alpha_x = 0.3f, .alpha_y = 0.3f};
  const Dielectric rougher{.eta = 1.3f, .alpha_x = 0.3f, .alpha_y = 0.6f};
  const Spectrum milk(0.9f);
  return {
      {"plastic", CoatedDiffuse{.base = {colour}}},
      {"clear coat", ClearCoated{&smooth_coat, colour}},
      {"rough clear coat", ClearCoated{&rough_coat, colour}},
      {"odd depth", CoatedDiffuse{.coat = rough, .base = {colour}, .max_depth = 5}},
      {"rough plastic", CoatedDiffuse{.coat = rough, .base = {colour}, .n_samples = 3}},
      {"milky plastic", CoatedDiffuse{.base = {colour}, .thickness = 0.7f, .albedo = milk, .g = 0.6f}},
      {"rough milky plastic",
       CoatedDiffuse{.coat = rougher, .base = {colour}, .thickness = 1, .albedo = milk, .g = -0.3f}},
      {"lacquered gold", CoatedConductor{.base = metal}},
      {"rough lacquered gold", CoatedConductor{.coat = rough, .base = metal}},
      {"milky lacquer on a mirror", CoatedConductor{.base = mirror, .thickness = 0.5f, .albedo = milk}},
      {"rough milky lacquer on gold", CoatedConductor{.coat = rough, .base = metal, .thickness = 0.5f, .albedo = milk}},
      {"rough lacquer on a mirror", CoatedConductor{.coat = rough, .base = mirror}},
      {"lacquered glaze", CoatedPlastic{.base = {.reflectance = colour, .alpha = 0.3f}}},
      {"lacquered tile", CoatedPlastic{.base = {.reflectance = colour, .f0 = Spectrum(0.4f)}}},
      {"rough lacquer on a tile", CoatedPlastic{.coat = rough, .base = {.reflectance = colour, .f0 = Spectrum(0.4f)}}},
      {"milky lacquer on a tile",
       CoatedPlastic{.base = {.reflectance = colour, .f0 = Spectrum(0.4f)}, .thickness = 0.5f, .albedo = milk}}};
}

TEST(Coated, SamplesHaveTheMeanOfEval) {
  const auto closures = layered_closures();
  const std::vector<Vec3> incidence{at_angles(10, 30), at_angles(60, 100), at_angles(105, -40)};
  const double z = limit_of(static_cast<int>(closures.size() * incidence.size()));
  for (const auto& [name, bsdf] : closures) {
    for (const Vec3& wi : incidence) {
      const Mean by_sampling = sampled_albedo(bsdf, wi, 60000, false);
      const Mean by_eval = integrated_albedo(bsdf, wi, 60000);
      EXPECT_TRUE(test::agree(by_sampling, by_eval, z)) << name << ", wi.z " << wi.z;
      EXPECT_GT(by_sampling.mean(), 0.05) << name;
    }
  }
}

/// Diffuse reflectance of a smooth interface with this index ratio.
double diffuse_reflectance(float eta) {
  double sum = 0;
  const int n = 100000;
  for (int i = 0; i < n; ++i)
    sum += static_cast<double>(fresnel_dielectric(std::sqrt((static_cast<float>(i) + 0.5f) / n), eta).reflectance);
  return sum / n;
}

TEST(Coated, ClearPlasticHasAClosedForm) {
  const double inside = diffuse_reflectance(1 / 1.5f);
  const CoatPassage passage({}, 1e-30f);
  for (const Vec3& wi : {at_angles(0, 0), at_angles(70, 0)}) {
    const CoatedDiffuse plastic{.base = {colour}, .thickness = 0, .max_depth = 1000};
    const double r = static_cast<double>(fresnel_dielectric(wi.z, 1.5f).reflectance);
    const double base = static_cast<double>(colour[0]);
    const double expected = r + (1 - r) * base * (1 - inside) / (1 - base * inside);
    const Mean albedo = sampled_albedo(plastic, wi, 200000, true);
    EXPECT_TRUE(test::agrees(albedo, expected, limit_of(2)));
    EXPECT_LT(albedo.error(), 0.001);
    EXPECT_NEAR(static_cast<double>(lanthorn::albedo(plastic, wi)[0]), expected, 0.01);
    const ClearCoated clear{&passage, colour, 500};
    EXPECT_NEAR(static_cast<double>(lanthorn::albedo(clear, wi)[0]), expected, 0.0005);
    EXPECT_TRUE(test::agrees(sampled_albedo(clear, wi, 200000, true), expected, limit_of(2), 0.0005));
  }
}

/// Mean of f of a stochastic closure over directions so close to wo that its expectation hardly differs between
/// them.
Mean mean_of_walks(CoatedDiffuse closure, const Vec3& wi, const Vec3& wo) {
  closure.n_samples = 30000;
  Mean mean;
  for (int i = 0; i < 32; ++i) {
    const Vec3 near = normalize(wo + Vec3(1e-6f * static_cast<float>(i), 0, 0));
    mean.add(static_cast<double>(evaluate(closure, wi, near, Transport::importance).f[0]));
  }
  return mean;
}

TEST(Coated, WalksBelowAClearCoatHaveAClosedForm) {
  struct Case {
    Dielectric coat;
    float thickness;
    int max_depth;
  };
  const std::vector<Case> cases{{{}, 0.01f, 10},
                                {{}, 0.4f, 200},
                                {{.eta = 0.8f}, 0.1f, 10},
                                {{.eta = 1}, 0.1f, 10},
                                {{.eta = 1.5f, .alpha_x = 0.001f, .alpha_y = 0.001f}, 0.01f, 10},
                                {{.eta = 1.5f, .alpha_x = 0.1f, .alpha_y = 0.1f}, 0.2f, 10},
                                {{.eta = 1.5f, .alpha_x = 0.6f, .alpha_y = 0.6f}, 0.01f, 11},
                                {{.eta = 1.7f, .alpha_x = 0.3f, .alpha_y = 0.3f}, 0.3f, 4}};
  const std::vector<std::array<Vec3, 2>> pairs{{at_angles(0, 0), at_angles(10, 70)},
                                               {at_angles(60, 0), at_angles(80, 200)},
                                               {at_angles(88, 0), at_angles(30, 90)}};
  const double z = limit_of(static_cast<int>(cases.size() * pairs.size()));
  for (const auto& [coat, thickness, max_depth] : cases) {
    const CoatPassage passage(coat, thickness);
    for (const auto& [wi, wo] : pairs) {
      const double expected = static_cast<double>(
          evaluate(ClearCoated{&passage, colour, max_depth / 2}, wi, wo, Transport::importance).f[0]);
      const CoatedDiffuse walking{.coat = coat, .base = {colour}, .thickness = thickness, .max_depth = max_depth};
      EXPECT_TRUE(test::agrees(mean_of_walks(walking, wi, wo), expected, z, 0.001))
          << coat.eta << ' ' << coat.alpha_x << ' ' << wi.z << ' ' << wo.z;
    }
  }
}

float largest_weight(const Bsdf& bsdf) {
  // Facets at grazing angles reflect more than the lobe's albedo, which is plastic's selection probability.
  constexpr float facets = 1.15f;
  if (std::holds_alternative<CoatedPlastic>(bsdf)) return 2;
  // Of two albedos a + b <= 1, chosen in proportion to their square roots, one gets the weight a + sqrt(ab) <= 1.207.
  // (The base alone, sampled by the cosine: 1.06 times that.)
  if (std::holds_alternative<ClearCoated>(bsdf)) return 1.207f * facets;
  return 1.001f;
}

TEST(Coated, WeightsAreBounded) {
  HashRng rng(test::seed(9));
  for (const auto& [name, bsdf] : layered_closures()) {
    for (int i = 0; i < 50000; ++i) {
      const Vec3 wi = sample_uniform_sphere(rng.next2());
      const float u1 = rng.next();
      const auto s = sample(bsdf, wi, u1, rng.next2(), Transport::radiance);
      ASSERT_LE(s ? max_component(s->weight) : 0.0f, largest_weight(bsdf)) << name;
    }
  }
}

/// The `pdf` of coats is only an approximation, but multiple importance sampling works better if it is close. It must
/// be normalised, and must not be far too small where samples fall.
TEST(Coated, PdfIsAUsefulDensity) {
  for (const auto& [name, bsdf] : layered_closures()) {
    for (const Vec3& wi : {at_angles(10, 30), at_angles(60, 100)}) {
      HashRng rng(test::seed(10));
      double integral = 0;
      const int n = 20000;
      for (int i = 0; i < n; ++i) {
        const Vec3 wo = sample_cosine_hemisphere(rng.next2());
        if (wo.z > 0)
          integral += static_cast<double>(evaluate(bsdf, wi, wo, Transport::radiance, {.pdf = true}).pdf /
                                          pdf_cosine_hemisphere(wo.z)) /
                      n;
      }
      EXPECT_LT(integral, 1.03) << name;
      EXPECT_GT(integral, 0.4) << name;
    }
  }
}

// Over a white base, only the loss of Smith's single scattering is missing, to within the table's error.
TEST(Energy, WhitePlasticScattersEverything) {
  for (const float alpha : {0.0f, 0.04f, 0.25f, 0.6f, 1.0f})
    for (const Vec3& wi : {at_angles(5, 0), at_angles(50, 10), at_angles(82, 20), at_angles(130, -30)})
      for (const float f0 : {0.04f, 0.5f}) {
        const Plastic plastic{.reflectance = Spectrum(1), .f0 = Spectrum(f0), .alpha = alpha};
        const Mean albedo = sampled_albedo(plastic, wi, 40000, true);
        EXPECT_TRUE(test::agrees(albedo, 1, limit_of(40), 0.01)) << wi.z << " alpha " << alpha << " f0 " << f0;
      }
}

TEST(Energy, WhitePlasticUnderAFilmScattersEverything) {
  const Wavelengths w = Wavelengths::spectral(0.2f);
  for (const float alpha : {0.0f, 0.25f, 0.6f, 1.0f})
    for (const Vec3& wi : {at_angles(5, 0), at_angles(50, 10), at_angles(82, 20), at_angles(130, -30)})
      for (const float thickness : {150.0f, 700.0f}) {
        const Plastic plastic{.reflectance = Spectrum(1), .alpha = alpha, .film = {1.8f, thickness, w}};
        const Mean albedo = sampled_albedo(plastic, wi, 40000, true);
        EXPECT_TRUE(test::agrees(albedo, 1, limit_of(32), 0.01)) << wi.z << " alpha " << alpha << ' ' << thickness;
      }
}

TEST(Energy, PlasticHasTheAlbedoItSays) {
  for (const float alpha : {0.0f, 0.15f, 0.5f, 0.95f})
    for (const Vec3& wi : {at_angles(5, 0), at_angles(60, 10), at_angles(80, 20)}) {
      const Plastic plastic{.reflectance = colour, .f0 = Spectrum(0.08f), .f90 = 0.9f, .alpha = alpha};
      const Mean mean = sampled_albedo(plastic, wi, 40000, true);
      const auto expected = static_cast<double>(albedo(plastic, wi)[0]);
      EXPECT_TRUE(test::within(mean.mean(), expected, 0.01 + limit_of(12) * mean.error()))
          << wi.z << " alpha " << alpha;
    }
}

// The plane removes nothing from the closure's reflection, wherever the eye is in front of both normals.
TEST(Energy, BentMetalsReflectAllThatTheyReflect) {
  for (const float alpha : {0.0f, 0.05f, 0.3f, 0.8f})
    for (const double tilt : {5.0, 30.0})
      for (const Vec3& wi : {at_angles(10, 0), at_angles(50, 180), at_angles(59, 180), at_angles(75, 100)}) {
        const Conductor metal{white_eta, white_k, alpha, alpha};
        const Mean bent =
            sampled_albedo(Bent<Conductor>{metal, at_angles(tilt, 0)}, wi, 40000, true, Transport::radiance);
        const Mean alone = sampled_albedo(metal, wi, 40000, true);
        EXPECT_TRUE(test::within(bent.mean(), alone.mean(), limit_of(32) * std::hypot(bent.error(), alone.error())))
            << bent.mean() << " instead of " << alone.mean() << ": " << wi.z << " alpha " << alpha << " tilt " << tilt;
      }
}

// Nor does it remove anything from a diffuse surface, even if the eye is behind the shading normal.
TEST(Energy, BentDiffuseSurfacesReflectAllThatTheyReflect) {
  for (const double tilt : {5.0, 30.0, 60.0})
    for (const double horizon : {0.0, tilt / 2, tilt})
      for (const Vec3& wi : {at_angles(10, 0), at_angles(29, 180), at_angles(75, 100), at_angles(92, 0)}) {
        PointBsdf white(Diffuse{Spectrum(1)});
        ASSERT_TRUE(bend(white, at_angles(tilt, 0), at_angles(horizon, 0)));
        const Mean seen = sampled_albedo(white, wi, 40000, true, Transport::radiance);
        EXPECT_TRUE(test::within(seen.mean(), 1, limit_of(36) * seen.error() + 1e-4))
            << seen.mean() << " tilt " << tilt;
        EXPECT_NEAR(albedo(white, wi)[0], 1, 1e-5) << tilt;
      }
}

// White fibres over a white base: the base receives the light that the fibres do not reflect, or less if wo is at a
// grazing angle.
TEST(Energy, ClothGainsNothing) {
  for (const float alpha : {0.02f, 0.1f, 0.4f, 1.0f})
    for (const Vec3& wi : {at_angles(5, 0), at_angles(60, 10), at_angles(85, 20), at_angles(130, -30)}) {
      const Cloth cloth{{.reflectance = Spectrum(1), .alpha = 0.3f}, Spectrum(1), alpha};
      const Mean mean = sampled_albedo(cloth, wi, 40000, true);
      const double noise = limit_of(48) * mean.error();
      EXPECT_LE(mean.mean(), 1.01 + noise) << wi.z << " alpha " << alpha;
      EXPECT_GT(mean.mean(), 0.6 - noise) << wi.z << " alpha " << alpha;
      // Only the fibres.
      const Cloth alone{{.reflectance = Spectrum(0), .f0 = Spectrum(0), .f90 = 0}, Spectrum(1), alpha};
      const Mean fibres = sampled_albedo(alone, wi, 40000, true);
      const auto expected = static_cast<double>(sheen_albedo(alpha, abs_cos_theta(wi)));
      EXPECT_LE(fibres.mean(), expected + 0.01 + limit_of(48) * fibres.error()) << wi.z << " alpha " << alpha;
      if (abs_cos_theta(wi) > 0.4f) {
        EXPECT_GT(fibres.mean(), expected - 0.01 - limit_of(48) * fibres.error()) << wi.z << " alpha " << alpha;
      }
    }
}

TEST(Energy, SmoothGlassScattersEverything) {
  for (const Vec3& wi : directions) {
    EXPECT_EQ(sampled_albedo(Dielectric{}, wi, 1000, true).mean(), 1);
    EXPECT_EQ(sampled_albedo(ThinDielectric{}, wi, 1000, true).mean(), 1);
  }
}

/// Single scattering loses what multiple bounces between microfacets would return, more for rougher surfaces, and gains
/// nothing. The bounds follow from the model: below 1, and near 1 for smooth surfaces.
TEST(Energy, RoughClosuresGainNothing) {
  for (const Widths& a : widths) {
    for (const Vec3& wi : directions) {
      for (const Bsdf& bsdf : {Bsdf(Conductor{white_eta, white_k, a.x, a.y}), Bsdf(Dielectric{1.5f, a.x, a.y}),
                               Bsdf(ThinDielectric{1.5f, a.x, a.y})}) {
        const Mean albedo = sampled_albedo(bsdf, wi, 20000, true);
        const double noise = limit_of(180) * albedo.error();
        EXPECT_LE(albedo.mean(), 1 + noise) << describe(wi, a);
        EXPECT_GT(albedo.mean(), (a.y < 0.2f && abs_cos_theta(wi) > 0.5f ? 0.97 : 0.3) - noise) << describe(wi, a);
      }
    }
  }
}

/// In a white furnace, radiance is in equilibrium, index^2 on each side, and glass emits the same.
TEST(Energy, GlassKeepsTheRadianceOfAFurnace) {
  for (const float alpha : {0.0f, 0.05f}) {
    for (const float theta : {10.0f, 130.0f}) {
      const Dielectric glass{1.5f, alpha, alpha};
      const Vec3 wi = at_angles(static_cast<double>(theta), 0);
      HashRng rng(test::seed(11));
      Mean radiance;
      for (int i = 0; i < 20000; ++i) {
        const float u1 = rng.next();
        const auto s = sample(glass, wi, u1, rng.next2(), Transport::radiance);
        const float index = s && s->wo.z < 0 ? 1.5f : 1.0f;
        radiance.add(s ? static_cast<double>(s->weight[0] * index * index) : 0.0);
      }
      // Rough glass loses 0.7 % in single scattering. Standard error: 0.001.
      const double noise = limit_of(2) * radiance.error();
      EXPECT_NEAR(radiance.mean(), wi.z > 0 ? 1 : 2.25, alpha == 0 ? 1e-5 : 0.02 + noise) << alpha << ' ' << theta;
    }
  }
}

const std::vector<Hair> hairs{{Spectrum(0.2f, 0.5f, 1, 0), 0.3f, 1.55f, 0.3f, 0.3f, 2},
                              {Spectrum(0.05f), -0.8f, 1.55f, 0.6f, 0.8f, 3},
                              {Spectrum(2), 0, 1.3f, 0.9f, 0.5f, 0}};
const std::vector<Vec3> around{at_angles(10, 20), at_angles(60, 90), at_angles(80, -160), at_angles(120, 45)};

TEST(Chi2, Hair) {
  for (const Hair& hair : hairs)
    for (const Vec3& wi : around)
      EXPECT_TRUE(chi2_test(bsdf_sampler(hair, wi), {.tests = 12})) << describe(wi, {hair.beta_m, hair.beta_n});
}

// Without absorption nothing is lost: the integral of f times the cosine over all directions is 1, for any incidence
// and roughness, except for the lobes' cut at grazing angles; the weights of samples agree with this.
TEST(Hair, WhiteFurnace) {
  HashRng rng(test::seed(11));
  for (const float h : {-0.9f, 0.0f, 0.6f})
    for (const float beta : {0.25f, 0.6f, 1.0f}) {
      const Hair hair{Spectrum(), h, 1.55f, beta, beta, 2};
      const Vec3 wi = at_angles(70, 30);
      constexpr int side = 200;  // midpoints that resolve the lobes: no noise
      double integral = 0;
      Mean sampled;
      for (int i = 0; i < side * side; ++i) {
        const Vec3 wo = sample_uniform_sphere((Vec2(i % side, i / side) + 0.5f) / static_cast<float>(side));
        integral +=
            static_cast<double>(evaluate(hair, wi, wo, Transport::radiance).f[0] * cosine_across_fibre(wo) * 4 * pi) /
            (side * side);
        const float u_lobe = rng.next();
        const auto s = sample(hair, wi, u_lobe, rng.next2(), Transport::radiance);
        sampled.add(s ? static_cast<double>(s->weight[0]) : 0.0);
      }
      EXPECT_NEAR(integral, 1, 0.01) << h << ' ' << beta;
      EXPECT_TRUE(test::agrees(sampled, 1, limit_of(9), 0.01)) << h << ' ' << beta;
      EXPECT_NEAR(albedo(hair, wi)[0], 1, 1e-4f);
    }
}

// A light path scatters as the eye path along the same path in reverse. Each ray keeps its offset across the width.
TEST(Hair, LightPathsScatterWhatIsSeen) {
  HashRng rng(test::seed(12));
  for (const bool is_on_surface : {false, true})
    for (Hair of_eye : hairs) {
      of_eye.h_out = 0.35f;
      of_eye.is_on_surface = is_on_surface;
      Hair of_light = of_eye;
      std::swap(of_light.h, of_light.h_out);
      for (const Vec3& wi : around)
        for (int i = 0; i < 200; ++i) {
          const float u_lobe = rng.next();
          const auto s = sample(of_light, wi, u_lobe, rng.next2(), Transport::importance);
          if (!s) continue;
          const Spectrum seen =
              evaluate(of_eye, s->wo, wi, Transport::radiance).f * (cosine_across_fibre(s->wo) / s->pdf);
          EXPECT_NEAR(s->weight[0], seen[0], 2e-3f * seen[0]);
          EXPECT_EQ(s->pdf, evaluate(of_light, wi, s->wo, Transport::importance, {.pdf = true}).pdf);
          EXPECT_EQ(evaluate(of_eye, s->wo, wi, Transport::radiance, {.pdf_reverse = true}).pdf_reverse, s->pdf);
          EXPECT_EQ(evaluate(of_light, wi, s->wo, Transport::importance, {.pdf_reverse = true}).pdf_reverse,
                    evaluate(of_eye, s->wo, wi, Transport::radiance, {.pdf = true}).pdf);
        }
    }
}

// Offsets on a surface have the opposite sign from below.
TEST(Hair, IsMirroredBelowASurface) {
  Hair above = hairs[0];
  above.is_on_surface = true;
  Hair turned = hairs[0];
  const Vec3 eye = at_angles(130, 40), light = at_angles(60, 90);
  turned.h = -turned.h;
  EXPECT_EQ(evaluate(above, eye, light, Transport::radiance).f[0],
            evaluate(turned, eye, light, Transport::radiance).f[0]);
  EXPECT_EQ(evaluate(above, light, eye, Transport::radiance).f[0],
            evaluate(hairs[0], light, eye, Transport::radiance).f[0]);
}

// The density of the reverse direction is nearly equal to the density of the forward one: on the way back, each lobe
// turns by the same angle in the opposite direction.
TEST(Hair, WayBackIsInTheSameLobes) {
  const Hair hair{Spectrum(0.1f), 0.6f, 1.55f, 0.3f, 0.1f, 0};
  HashRng rng(test::seed(13));
  int like = 0, count = 0;
  for (int i = 0; i < 1000; ++i) {
    const float u_lobe = rng.next();
    const auto s = sample(hair, at_angles(60, 40), u_lobe, rng.next2(), Transport::radiance);
    if (!s) continue;
    const float ratio =
        evaluate(hair, at_angles(60, 40), s->wo, Transport::radiance, {.pdf_reverse = true}).pdf_reverse / s->pdf;
    ++count;
    like += ratio > 0.2f && ratio < 5 ? 1 : 0;
  }
  EXPECT_GT(like, 0.6 * count) << count;
}

TEST(Hair, IsReciprocalWithoutTilt) {
  const Hair hair{Spectrum(0.3f), 0.4f, 1.55f, 0.4f, 0.4f, 0};
  const Vec3 a = at_angles(50, 0), b = at_angles(50, 180);  // equal inclinations of opposite sign, one plane
  EXPECT_NEAR(evaluate(hair, a, b, Transport::radiance).f[0], evaluate(hair, b, a, Transport::radiance).f[0], 1e-3f);
}

}  // namespace
}  // namespace lanthorn::bsdf_test
