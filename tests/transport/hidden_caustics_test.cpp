// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// "auto" finds every caustic, however weak it is compared with the other light of a scene.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/render_scene.h"
#include "support/runs.h"
#include "support/shapes.h"

namespace lanthorn::hidden_caustics_test {
namespace {

const std::string film = R"(Film "rgb" "integer xresolution" 48 "integer yresolution" 36
PixelFilter "box"
)";
const std::string grey = R"(Material "diffuse" "rgb reflectance" [.6 .6 .6]
)";

std::string glass_ball(const std::string& at, float radius) {
  return fmt::format(
      R"(AttributeBegin
Material "dielectric"
Translate {}
Shape "sphere" "float radius" {}
AttributeEnd
)",
      at, radius);
}

std::string spot(const std::string& from, const std::string& to, float intensity, float angle) {
  return fmt::format(
      R"(LightSource "spot" "rgb I" [{0} {0} {0}] "point3 from" [{1}] "point3 to" [{2}] "float coneangle" {3} "float conedeltaangle" 1
)",
      intensity, from, to, angle);
}

// Three spot lights, each above a glass ball, behind a black wall from 47 others, which no ball sees.
std::string fifty_lamps(float strength) {
  std::string text = film + R"(LookAt 0 -4 5  0 0 0  0 0 1
Camera "perspective" "float fov" 40
WorldBegin
)" + grey + test::quad("-2 -2 0  2 -2 0  2 2 0  -2 2 0") +
                     R"(Material "diffuse" "rgb reflectance" [0 0 0]
)" + test::quad("0 -2 0  0 2 0  0 2 2  0 -2 2");
  for (const float y : {-1.0f, 0.0f, 1.0f}) {
    text += glass_ball(fmt::format("1 {} .3", y), 0.15f);
    text += spot(fmt::format("1 {} 2", y), fmt::format("1 {} 0", y), 1, 12);
  }
  for (int i = 0; i < 47; ++i) {
    const float x = -1.6f + 0.2f * static_cast<float>(i % 7), y = -1.5f + 0.5f * static_cast<float>(i / 7);
    text += spot(fmt::format("{} {} 1", x, y), fmt::format("{} {} 0", x, y), strength, 12);
  }
  return text;
}

// Sunlight falls through a window on the floor; a candle stands beside a glass ball in the shade.
const std::string sunlit_room =
    film + R"(LookAt 1.8 -1.8 1.4  -.5 .5 .2  0 0 1
Camera "perspective" "float fov" 60
WorldBegin
)" +
    R"(LightSource "distant" "rgb L" [30 28 24] "point3 from" [3 0 2] "point3 to" [0 0 0]
)" + grey +
    test::quad("-2 -2 0  2 -2 0  2 2 0  -2 2 0") + test::quad("-2 -2 2  2 -2 2  2 2 2  -2 2 2") +
    test::quad("-2 2 0  2 2 0  2 2 2  -2 2 2") + test::quad("-2 -2 0  2 -2 0  2 -2 2  -2 -2 2") +
    test::quad("-2 -2 0  -2 2 0  -2 2 2  -2 -2 2") + test::quad("2 -2 0  2 -1.5 0  2 -1.5 2  2 -2 2") +
    test::quad("2 -.5 0  2 2 0  2 2 2  2 -.5 2") + test::quad("2 -1.5 0  2 -.5 0  2 -.5 1  2 -1.5 1") +
    glass_ball("-1 1 .3", 0.2f) +
    R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [20 15 8]
Translate -.5 1.2 .45
Shape "sphere" "float radius" .03
AttributeEnd
)";

// A spot light that points up lights the floor at (1.5, 0, 0) only via two mirrors. Another one lights it directly.
const std::string two_mirrors = film +
                                R"(LookAt 0 -4 4  .5 0 0  0 0 1
Camera "perspective" "float fov" 45
WorldBegin
)" + grey + test::quad("-3 -2 0  3 -2 0  3 2 0  -3 2 0") +
                                spot("-1 0 .4", "-1 0 2", 20, 8) + spot("2 1 3", "-1 1 0", 20, 40) +
                                R"(Material "conductor" "float roughness" 0
)" + test::quad("-1.3 -.3 1.7  -.7 -.3 2.3  -.7 .3 2.3  -1.3 .3 1.7") +
                                test::quad("1.2 -.3 2.3  1.8 -.3 1.7  1.8 .3 1.7  1.2 .3 2.3");

// A glass ball focuses a spot light in a block of fog.
const std::string fog =
    R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [.1 .1 .1] "rgb sigma_a" [.1 .1 .1]
)" + film +
    R"(LookAt 0 -4 1  0 0 1  0 0 1
