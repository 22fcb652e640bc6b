// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Compares the variance that the pilot of "auto" predicts for other numbers of samples with the variance of actual
// renders.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "integrators/auto/auto.h"
#include "integrators/auto/pilot.h"
#include "integrators/vcm/vcm_pass.h"
#include "render/picture.h"
#include "render/plan.h"
#include "support/render_scene.h"

namespace lanthorn::effort_test {
namespace {

// The lower part of the picture, without the lamp, whose edges would dominate the variance of every choice.
constexpr int size = 64, height = 36;
const std::map<std::string, std::string> fixed{{"radius", "0.04"}, {"alpha", "1"}, {"emission", "power"}};

RenderOptions options_of(const std::string& method, double light_paths, std::uint64_t seed) {
  RenderOptions options;
  options.integrator = method;
  options.resolution = {size, size};
  options.crop = {0, size - height, size, size};
  options.passes = 1;
  if (light_paths > 0) options.photons = static_cast<std::uint64_t>(light_paths * size * height);
  options.seed = seed;
  if (method == "vcm") options.set = fixed;
  return options;
}

// Variance per pass: the mean over pixels of the variance of the sum of radiance components.
double variance_of(const Scene& scene, const std::string& method, double light_paths) {
  constexpr unsigned count = 96;
  std::vector<double> sum(size * height), squares(sum.size());
  for (unsigned seed = 0; seed < count; ++seed) {
    const RenderState state = test::render_state(scene, options_of(method, light_paths, seed));
    const Image color = *select_layer(picture_of(state), "color");
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const double light = static_cast<double>(color.pixels[3 * i] + color.pixels[3 * i + 1] + color.pixels[3 * i + 2]);
      sum[i] += light / count;
      squares[i] += light * light / count;
    }
  }
  double result = 0;
  for (std::size_t i = 0; i < sum.size(); ++i)
    result += (squares[i] - sum[i] * sum[i]) * count / (count - 1) / static_cast<double>(sum.size());
  return result;
}

// The same as predicted by the pilot for a candidate.
double expected_variance(const EffortMeasurement& measured, std::size_t candidate) {
  double sum = 0;
  for (const EffortBlock& block : measured.blocks) {
    const EffortBlock::Moments& m = block.moments[candidate];
    sum += (m.second + m.rare() - m.square) / block.paths;
  }
  return sum / static_cast<double>(measured.blocks.size());
}

struct Case {
  const char* scene;
  const char* method;  // renders with these numbers
  float light_paths;
  bool merges;
};

class Estimates : public testing::TestWithParam<Case> {};

TEST_P(Estimates, OfVarianceAreThoseOfRendersWithinAFifth) {
  const Case& c = GetParam();
  const Scene scene(read_scene(std::string(LANTHORN_SOURCE_DIR "/scenes/") + c.scene));
  // Averages many pilots: a single one has few samples of such a small picture.
  double expected = 0;
  constexpr unsigned pilots = 24;
  for (unsigned seed = 0; seed < pilots; ++seed) {
    const RenderPlan plan = plan_render(scene, scene.description().view, options_of("vcm", 1, seed));
    const RenderJob job = plan.job(scene);
    const VcmSettings settings(Parameters(find_integrator("vcm").parameters, fixed, "vcm"), {});
    VcmPreparation prepared(job, settings);
    prepared.effort = Effort(pilot_light_paths(job));
    const EffortMeasurement measured = measure_candidates(job, settings, prepared);
    const std::vector<EffortCandidate>& all = measured.candidates;
    const auto found = std::find_if(all.begin(), all.end(), [&](const EffortCandidate& e) {
      return e.light_paths == measured.scale * c.light_paths && e.connections == (c.light_paths > 0 ? 1 : 0) &&
             e.merges == c.merges && e.sees == (c.light_paths > 0) && e.goes_on;
    });
    ASSERT_NE(found, all.end());
    expected += expected_variance(measured, static_cast<std::size_t>(found - all.begin())) / pilots;
  }
  EXPECT_NEAR(expected / variance_of(scene, c.method, static_cast<double>(c.light_paths)), 1, 0.2);
}
// In the first scene, rare bright contributions dominate the noise; in the others, many contributions share it.
INSTANTIATE_TEST_SUITE_P(
    Cases, Estimates,
    testing::Values(Case{"cornell-caustics.pbrt", "vcm", 1, true}, Case{"cornell-caustics.pbrt", "vcm", 0.25f, true},
                    Case{"cornell-caustics.pbrt", "vcm", 4, true}, Case{"cornell-caustics.pbrt", "bdpt", 1, false},
                    Case{"cornell-caustics.pbrt", "bdpt", 4, false}, Case{"cornell-diffuse.pbrt", "vcm", 1, true},
                    Case{"cornell-diffuse.pbrt", "bdpt", 0.25f, false}, Case{"cornell-diffuse.pbrt", "path", 0, false},
                    Case{"glossy.pbrt", "vcm", 1, true}, Case{"glossy.pbrt", "bdpt", 0.25f, false},
                    Case{"glossy.pbrt", "path", 0, false}));

// After eight passes of four light paths per pixel, the radius is the same as after 32 passes of one.
TEST(Effort, RadiiDependOnThePhotonsOfAllPasses) {
  EXPECT_FLOAT_EQ(merge_radius_shrink(0.5, 7, 4), merge_radius_shrink(0.5, 31, 1));
  EXPECT_FLOAT_EQ(merge_radius_shrink(0.5, 31, 0.25), merge_radius_shrink(0.5, 7, 1));
  EXPECT_EQ(merge_radius_shrink(0.5, 0, 0.25), 1);
}

Effort effort_of(const Scene& scene, std::optional<int> side = {}) {
  RenderOptions options = test::options_for("auto", 1, 1);
  if (side) options.resolution = {*side, *side};
  const RenderPlan plan = plan_render(scene, scene.description().view, options);
  const RenderJob job = plan.job(scene);
  VcmSettings settings(Parameters(find_integrator("vcm").parameters, {}, "vcm"), {});
  settings.plan_effort = plan_effort;
  return VcmPreparation(job, settings).effort;
}

// A plane under a uniform sky: light paths bring nothing.
const std::string plain = R"(
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
LookAt 0 -3 2  0 0 0  0 0 1
Camera "perspective" "float fov" 50
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Shape "bilinearmesh" "point3 P" [-9 -9 0  9 -9 0  -9 9 0  9 9 0]
)";

