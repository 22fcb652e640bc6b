// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Where photons start: projection maps and learned guides. agreement_test.cpp checks that means do not change.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lanthorn/metrics.h"
#include "path/light_pass.h"
#include "path/path_draw.h"
#include "photon/guides/emission_choice.h"
#include "photon/guides/learned_emission.h"
#include "photon/guides/projection_map.h"
#include "photon/guides/rare_light.h"
#include "photon/photon_pass.h"
#include "support/runs.h"
#include "support/scene_text.h"
#include "support/shapes.h"
#include "support/statistics.h"

namespace lanthorn::emission_test {
namespace {

// Mirrors and glass of all kinds of shapes, some of them instanced, and matte objects, far smaller than the lit region.
const std::string things =
    R"(Material "diffuse"
)" + test::patch("-2 0 -2  2 0 -2  -2 0 2  2 0 2") +
    R"(Material "conductor" "float roughness" [0]
AttributeBegin
Translate 0.7 0.5 0
Shape "sphere" "float radius" [0.2]
AttributeEnd
Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [-1 0.1 0  -0.6 0.5 0.1  -1 0.6 -0.2]
Material "dielectric"
ObjectBegin "disk"
Shape "disk" "float radius" [0.2]
ObjectEnd
AttributeBegin
Translate 0 0.3 0.8
Rotate 70 1 2 0
ObjectInstance "disk"
AttributeEnd
Material "diffuse"
)";
const std::string emitter = R"(AttributeBegin
AreaLightSource "diffuse"
)";

struct LitScene {
  std::string name, light;
  float largest_share;  ///< of the light's photons that may start towards mirrors and glass
};
const std::vector<LitScene> lit_scenes{
    {"triangle", emitter + R"(Shape "trianglemesh" "point3 P" [0 2 0  0.3 2 0  0 2.1 0.3]
AttributeEnd
)",
     0.3f},
    {"two-sided patch",
     R"(AttributeBegin
AreaLightSource "diffuse" "bool twosided" true
)" + test::patch("0 2 0  0.3 2 0  0 2.1 0.3  0.3 2.1 0.3") +
         "AttributeEnd\n",
     0.3f},
    {"sphere", emitter + R"(Translate 0 2 0
Shape "sphere" "float radius" [0.2]
AttributeEnd
)",
     0.15f},
    {"cylinder", emitter + R"(Translate 0 2 0
Shape "cylinder" "float radius" [0.1]
AttributeEnd
)",
     1},
    {"point", R"(LightSource "point" "point3 from" [0.1 2 0]
)",
     0.1f},
    {"spot", R"(LightSource "spot" "point3 from" [0.1 2 0] "point3 to" [0 0 0] "float coneangle" [60]
)",
     0.3f},
    {"distant", R"(LightSource "distant" "point3 from" [1 3 0]
)",
     0.1f},
    {"sky", R"(LightSource "infinite"
)",
     2},
};

// No part that a light's photons can hit is classified as empty, and the rest is small.
TEST(ProjectionMap, MissesNothing) {
  for (const LitScene& lit : lit_scenes) {
    const Scene scene = test::world(things + lit.light);
    for (const PhotonTarget target : {PhotonTarget::specular, PhotonTarget::surfaces}) {
      const EmissionGuide guide = make_projection_map(scene, target);
      ASSERT_EQ(guide.lights.size(), 1u);
      const TreeDistribution& numbers = guide.lights[0].numbers;
      HashRng rng(test::seed(7));
      std::size_t met = 0;
      constexpr std::size_t n = 40'000;
      for (std::size_t i = 0; i < n; ++i) {
        const Vec2 a = rng.next2(), b = rng.next2();
        const auto emission = sample_emission(scene.lights()[0], a, b, test::white);
        if (!emission) continue;
        const auto at = scene.intersect(spawn_from_light(*emission, 0), test::white);
        if (!at || (target == PhotonTarget::specular && has_non_delta(at->bsdf))) continue;
        ++met;
        ASSERT_GE(numbers.pdf({a.x, a.y, b.x, b.y}), 1) << lit.name;
      }
      EXPECT_GT(met, n / 1000) << lit.name;
      if (target == PhotonTarget::specular) {
        EXPECT_LT(guide.lights[0].relevance, lit.largest_share) << lit.name;
      }
    }
  }
}

