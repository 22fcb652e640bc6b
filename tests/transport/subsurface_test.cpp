// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Subsurface scattering: the diffuse reflectance of materials, and how the depth limit counts passages under surfaces.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/runs.h"
#include "support/shapes.h"
#include "surface/fresnel.h"

namespace lanthorn::subsurface_test {
namespace {

// The part of an even sky's light that a dielectric reflects.
double mean_fresnel(float eta) {
  constexpr int steps = 1000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const float cos2 = (static_cast<float>(i) + 0.5f) / steps;
    sum += static_cast<double>(fresnel_dielectric(std::sqrt(cos2), eta).reflectance) / steps;
  }
  return sum;
}

// An orthographic view of a ball that just fits into the film, under a white sky.
Scene ball_of(const std::string& material, const std::string& integrator = "") {
  return test::scene_from_text(
      R"(LookAt 0 0 5  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-1 1 -1 1]
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
PixelFilter "box" "float xradius" .5 "float yradius" .5
)" + integrator +
      R"(WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Material "subsurface" )" +
      material +
      R"( Shape "sphere"
)");
}

// Mean of its picture if the ball reflects the part ρ of the light that enters it.
double mean_of_ball(float eta, double reflectance) {
  const double quarter = 3.14159265358979 / 4, fresnel = mean_fresnel(eta);
  return 1 - quarter + quarter * (fresnel + (1 - fresnel) * reflectance);
}

RenderOptions options(const std::string& integrator, std::uint64_t passes) {
  RenderOptions o = test::options_for(integrator, passes, 1);
  o.color = ColorMode::rgb;
  o.photons = 2'000;
  return o;
}

test::Mean mean(const Scene& scene, const RenderOptions& o, std::uint64_t first_seed = 1) {
  return test::mean_of_means(test::select_layers(test::independent_renders(scene, o, 16, first_seed), "color"));
}

// A ball of a thousand mean free paths reflects as a half-space does; "reflectance" is that of the material with its
// interface (pbrt-v4), under which light scatters hundreds of times.
TEST(Subsurface, HasTheReflectanceThatTheFileSays) {
  struct Case {
    float eta, g, reflectance;
  };
  for (const auto& [eta, g, reflectance] :
       {Case{1.33f, 0, .5f}, Case{1.33f, 0, .9f}, Case{1.5f, .7f, .6f}, Case{1.8f, -.3f, .3f}}) {
    const std::string r = std::to_string(reflectance);
    const Scene scene = ball_of(R"("float mfp" .002 "rgb reflectance" [)" + r + ' ' + r + ' ' + r +
                                R"(] "float eta" )" + std::to_string(eta) + R"( "float g" )" + std::to_string(g));
    EXPECT_TRUE(test::runs_agree(mean(scene, options("path", 16)), mean_of_ball(eta, static_cast<double>(reflectance)),
                                 .004, .05, test::false_alarm_rate / 4))
        << reflectance;
  }
}

// The file's limit does not cut a passage short: light scatters some 50 times in this ball, but a passage counts once.
// Nor does the user's own limit.
TEST(Subsurface, PassagesCountOnce) {
  const std::string white = R"("rgb sigma_s" [9 9 9] "rgb sigma_a" [0 0 0])";
  for (const int depth : {1, 5}) {
    const Scene scene = ball_of(white, R"(Integrator "volpath" "integer maxdepth" )" + std::to_string(depth) + "\n");
    EXPECT_TRUE(test::runs_agree(mean(scene, options("path", 16)), 1, .001, .03, test::false_alarm_rate / 3)) << depth;
  }
  RenderOptions o = options("path", 16);
  o.max_depth = 1;
  EXPECT_TRUE(test::runs_agree(mean(ball_of(white), o), 1, .001, .03, test::false_alarm_rate / 3));
}

// A ball of rough wax over a floor, with a bone inside. The depth limit removes more than a tenth of the light, so
// methods that count differently disagree. Kernels of the default radius lose light beyond the ball's surface.
class SubsurfaceDepth : public testing::TestWithParam<int> {};

TEST_P(SubsurfaceDepth, IsTheSameForAllMethods) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 1.2 3  0 .5 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
PixelFilter "box" "float xradius" .5 "float yradius" .5
WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [6 6 6]
Translate .6 2.4 .6
Shape "sphere" "float radius" .5
AttributeEnd
Material "diffuse" "rgb reflectance" [.7 .7 .7]
)" + test::patch("-2 0 2  2 0 2  -2 0 -2  2 0 -2") +
      R"(MakeNamedMaterial "wax" "string type" "subsurface" "rgb sigma_s" [4 4 4] "rgb sigma_a" [.1 .1 .1] "float eta" 1.3 "float roughness" .4 "bool remaproughness" false
Translate 0 .6 0
NamedMaterial "wax"
Shape "sphere" "float radius" .6
Material "diffuse" "rgb reflectance" [.8 .4 .2]
Shape "sphere" "float radius" .2
)");
  const auto found = [&](const std::string& integrator, std::uint64_t passes, std::uint64_t first_seed) {
    RenderOptions o = options(integrator, passes);
    o.max_depth = GetParam();
    return mean(scene, o, first_seed);
  };
  const test::Mean expected = found("path", 256, 1);
  std::uint64_t seed = 100;
  for (const char* integrator :
       {"light", "bdpt", "vcm", "vcm:volume=point", "bpm", "probppm:volume-radius=.02", "sppm:volume-radius=.02",
        "photonmap:volume-radius=.02", "reversephotonmap:volume-radius=.02"})
    EXPECT_TRUE(test::runs_agree(found(integrator, 64, seed += 100), expected, .02, .1, test::false_alarm_rate / 20))
        << integrator;
}
INSTANTIATE_TEST_SUITE_P(Nightly, SubsurfaceDepth, testing::Values(1, 2));

}  // namespace
}  // namespace lanthorn::subsurface_test