TEST(Effort, OfAPlainUnderTheSkyIsPathTracing) {
  const Scene scene = test::scene_from_text(plain);
  EXPECT_EQ(effort_of(scene).light_paths(), 0u);
  const Image own = test::render_image(scene, test::options_for("auto", 4, 1));
  const Image path = test::render_image(scene, test::options_for("path", 4, 1));
  EXPECT_EQ(select_layer(own, "color")->pixels, select_layer(path, "color")->pixels);
}

// At 128 x 128, path tracing was 1.4 times better than the best use of light paths, at equal time. At 512 x 512,
// photons are denser, and light paths were 1.3 to 2.2 times better.
TEST(Effort, OfADiffuseBoxDependsOnTheDensityOfPhotons) {
  const Scene scene(read_scene(LANTHORN_SOURCE_DIR "/scenes/cornell-diffuse.pbrt"));
  EXPECT_EQ(effort_of(scene, 128).light_paths(), 0u);
  EXPECT_GT(effort_of(scene, 512).light_paths(), 0u);
}

// A sunlit room of 4 m with a window of 40 cm. All its light comes from a small patch on the floor.
const std::string room_in_the_sun = R"(
Film "rgb" "integer xresolution" 48 "integer yresolution" 36
LookAt 0 -1.8 1  0 2 1.6  0 0 1
Camera "perspective" "float fov" 60
WorldBegin
LightSource "distant" "point3 from" [3 0 3] "point3 to" [0 0 0] "rgb L" [20 20 20]
Material "diffuse" "rgb reflectance" [.7 .7 .7]
Shape "bilinearmesh" "point3 P" [-2 -2 0  2 -2 0  -2 2 0  2 2 0]
Shape "bilinearmesh" "point3 P" [-2 -2 2  -2 2 2  2 -2 2  2 2 2]
Shape "bilinearmesh" "point3 P" [-2 2 0  2 2 0  -2 2 2  2 2 2]
Shape "bilinearmesh" "point3 P" [-2 -2 0  -2 -2 2  2 -2 0  2 -2 2]
Shape "bilinearmesh" "point3 P" [-2 -2 0  -2 2 0  -2 -2 2  -2 2 2]
Shape "bilinearmesh" "point3 P" [2 -2 0  2 -2 2  2 -.2 0  2 -.2 2]
Shape "bilinearmesh" "point3 P" [2 .2 0  2 .2 2  2 2 0  2 2 2]
Shape "bilinearmesh" "point3 P" [2 -.2 0  2 -.2 1.2  2 .2 0  2 .2 1.2]
Shape "bilinearmesh" "point3 P" [2 -.2 1.6  2 -.2 2  2 .2 1.6  2 .2 2]
Shape "bilinearmesh" "point3 P" [-200 -200 -.01  200 -200 -.01  -200 200 -.01  200 200 -.01]
)";