// Lights that cannot reach any target get few photons, and a scene without targets is lit as before.
TEST(ProjectionMap, SharesPhotonsAmongLights) {
  const std::string up_lights = R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [100 100 100]
)" + test::patch("0 3 0  0 3 1  1 3 0  1 3 1") +
                                "AttributeEnd\n";
  const Scene scene = test::world(things + lit_scenes[0].light + up_lights);
  const EmissionGuide guide = make_projection_map(scene, PhotonTarget::specular);
  ASSERT_EQ(guide.lights.size(), 2u);
  EXPECT_GT(guide.lights[0].relevance, 10 * guide.lights[1].relevance);
  EXPECT_GT(guide.lights[1].relevance, 0);
  const std::uint64_t n = 10'000;
  const PhotonAllocation plain(scene.lights(), n, 0.5f), guided(scene.lights(), n, 0.5f, &guide);
  EXPECT_GT(guided.shares()[0].count, 3 * plain.shares()[0].count);
  for (const PhotonAllocation& allocation : {plain, guided}) {
    EXPECT_EQ(allocation.total(), n);
    for (const PhotonAllocation::Share& share : allocation.shares())
      EXPECT_NEAR(share.weight * static_cast<float>(share.count), 1, 1.5f / static_cast<float>(share.count));
  }
  const Scene matte = test::world(R"(Material "diffuse"
Shape "sphere"
)" + lit_scenes[4].light);
  EXPECT_EQ(make_projection_map(matte, PhotonTarget::specular).lights[0].numbers.size(), 0u);
}

// A glass ball and its surroundings, which fill the view, on a large plane under a lamp and a sky that light the whole
// plane uniformly.
const std::string view_of_the_ball = R"(LookAt 0 0.5 1  0 0.05 0  0 1 0
Camera "perspective" "float fov" [45]
)";
std::string corner_of_a_plain(const std::string& lamp) {
  return R"(Film "rgb" "integer xresolution" [24] "integer yresolution" [24]
PixelFilter "box"
WorldBegin
LightSource "infinite" "rgb L" [0.01 0.01 0.01]
AttributeBegin
AreaLightSource "diffuse" )" +
         lamp +
         R"(AttributeEnd
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
)" + test::patch("-20 0 20  20 0 20  -20 0 -20  20 0 -20") +
         R"(Material "dielectric"
Translate 0 0.25 0
Shape "sphere" "float radius" [0.1]
)";
}
const std::string near_lamp = R"("rgb L" [5000 5000 5000]
Translate 3 8 2
Shape "sphere" "float radius" [0.2]
)",
                  far_lamp =
                      R"("rgb L" [50000 50000 50000]
Translate 300 800 200
Shape "sphere" "float radius" [6]
)";

std::vector<Image> layers_of(const Scene& scene, const std::string& layer, const std::string& integrator, bool learned,
                             std::uint64_t runs) {
  RenderOptions options = test::options_for(integrator, 8);
  options.set["emission"] = learned ? "learned" : "power";
  options.color = ColorMode::rgb;
  options.photons = 20'000;
  options.max_depth = 6;
  options.set["radius"] = "0.01";
  return test::select_layers(test::independent_renders(scene, options, runs, 0), layer);
}
std::vector<Image> caustics_of(const Scene& scene, const std::string& integrator, bool learned, std::uint64_t runs) {
  return layers_of(scene, "caustic", integrator, learned, runs);
}

// Measured by 400 passes of probppm with a million photons each.
constexpr double mean_caustic = 0.0170;

// Squared differences between runs, divided by the square of the mean.
double relative_variance(const std::vector<Image>& images, double mean) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + 1 < images.size(); i += 2)
    for (std::size_t k = 0; k < images[i].pixels.size(); ++k, ++count)
      sum += sqr(static_cast<double>(images[i].pixels[k]) - static_cast<double>(images[i + 1].pixels[k])) / 2;
  return sum / static_cast<double>(count) / sqr(mean);
}

// One photon in 30 000 finds the ball, and few of these land within the radius of an eye path: without a guide, this
// happens in about one of four renders. The probability that it happens in none of a hundred renders, which would look
// like zero noise, is 1e-12. Paths of vcm also reach it without photons. Gains are 2500 and 600.
TEST(LearnedEmission, FindsWhatIsSmall) {
  const Scene scene = test::scene_from_text(view_of_the_ball + corner_of_a_plain(near_lamp));
  for (const auto& [integrator, least_gain] : {std::pair<const char*, double>{"probppm", 10}, {"vcm", 10}}) {
    const std::vector<Image> plain = caustics_of(scene, integrator, false, 100),
                             learned = caustics_of(scene, integrator, true, 16);
    EXPECT_TRUE(
        test::below(least_gain * relative_variance(learned, mean_caustic) / relative_variance(plain, mean_caustic), 1))
        << integrator;
    EXPECT_TRUE(test::runs_agree(test::mean_of_means(learned), mean_caustic, 0.05, 0.4, test::false_alarm_rate / 2))
        << integrator;
  }
}

