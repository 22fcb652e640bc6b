// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Chi-squared tests of guided directions, and comparisons of their light with the light of the closures alone.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "math/hash.h"
#include "path/direction_guide.h"
#include "path/walk.h"
#include "support/bsdf_sampler.h"
#include "support/chi2.h"
#include "support/jacobian.h"
#include "support/statistics.h"

namespace lanthorn::test {
namespace {

const Normal oblique = normalize(Vec3(0.3f, -0.7f, 0.5f));

/// Photons from a small part of the hemisphere, and a few from everywhere.
std::vector<DirectionGuide::Seen> uneven_light(const Frame& frame) {
  std::vector<DirectionGuide::Seen> light;
  HashRng rng(3);  // part of what is tested
  for (int i = 0; i < 100; ++i) light.push_back({frame.to_world(sample_cosine_hemisphere(rng.next2())), 0.3f});
  for (int i = 0; i < 100; ++i)
    light.push_back({frame.to_world(normalize(at_angles(55, 70) + 0.1f * sample_uniform_sphere(rng.next2()))), 1});
  return light;
}

/// A vertex on a surface with this closure, seen from wi (local).
struct TestVertex {
  TestVertex(const Bsdf& bsdf, const Vec3& wi_local) {
    at.shading = Frame(oblique);
    at.normal = oblique;
    at.bsdf = bsdf;
    vertex.wi_local = wi_local;
    vertex.wi = at.shading.to_world(wi_local);
  }
  WalkState state;
  SurfacePoint at;
  SurfaceVertex vertex{state, at, {}, {}, true};
};

const Plastic glossy{.reflectance = Spectrum(0.5f, 0.3f, 0.2f, 0), .alpha = 0.3f};

TEST(DirectionGuide, SamplesFollowTheDensity) {
  const DirectionGuide guide(oblique, uneven_light(Frame(oblique)));
  const DirectionSampler sampler{[&](float, const Vec2& u) { return guide.sample(u); },
                                 [&](const Vec3& w) { return guide.pdf(w); }};
  EXPECT_TRUE(chi2_test(sampler));
  EXPECT_TRUE(jacobian_test(sampler, {.share = 0.85}));  // cell boundaries are seams, too
}

TEST(DirectionGuide, WithoutLightHasNoSamples) {
  const std::vector<DirectionGuide::Seen> from_below{{-oblique, 1}};
  const DirectionGuide guide(oblique, from_below);
  EXPECT_FALSE(guide.sample({0.3f, 0.6f}));
  EXPECT_EQ(guide.pdf(oblique), 0);
}

// Directions as sampled by a walk, at a closure that has its own density.
TEST(GuidedWalk, DirectionsFollowTheMixture) {
  const TestVertex test(glossy, at_angles(40, 20));
  const SurfaceVertex& v = test.vertex;
  const DirectionGuide guide(oblique, uneven_light(v.at.shading));
  const GuidedContinuation guided{{}, {&guide, 0.4f}};
  const auto density = [&](const Vec3& wo) {
    const float own = evaluate(glossy, v.wi_local, wo, Transport::radiance, {.pdf = true}).pdf;
    return guided.guidance.pdf(own, v.at.shading.to_world(wo));
  };
  const DirectionSampler sampler{[&](float u1, const Vec2& u) -> std::optional<Vec3> {
                                   const auto s = walk_detail::draw<Transport::radiance>(v, guided, u1, u);
                                   return s ? std::optional(s->wo) : std::nullopt;
                                 },
                                 density};
  EXPECT_TRUE(chi2_test(sampler));
  HashRng rng(seed(5));
  for (int i = 0; i < 1000; ++i) {
    const float u1 = rng.next();
    const auto s = walk_detail::draw<Transport::radiance>(v, guided, u1, rng.next2());
    if (!s) continue;
    EXPECT_NEAR(s->pdf, sampler.pdf(s->wo), 1e-4f * s->pdf);
    const float f_cos = evaluate(glossy, v.wi_local, s->wo, Transport::radiance).f[0] * s->wo.z;
    EXPECT_NEAR(s->weight[0] * s->pdf, f_cos, 1e-4f * f_cos);
  }
}

// A mirror-like coat over a diffuse base, under a sky that is brighter on one side. A sample belongs to the delta lobe
// or to the base, whose weight is stochastic and whose density is approximate.
TEST(GuidedWalk, BringsTheLightOfTheClosureAlone) {
  const Bsdf lacquer = CoatedDiffuse{.base = {Spectrum(0.7f)}};
  const TestVertex test(lacquer, at_angles(30, -60));
  const DirectionGuide guide(oblique, uneven_light(test.at.shading));
  const auto light_of = [&](const GuidedContinuation& continuation, bool delta) {
    Mean mean;
    HashRng rng(seed(delta ? 11 : 12) + (continuation.guidance.guide ? 1'000 : 0));
    for (int i = 0; i < 200'000; ++i) {
      const float u1 = rng.next();
      const auto s = walk_detail::draw<Transport::radiance>(test.vertex, continuation, u1, rng.next2());
      mean.add(s && s->delta == delta ? static_cast<double>(s->weight[0] * (1.2f + s->wo.x)) : 0);
    }
    return mean;
  };
  for (const bool delta : {false, true}) {
    const Mean alone = light_of({}, delta), guided = light_of({{}, {&guide, 0.5f}}, delta);
    ASSERT_GT(alone.mean(), 0.01);
    EXPECT_TRUE(agree(guided, alone, z_limit(sidak(false_alarm_rate, 2)))) << delta;
    EXPECT_LT(std::hypot(guided.error(), alone.error()), 0.03 * alone.mean()) << delta;
  }
}

// Russian roulette uses the throughput of the closure's own samples: for a diffuse surface, its reflectance.
TEST(GuidedWalk, RouletteDoesNotSeeTheGuide) {
  const TestVertex test(Diffuse{Spectrum(0.7f)}, at_angles(30, -60));
  const DirectionGuide guide(oblique, uneven_light(test.at.shading));
  HashRng rng(seed(5));
  for (int i = 0; i < 1000; ++i) {
    const float u1 = rng.next();
    const auto s =
        walk_detail::draw<Transport::radiance>(test.vertex, GuidedContinuation{{}, {&guide, 0.5f}}, u1, rng.next2());
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->weight[0] * closure_ratio(*s), 0.7f, 1e-4f);
  }
}

}  // namespace
}  // namespace lanthorn::test