// Photons must be aimed at the window, and MIS weights must know the guide: path tracing has a noise of .90, aimed
// photons with unguided weights .89, and with guided weights .45.
TEST(Effort, FindsSunlightThroughAWindow) {
  const Scene scene = test::scene_from_text(room_in_the_sun);
  EXPECT_GT(effort_of(scene).light_paths(), 0u);
  EXPECT_LT(estimate_error(test::render_state(scene, test::options_for("auto", 16, 1))).noise, 0.6);
}

// Glass needs light paths. But connections of light paths to the lens are far noisier than next-event estimation and
// merging, which find all light.
TEST(Effort, LeavesDirectLightToNextEventEstimation) {
  const Scene scene = test::scene_from_text(R"(
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
LookAt 0 -3 2  0 0 0  0 0 1
Camera "perspective" "float fov" 30
WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [40 40 40]
Translate 0 0 3
Shape "sphere" "float radius" .1
AttributeEnd
Shape "bilinearmesh" "point3 P" [-2 -2 0  2 -2 0  -2 2 0  2 2 0]
Material "dielectric"
Translate .2 .2 .3
Shape "sphere" "float radius" .2
)");
  const auto variance = [&](const char* method) {
    const auto direct = [&](std::uint64_t seed) {
      return *select_layer(test::render_image(scene, test::options_for(method, 16, seed)), "direct");
    };
    const Image first = direct(0), second = direct(1);
    double sum = 0;
    for (std::size_t i = 0; i < first.pixels.size(); ++i)
      sum += std::pow(static_cast<double>(first.pixels[i] - second.pixels[i]), 2);
    return sum;
  };
  EXPECT_LT(variance("auto"), 0.5 * variance("vcm"));
}

// A glass ball far too small for the pilot: its caustic must not be lost.
TEST(Effort, MergesEverywhereWhereThereIsGlass) {
  const Scene scene = test::scene_from_text(plain + R"(
LightSource "point" "point3 from" [0 0 3] "rgb I" [1 1 1]
Material "dielectric"
Translate 1 1 .02
Shape "sphere" "float radius" .01
)");
  const Effort effort = effort_of(scene);
  EXPECT_GT(effort.light_paths(), 0u);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      EXPECT_TRUE(effort.at(Vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f)).merges);
}

// A lamp behind glass, and a point light in fog: merges at later vertices share few bright photons, and cost rays. The
// mean must not depend on where eye paths end.
class ShortEyePaths : public testing::TestWithParam<const char*> {};

TEST_P(ShortEyePaths, FindTheLightOfVcm) {
  const Scene scene(read_scene(std::string(LANTHORN_SOURCE_DIR "/scenes/") + GetParam()));
  constexpr int side = 32;
  const auto mean_of = [&](const std::string& method) {
    RenderOptions options = test::options_for(method, 64, 1);
    options.resolution = {side, side};
    const Image color = *select_layer(test::render_image(scene, options), "color");
    return std::accumulate(color.pixels.begin(), color.pixels.end(), 0.0) / static_cast<double>(color.pixels.size());
  };
  const Effort effort = effort_of(scene, side);
  int short_places = 0;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      short_places += effort.at({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}).goes_on ? 0 : 1;
  EXPECT_GT(short_places, side * side / 2);
  EXPECT_NEAR(mean_of("auto") / mean_of("vcm"), 1, 0.02);
}
INSTANTIATE_TEST_SUITE_P(Scenes, ShortEyePaths, testing::Values("lamp-in-glass.pbrt", "ball-in-fog.pbrt"));

}  // namespace
}  // namespace lanthorn::effort_test