// In principle, eye paths find the lamp through the ball, too, but this happens in none of these renders. Merging must
// contribute the light, and the weights must know how dense the guide makes the photons: without that, six sevenths of
// it are missing. The expected mean comes from 60 passes with a million light paths each.
TEST(LearnedEmission, IsKnownToWeights) {
  const Scene scene = test::scene_from_text(view_of_the_ball + corner_of_a_plain(far_lamp));
  EXPECT_TRUE(test::runs_agree(test::mean_of_means(caustics_of(scene, "vcm", true, 24)), 0.01496, 0.05, 0.6));
}

// Photons are dense around the ball, but next-event estimation finds the direct light there with less noise. Without
// the exception that weights make for direct light, the variance is thirteen times as high.
TEST(LearnedEmission, LeavesDirectLightToNextEventEstimation) {
  const Scene scene = test::scene_from_text(view_of_the_ball + corner_of_a_plain(far_lamp));
  const std::vector<Image> guided = layers_of(scene, "direct", "vcm", true, 16),
                           plain = layers_of(scene, "direct", "vcm", false, 16);
  EXPECT_TRUE(test::runs_agree(test::mean_of_means(guided), test::mean_of_means(plain), 0.005, 0.05));
  EXPECT_LT(relative_variance(guided, 1), 2 * relative_variance(plain, 1));
}

// The visible part of a large plane under a single lamp.
std::string on_a_plain(const std::string& lamp, const std::string& things_there) {
  return view_of_the_ball +
         R"(Film "rgb" "integer xresolution" [24] "integer yresolution" [24]
PixelFilter "box"
WorldBegin
)" + lamp +
         R"(Material "diffuse" "rgb reflectance" [0.8 0.8 0.8]
)" + test::patch("-20 0 20  20 0 20  -20 0 -20  20 0 -20") +
         things_there;
}
const std::string walls = test::patch("-.3 0 -.2  .3 0 -.2  -.3 .3 -.2  .3 .3 -.2") +
                          test::patch("-.3 0 -.2  -.3 0 .2  -.3 .3 -.2  -.3 .3 .2");
// Curves so close that they overlap.
std::string curves() {
  std::string result;
  for (int i = 0; i < 8; ++i) {
    const std::string z = " " + std::to_string(0.01 * i) + "  ";
    result +=
        R"(Shape "curve" "float width" .03 "point3 P" [-.3 0)" + z + "-.1 .2" + z + ".1 .2" + z + ".3 0" + z + "]\n";
  }
  return result;
}

// Weights must use the same density of light paths whether a light path or an eye path generates a path. Merging is
// rare here, so that connections provide the light that path tracing leaves to other techniques. When weights on flat
// curves used the guided density, indirect light was 6 % too bright, and 27 % on hair.
TEST(NightlyLearnedEmission, KeepsIndirectLight) {
  const std::string lamp = R"(AttributeBegin
AreaLightSource "diffuse" )" +
                           near_lamp + "AttributeEnd\n";
  struct Plain {
    std::string name, text;
    std::uint64_t passes;
    double noise;
  };
  std::vector<Plain> plains{{"flat curves", on_a_plain(lamp, curves()), 64, 0.2},
                            {"hair", on_a_plain(lamp, R"(Material "hair" "rgb color" [.8 .6 .4]
)" + curves()),
                             64, 0.2}};
  for (const LitScene& lit : lit_scenes) plains.push_back({lit.name, on_a_plain(lit.light, walls), 16, 0.08});
  for (const Plain& plain : plains) {
    const Scene scene = test::scene_from_text(plain.text);
    const auto indirect = [&](const char* integrator, bool learned) {
      RenderOptions options = test::options_for(integrator, plain.passes);
      options.color = ColorMode::rgb;
      options.max_depth = 2;
      if (learned) {
        options.set["emission"] = "learned";
        options.set["radius"] = "0.0002";
      }
      return test::mean_of_means(test::select_layers(test::independent_renders(scene, options, 12, 0), "indirect"));
    };
    EXPECT_TRUE(test::runs_agree(indirect("vcm", true), indirect("bdpt", false), 0.01, plain.noise)) << plain.name;
  }
}