Camera "perspective" "float fov" 40
WorldBegin
)" + spot("0 0 3", "0 0 0", 10, 10) +
    glass_ball("0 0 2.2", 0.25f) +
    R"(AttributeBegin
MediumInterface "fog" ""
Material "interface"
Translate 0 0 1
Shape "sphere" "float radius" .9
AttributeEnd
)" + grey +
    test::quad("-2 -2 0  2 -2 0  2 2 0  -2 2 0");

// A glass of water at the edge of a stadium: one photon in ten million hits it.
const std::string lectures = std::string(LANTHORN_SOURCE_DIR) + "/scenes/lectures";
const std::string stadium = R"(Include "stadium.pbrt"
)";

struct Case {
  const char* name;
  std::string scene;
  double caustic;  ///< mean of the layer, by four runs of vcm of 150 passes, 20 000 light paths and a learned guide
  std::uint64_t passes = 8;  ///< of each run
};

const std::vector<Case> cases{{"fifty_lamps", fifty_lamps(1), 3.377e-4},
                              {"fifty_lamps_of_which_47_are_strong", fifty_lamps(100), 3.362e-4},
                              {"fifty_lamps_of_which_47_are_10000_times_as_strong", fifty_lamps(10000), 3.37e-4},
                              {"sunlit_room", sunlit_room, 5.087e-5, 32},
                              {"two_mirrors", two_mirrors, 2.948e-3},
                              {"fog", fog, 3.110e-3}};
const std::vector<Case> long_cases{{"stadium", stadium, 1.935e-2, 32}};

class HiddenCaustic : public testing::TestWithParam<Case> {};

// With one light path per pixel.
std::vector<Image> caustics(const Scene& scene, const std::string& method, std::uint64_t passes) {
  constexpr std::uint64_t runs = 16;
  RenderOptions options = test::options_for(method, passes);
  options.photons = 48 * 36;
  options.resolution = {48, 36};
  return test::select_layers(test::independent_renders(scene, options, runs, 1), "caustic");
}

// The mean over pixels of the variance of a run, divided by the square of the mean.
double relative_variance(const std::vector<Image>& images) {
  const double mean = test::mean_of_means(images).mean();
  double sum = 0;
  for (std::size_t i = 0; i < images.front().pixels.size(); ++i) {
    test::Mean pixel;
    for (const Image& image : images) pixel.add(static_cast<double>(image.pixels[i]));
    sum += pixel.squared_error() * static_cast<double>(images.size());
  }
  return sum / static_cast<double>(images.front().pixels.size()) / sqr(mean);
}

// The radius of few passes darkens the smallest caustics. "auto" uses a quarter of vcm's light paths where more are not
// worth their cost for the whole picture.
TEST_P(HiddenCaustic, IsFoundAlmostAsWellAsByVcm) {
  const Scene scene = test::scene_from_text(GetParam().scene, lectures);
  const std::vector<Image> found = caustics(scene, "auto", GetParam().passes);
  EXPECT_TRUE(test::runs_agree(test::mean_of_means(found), GetParam().caustic, 0.05, 0.6));
  EXPECT_LT(relative_variance(found), 4 * relative_variance(caustics(scene, "vcm", GetParam().passes)));
}
INSTANTIATE_TEST_SUITE_P(Nightly, HiddenCaustic, testing::ValuesIn(long_cases),
                         [](const auto& c) { return c.param.name; });
INSTANTIATE_TEST_SUITE_P(Cases, HiddenCaustic, testing::ValuesIn(cases), [](const auto& c) { return c.param.name; });

// Without a caustic, "auto" is path tracing: the same samples, and the same light.
TEST(HiddenCaustic, WhereThereIsNoneAutoIsPathTracing) {
  const Scene scene = test::scene_from_text(film + R"(LookAt 0 -4 2  0 0 .5  0 0 1
Camera "perspective" "float fov" 50
WorldBegin
)" + grey + test::quad("-2 -2 0  2 -2 0  2 2 0  -2 2 0") +
                                            test::quad("-2 2 0  2 2 0  2 2 2  -2 2 2") +
                                            R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [5 5 5]
Translate 0 0 2
Shape "disk" "float radius" .3
AttributeEnd
)");
  const RenderState found = test::render_state(scene, test::options_for("auto", 4));
  ASSERT_TRUE(found.record.findings);
  EXPECT_EQ(found.record.findings->light_paths_per_pixel, 0);
  const RenderState path = test::render_state(scene, test::options_for("path", 4));
  EXPECT_EQ(select_layer(picture_of(found), "color")->pixels, select_layer(picture_of(path), "color")->pixels);
}

}  // namespace
}  // namespace lanthorn::hidden_caustics_test