// A sky whose light passes through the ball to the plane. Few pixels determine where its photons must start.
TEST(LearnedEmission, AimsSkyLightAtGlass) {
  const Scene scene = test::scene_from_text(view_of_the_ball +
                                            R"(Film "rgb" "integer xresolution" [24] "integer yresolution" [24]
PixelFilter "box"
WorldBegin
LightSource "infinite" "rgb L" [0.6 0.6 0.6]
LightSource "distant" "point3 from" [3 9 -2] "point3 to" [0 0 0] "rgb L" [12 12 12]
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
)" + test::patch("-20 0 20  20 0 20  -20 0 -20  20 0 -20") +
                                            R"(Material "dielectric"
Translate 0 0.25 0
Shape "sphere" "float radius" [0.1]
)");
  for (const char* const integrator : {"probppm", "bpm", "sppm"}) {
    RenderOptions options = test::options_for(integrator, 4);
    options.set["emission"] = "learned";
    options.color = ColorMode::rgb;
    options.photons = 20'000;
    const std::vector<Image> images = test::select_layers(test::independent_renders(scene, options, 4, 0), "caustic");
    // Over seeds .05 to .3; 70 if only chance sends the guide's photons there.
    EXPECT_TRUE(test::below(relative_variance(images, test::mean_of_means(images).mean()) / 2, 1)) << integrator;
  }
}

// Sorted densities of the first light's photons towards the ball, relative to those without a guide.
std::vector<float> densities_towards(const Scene& scene, const EmissionGuide& guide, const Point& ball) {
  const EmissionGuide::OfLight& learned = guide.lights[0];
  const EmissionGuide map = make_projection_map(scene, PhotonTarget::specular);
  std::vector<float> result;
  HashRng rng(test::seed(3));
  while (result.size() < 10'000) {
    const TreeDistribution::Numbers n =
        map.lights[0].numbers.sample({rng.next(), rng.next(), rng.next(), rng.next()}).at;
    const auto emission = sample_emission(scene.lights()[0], {n[0], n[1]}, {n[2], n[3]}, test::white);
    if (!emission) continue;
    const Ray ray = spawn_from_light(*emission, 0);
    const Vec3 to_ball = ball - ray.origin;
    if (length_squared(to_ball - dot(to_ball, ray.direction) * ray.direction) < sqr(0.1f))
      result.push_back(learned.relevance * learned.numbers.pdf({n[0], n[1], n[2], n[3]}));
  }
  std::sort(result.begin(), result.end());
  return result;
}

EmissionGuide learned_for_caustics(const Scene& scene) {
  const RenderPlan plan = test::plan_render(scene, test::options_for("probppm", 1));
  return learn_emission(plan.job(scene), PhotonUse::caustics).guide.value().emission;
}

// The picture shows a part of the caustic. Directions that no pilot photon has taken are also sampled often, because
// they may matter: otherwise a few photons of huge flux would dominate the picture.
TEST(LearnedEmission, LeavesNoWayThroughGlassToChance) {
  const Scene scene = test::scene_from_text(R"(LookAt -0.1 0.5 -0.2  -0.1 0 -0.1  0 1 0
Camera "perspective" "float fov" [10]
)" + corner_of_a_plain(near_lamp));
  const std::vector<float> found = densities_towards(scene, learned_for_caustics(scene), {0, 0.25f, 0});
  EXPECT_TRUE(test::below(5000 / found.back(), 1));  // 1.5 to 8 million
  // Of 10 000 directions all but a few at the rim of the ball (25 in a million): 151 to 179 over seeds.
  EXPECT_TRUE(test::below(50 / found[10], 1));
}

// Two equal balls cast caustics; a spot light outshines one of them.
TEST(LearnedEmission, SparesWhatIsOutshone) {
  const Scene scene = test::scene_from_text(view_of_the_ball + corner_of_a_plain(near_lamp) +
                                            R"(Translate 0.5 0 0
Shape "sphere" "float radius" [0.1]
LightSource "spot" "point3 from" [-0.1 3 -0.07] "point3 to" [-0.1 0 -0.07] "float coneangle" [5] "float conedeltaangle" [1] "float scale" [2000]
)");
  const EmissionGuide guide = learned_for_caustics(scene);
  // The ratio of the medians is 20, with a standard deviation of 2 over seeds.
  const auto median_towards = [&](const Point& ball) { return densities_towards(scene, guide, ball)[5000]; };
  EXPECT_TRUE(test::below(10 * median_towards({0.5f, 0.25f, 0}) / median_towards({0, 0.25f, 0}), 1));
}

// A court between walls with a ball in it, alone or in a large world, under a sun and a sky.
std::string court(bool in_a_large_world) {
  return R"(Film "rgb" "integer xresolution" [24] "integer yresolution" [18]
PixelFilter "box"
LookAt -3.4 1.7 -3.4  1 1.2 1  0 1 0
Camera "perspective" "float fov" [65]
WorldBegin
LightSource "infinite" "rgb L" [0.6 0.6 0.6]
LightSource "distant" "point3 from" [3 9 -2] "point3 to" [0 0 0] "rgb L" [12 12 12]
Material "diffuse" "rgb reflectance" [0.6 0.6 0.6]
Shape "trianglemesh" "integer indices" [0 1 2 1 3 2  0 4 1 1 4 5  2 3 6 3 7 6  0 2 4 2 6 4  1 5 3 3 5 7]
  "point3 P" [-4 0 -4  4 0 -4  -4 0 4  4 0 4  -4 9 -4  4 9 -4  -4 9 4  4 9 4]
AttributeBegin
Translate 1.5 0.6 1
Shape "sphere" "float radius" [0.6]
AttributeEnd
)" + std::string(in_a_large_world ? test::patch("-300 -0.1 -300  300 -0.1 -300  -300 -0.1 300  300 -0.1 300") : "");
}

// In the large world, one photon in 10 000 starts towards the court.
TEST(AutomaticEmission, AimsWherePhotonsAreFew) {
  for (const bool in_a_large_world : {false, true}) {
    const Scene scene = test::scene_from_text(court(in_a_large_world));
    const RenderPlan plan = test::plan_render(scene, test::options_for("probppm", 1));
    const Emission emission = choose_emission(EmissionChoice::automatic, PhotonUse::indirect, plan.job(scene));
    EXPECT_EQ(emission.guide.has_value(), in_a_large_world);
    EXPECT_EQ(emission.remark.empty(), !in_a_large_world);
  }
}

// A small isolated ball of fog, in a lamp's wide light, which fills the view.
const std::string ball_of_fog =
    R"(LookAt 0 0.25 2  0 0.25 0  0 1 0
Camera "perspective" "float fov" [8]
Film "rgb" "integer xresolution" [24] "integer yresolution" [24]
PixelFilter "box"
WorldBegin
LightSource "point" "point3 from" [1.5 1 1]
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [20 20 20] "rgb sigma_a" [0 0 0]
MediumInterface "fog" ""
Material "interface"
Translate 0 0.25 0
Shape "sphere" "float radius" [0.1]
)";

// Fraction of a guide's photons that hit the ball; 0.0008 without a guide.
double share_towards_fog(const EmissionGuide& guide, const Scene& scene) {
  HashRng rng(test::seed(4));
  int met = 0;
  constexpr int n = 20'000;
  for (int i = 0; i < n; ++i) {
    const TreeDistribution::Numbers u =
        guide.lights[0].numbers.sample({rng.next(), rng.next(), rng.next(), rng.next()}).at;
    const auto emission = sample_emission(scene.lights()[0], {u[0], u[1]}, {u[2], u[3]}, test::white);
    met += emission && scene.intersect(spawn_from_light(*emission, 0), test::white) ? 1 : 0;
  }
  return static_cast<double>(met) / n;
}

// Guides aim photons at media, except where media would store none.
TEST(MediaAsTargets, GuidesAimAtThem) {
  const Scene scene = test::scene_from_text(ball_of_fog);
  const RenderPlan plan = test::plan_render(scene, test::options_for("probppm", 1));
  for (const EmissionChoice choice : {EmissionChoice::projected, EmissionChoice::learned}) {
    const auto share = [&](MediumRecords records) {
      return share_towards_fog(*choose_emission(choice, PhotonUse::indirect, plan.job(scene), records).starts(), scene);
    };
    EXPECT_GT(share(MediumRecords::points), 0.1) << static_cast<int>(choice);
    EXPECT_LT(share(MediumRecords::none), 0.01) << static_cast<int>(choice);
  }
}

// No part of unbounded fog is aimed at, and no photon is omitted.
TEST(MediaAsTargets, FogWithoutEndIsEverywhere) {
  const Scene scene = test::scene_from_text(R"(MediumInterface "" "fog"
)" + ball_of_fog +
                                            R"(MakeNamedMedium "thin" "string type" "homogeneous"
MediumInterface "thin" "fog"
Shape "sphere" "float radius" [0.2]
)");
  EXPECT_FALSE(scene.scattering_boxes());
  EXPECT_EQ(make_projection_map(scene, PhotonTarget::surfaces_and_media).lights[0].numbers.size(), 0u);
}

// One block under the sun: nothing visible is lit indirectly.
TEST(AutomaticEmission, DoesNotAimForNothing) {
  const Scene scene = test::scene_from_text(
      R"(Film "rgb" "integer xresolution" [24] "integer yresolution" [18]
LookAt 3 3 3  0 0 0  0 1 0
Camera "perspective"
WorldBegin
LightSource "distant" "point3 from" [1 2 3]
Shape "sphere"
)");
  const RenderPlan plan = test::plan_render(scene, test::options_for("probppm", 1));
  const Emission emission = choose_emission(EmissionChoice::automatic, PhotonUse::indirect, plan.job(scene));
  EXPECT_FALSE(emission.guide);
  EXPECT_EQ(emission.remark, "");
}

// Eye paths that leave a block reach only the sky. They miss small glass objects, but projection maps find these.
TEST(LearnedEmission, TracesLightOnlyIfItCanAddToThePicture) {
  const std::string block =
      R"(Film "rgb" "integer xresolution" [12] "integer yresolution" [9]
LookAt 3 3 3  0 0 0  0 1 0
Camera "perspective"
WorldBegin
LightSource "distant" "point3 from" [1 2 3]
Shape "sphere"
)";
  const std::string glass = R"(Material "dielectric"
Translate 1 2 3
Shape "sphere" "float radius" [0.02]
)";
  const auto has_guide = [](const std::string& text) {
    const Scene scene = test::scene_from_text(text);
    const RenderPlan plan = test::plan_render(scene, test::options_for("probppm", 1));
    return learn_emission(plan.job(scene), PhotonUse::indirect).guide.has_value();
  };
  EXPECT_FALSE(has_guide(block));
  EXPECT_TRUE(has_guide(block + glass));
}

// A guide that has nothing to learn leaves photons unguided.
TEST(LearnedEmission, LeavesScenesAloneWhereThereIsNothingToLearn) {
  const std::string film = R"(Film "rgb" "integer xresolution" [8] "integer yresolution" [6]
)";
  const std::string towards_origin = R"(LookAt 3 3 3  0 0 0  0 1 0
Camera "perspective"
WorldBegin
)";
  const std::string away = R"(LookAt 3 3 3  6 6 6  0 1 0
Camera "perspective"
WorldBegin
)";
  const std::string ball = R"(Shape "sphere"
)",
                    sun = R"(LightSource "distant" "point3 from" [1 2 3]
)";
  const std::string black_sun = R"(LightSource "distant" "rgb L" [0 0 0]
)";
  const std::string black_lamp = R"(AreaLightSource "diffuse" "rgb L" [0 0 0]
)" + ball;
  const std::string glass = R"(Material "dielectric"
Translate 1 2 3
)" + ball;
  const std::array<std::pair<const char*, std::string>, 6> scenes{
      {{"without lights", film + towards_origin + ball + glass},
       {"with black lights", film + towards_origin + black_sun + ball + black_lamp + glass},
       {"seen from a camera that looks away", film + away + sun + ball},
       {"without geometry", film + towards_origin + sun},
       {"with a diffuse ball alone", film + towards_origin + sun + ball},
       {"empty", film + towards_origin}}};
  for (const auto& [name, text] : scenes) {
    const Scene scene = test::scene_from_text(text);
    for (const char* integrator : {"vcm", "bpm", "probppm", "sppm", "ppm", "photonmap", "reversephotonmap"}) {
      RenderOptions options = test::options_for(integrator, 2);
      options.photons = 1000;
      options.set["emission"] = "power";
      const std::vector<float> expected = test::render_image(scene, options).pixels;
      options.set["emission"] = "learned";
      EXPECT_EQ(test::render_image(scene, options).pixels, expected) << integrator << ", scene " << name;
    }
  }
}

// Without a guide, two photons per pass would start towards the court.
TEST(AutomaticEmission, ShowsAPlaceInALargeWorldAsPathTracingDoes) {
  const Scene scene = test::scene_from_text(court(true));
  RenderOptions options = test::options_for("path", 64);
  const test::Mean expected =
      test::mean_of_means(test::select_layers(test::independent_renders(scene, options, 12, 100), "indirect"));
  for (const char* integrator : {"probppm", "bpm"}) {
    options = test::options_for(integrator, 8);
    options.photons = 20'000;
    const test::Mean found =
        test::mean_of_means(test::select_layers(test::independent_renders(scene, options, 12, 0), "indirect"));
    EXPECT_TRUE(test::runs_agree(found, expected, 0.03, 0.2)) << integrator;
  }
}

// A room with a window onto sunlit ground, seen from inside.
const std::string room_with_a_window =
    R"(Film "rgb" "integer xresolution" [48] "integer yresolution" [27]
PixelFilter "box"
LookAt 0.5 1.6 -2.8  3 1.2 2.5  0 1 0
Camera "perspective" "float fov" [60]
WorldBegin
LightSource "distant" "point3 from" [-5 8 -3] "point3 to" [0 0 0] "rgb L" [12 12 12]
Material "diffuse" "rgb reflectance" [0.4 0.4 0.4]
)" + test::patch("-30 -0.01 -30  30 -0.01 -30  -30 -0.01 30  30 -0.01 30") +
    R"(Material "diffuse" "rgb reflectance" [0.75 0.75 0.75]
Shape "trianglemesh" "point3 P" [0 0 -3  4 0 -3  0 0 3  4 0 3  0 2.7 -3  4 2.7 -3  0 2.7 3  4 2.7 3  4 0.9 -0.5  4 0.9 1.2  4 2.1 -0.5  4 2.1 1.2]
"integer indices" [0 1 2 1 3 2  4 5 6 5 7 6  0 1 4 1 5 4  2 3 6 3 7 6  0 2 4 2 6 4
  1 3 8 3 9 8  3 7 9 7 11 9  7 5 11 5 10 11  5 1 10 1 8 10]
)";

// Guided light paths bring many more photons into the room. (agreement_test.cpp checks that the mean is the same.)
TEST(LearnedDirections, LeadThroughTheWindow) {
  const Scene scene = test::scene_from_text(room_with_a_window);
  const RenderPlan plan = test::plan_render(scene, test::options_for("probppm", 1));
  const RenderJob job = plan.job(scene);
  const LightGuide guide = learn_emission(job, PhotonUse::indirect).guide.value(), starts{guide.emission};
  EXPECT_EQ(learn_emission(job, PhotonUse::merging).guide.value().directions.size(), 0u);
  const auto at_ceiling = [&](const LightGuide& by) {
    PhotonTracer tracer;
    tracer.trace(scene, {test::seed(3), Stream::light, 0, 100'000}, {}, draw_for_pass(job, 0), &by);
    double photons = 0;
    for (const std::vector<Photon>& chunk : tracer.chunks())
      for (const Photon& photon : chunk) photons += photon.position.y > 2.69f ? 1 : 0;
    return photons;
  };
  EXPECT_TRUE(test::below(2 * at_ceiling(starts) / at_ceiling(guide), 1));
}

// The mean of flux times any function of the origin is the same as for the light without disks.
TEST(AimedDisks, LeaveTheLightAsItIs) {
  const Scene scene = test::scene_from_text(court(true));
  const BoundingSphere& all = scene.bounding_sphere();
  const Point off_centre = all.centre + 0.3f * all.radius * normalize(Vec3(1, 0.2f, -0.5f));
  const AimedDisks disks(all, off_centre, 0.01f * all.radius);
  for (const Light& light : scene.lights()) {
    const double flux = static_cast<double>(sample_emission(light, {0.5f, 0.5f}, {0.5f, 0.5f}, test::white)->flux[1]);
    HashRng rng(test::seed(11));
    test::Mean total, near;
    for (int i = 0; i < 200'000; ++i) {
      const Vec2 direction = rng.next2(), position = rng.next2();
      const auto aimed =
          sample_emission(light, &disks, {position.x, position.y, direction.x, direction.y}, test::white);
      const Vec3 to_centre = disks.centre - aimed->origin;
      const float miss2 = length_squared(to_centre - dot(to_centre, aimed->direction) * aimed->direction);
      const double share = static_cast<double>(aimed->flux[1]) / flux;
      total.add(share);
      near.add(miss2 < sqr(0.05f * all.radius) ? share : 0);
      EXPECT_LE(share, AimedDisks::count + 1e-3);
    }
    EXPECT_TRUE(test::runs_agree(total, 1, 0, 0.05));
    EXPECT_TRUE(test::runs_agree(near, 0.0025, 0, 0.05));
  }
}

// The guide samples photons in each part of the ray space with the density that weights assume.
TEST(GuidedDensity, IsThatOfThePhotons) {
  const Scene scene = test::scene_from_text(court(true));
  const BoundingSphere& all = scene.bounding_sphere();
  const Point off_centre = all.centre + 0.3f * all.radius * normalize(Vec3(1, 0.2f, -0.5f));
  const AimedDisks aimed(all, off_centre, 0.2f * all.radius);
  const auto is_there = [&](const EmissionSample& s) {
    const Vec3 to_centre = aimed.centre - s.origin;
    const float miss2 = length_squared(to_centre - dot(to_centre, s.direction) * s.direction);
    return !s.flux.is_black() && miss2 < sqr(0.3f * all.radius) && s.direction.y < 0;
  };
  TreeDistribution numbers;  // halved along all axes
  const std::uint32_t near = numbers.add_inner(2, numbers.add_leaf(0.5f), numbers.add_leaf(0.05f));
  const std::uint32_t far = numbers.add_inner(1, numbers.add_leaf(0.15f), numbers.add_leaf(0.1f));
  numbers.add_inner(0, numbers.add_inner(3, near, numbers.add_leaf(0.2f)), far);
  for (const Light& light : scene.lights())
    for (const bool has_disks : {false, true}) {
      EmissionGuide guide(1, has_disks ? std::optional(aimed) : std::nullopt);
      guide.lights[0].numbers = numbers;
      HashRng rng(test::seed(12));
      test::Mean part, expected;
      for (int i = 0; i < 1'000'000; ++i) {
        const TreeDistribution::Numbers u{rng.next(), rng.next(), rng.next(), rng.next()};
        part.add(
            is_there(*sample_emission(light, has_disks ? &aimed : nullptr, numbers.sample(u).at, test::white)) ? 1 : 0);
        const auto even = sample_emission(light, {u[0], u[1]}, {u[2], u[3]}, test::white);
        const float density = guided_density(guide, light, 0, {even->origin, Normal(0), Vec2(0)}, even->direction);
        expected.add(is_there(*even) ? static_cast<double>(density) : 0);
      }
      EXPECT_TRUE(test::runs_agree(part, expected, 0, 0.05));
    }
}

double rare_share(const std::string& lights_and_shapes) {
  const Scene scene = test::world(R"(Material "diffuse"
)" + test::patch("-3 -1 1  3 -1 1  -3 -1 7  3 -1 7") +
                                  test::patch("-3 -1 7  3 -1 7  -3 3 7  3 3 7") + lights_and_shapes);
  return rare_light_share(test::plan_render(scene, test::options_for("path", 1)).job(scene));
}

const std::string lamp =
    R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [100 100 100]
Translate 0 2 4
Shape "sphere" "float radius" [0.05]
AttributeEnd
)";

// Path tracing finds the light of small lights behind glass only rarely.
TEST(RareLight, IsThatOfSmallLightsBehindGlass) {
  const std::string glass = R"(Material "dielectric"
)";
  const std::string around_the_lamp = glass +
                                      R"(AttributeBegin
Translate 0 2 4
Shape "sphere" "float radius" [0.3]
AttributeEnd
)";
  const std::string beside = glass + R"(AttributeBegin
Translate 2 -0.5 5
Shape "sphere" "float radius" [0.2]
AttributeEnd
)";
  const std::string pane = R"(Material "thindielectric"
)" + test::patch("-9 3.5 -9  9 3.5 -9  -9 3.5 9  9 3.5 9");
  EXPECT_TRUE(test::below(0.8 / rare_share(lamp + around_the_lamp), 1));
  EXPECT_TRUE(test::below(0.4 / rare_share(R"(LightSource "distant" "point3 from" [0 9 -2]
)" + pane),
                          1));
  EXPECT_TRUE(test::below(rare_share(lamp + beside), 0.1));
  EXPECT_TRUE(test::below(rare_share(R"(LightSource "infinite"
)" + pane),
                          0.05));
  EXPECT_EQ(rare_share(lamp), 0);
}

// Milk in front of the camera: next-event estimation inside it sees the lamp unless there is an interface.
TEST(RareLight, IsInMediaToo) {
  const std::string milk =
      R"(MakeNamedMedium "milk" "string type" "homogeneous" "rgb sigma_a" [0 0 0] "rgb sigma_s" [9 9 9]
AttributeBegin
MediumInterface "milk" ""
Translate 0 0 4
Shape "sphere" "float radius" [1.5]
AttributeEnd
)";
  const auto lamp_of = [](const char* radius) {
    return std::string(R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [9 9 9]
Translate 0 4 4
)") + R"(Shape "sphere" "float radius" [)" +
           radius + "]\nAttributeEnd\n";
  };
  EXPECT_GT(rare_share(lamp_of("0.01") + R"(Material "dielectric"
)" + milk),
            0.1);
  EXPECT_EQ(rare_share(lamp_of("0.01") + R"(Material "interface"
)" + milk),
            0);
  // About one direction in 200 hits this lamp: not rare, but the variance of a pass is 200. Probabilities below 0.001
  // alone account for .034; found: .094.
  EXPECT_GT(rare_share(lamp_of("0.2") + R"(Material "dielectric"
)" + milk),
            0.065);
  EXPECT_EQ(rare_share(lamp_of("0.2") + R"(Material "interface"
)" + milk),
            0);
}

}  // namespace
}  // namespace lanthorn::emission_test
