// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Curves so wide that the light across them is seen. Flat curves face every ray, so that light paths and eye paths meet
// different surfaces; all methods must see the same light at each place across the width.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/runs.h"

namespace lanthorn::wide_curves_test {
namespace {

// The curve covers the rows 8 to 24 of 32, exactly. All is turned: along an axis rounding is exact, and no connection
// along a hair would be off its direction.
const std::string view =
    R"(LookAt 0 0 5  0 0 0  0 1 0
Rotate 37 1 2 3
Camera "orthographic" "float screenwindow" [-.2 .2 -.2 .2]
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
PixelFilter "box" "float xradius" .5 "float yradius" .5
WorldBegin
Rotate -37 1 2 3
)";
constexpr int first_row = 8, rows = 16;

std::string curve(const std::string& type) {
  return R"(Shape "curve" "string type" ")" + type +
         R"(" "point3 P" [-1 0 0  -.3 0 0  .3 0 0  1 0 0] "float width" .2)" +
         (type == "ribbon" ? R"( "normal N" [0 0 1  0 0 1]
)"
                           : "\n");
}
const std::string sky = R"(LightSource "infinite"
)";
const std::string white_hair = R"(Material "hair" "rgb sigma_a" [0 0 0] "float beta_m" .3 "float beta_n" .3
)";
const std::string red_hair = R"(Material "hair" "rgb sigma_a" [.3 .6 1] "float beta_m" .7 "float beta_n" .7
)";

// Means of the bands across the curve, from below to above, over independent renders.
std::vector<test::Mean> bands_of(const Scene& scene, const std::string& method, std::uint64_t passes,
                                 std::uint64_t runs, int bands) {
  RenderOptions options = test::options_for(method, passes);
  options.photons = 1024;
  std::vector<test::Mean> means(static_cast<std::size_t>(bands));
  for (const Image& image : test::select_layers(test::independent_renders(scene, options, runs, 1), "color"))
    for (int band = 0; band < bands; ++band) {
      double sum = 0;
      const int height = rows / bands;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < image.width; ++x)
          for (std::size_t c = 0; c < 3; ++c)
            sum += static_cast<double>(image.at(x, first_row + rows - 1 - band * height - y, c));
      means[static_cast<std::size_t>(band)].add(sum / (3.0 * image.width * height));
    }
  return means;
}

struct Furnace {
  const char *name, *method;
  std::string material, type;
  double radiance;
};

class WideCurves : public testing::TestWithParam<Furnace> {};

// Under an even sky, a curve that absorbs nothing looks like the sky everywhere, a matte one has its reflectance.
TEST_P(WideCurves, LookEvenUnderAnEvenSky) {
  const Furnace& p = GetParam();
  const Scene scene = test::scene_from_text(view + sky + p.material + curve(p.type));
  constexpr int bands = 4;
  constexpr std::uint64_t runs = 16;
  const std::uint64_t passes = std::string(p.method) == "light" ? 256 : 24;
  for (const test::Mean& band : bands_of(scene, p.method, passes, runs, bands))
    EXPECT_TRUE(test::runs_agree(band, p.radiance, 0.01, 0.2, test::sidak(test::false_alarm_rate, bands)));
}

std::vector<Furnace> furnaces() {
  std::vector<Furnace> all;
  const std::string matte = R"(Material "diffuse" "rgb reflectance" [.6 .6 .6]
)";
  // Light paths alone find narrow lobes by chance only.
  const std::string rough_hair = R"(Material "hair" "rgb sigma_a" [0 0 0] "float beta_m" .8 "float beta_n" .8
)";
  for (const char* method : {"light", "bdpt", "vcm"}) {
    const std::string& hair = std::string(method) == "light" ? rough_hair : white_hair;
    all.push_back({"flat_hair", method, hair, "flat", 1});
    all.push_back({"round_hair", method, hair, "cylinder", 1});
    all.push_back({"ribbon_of_hair", method, hair, "ribbon", 1});
    all.push_back({"flat_matte", method, matte, "flat", .6});
  }
  return all;
}
INSTANTIATE_TEST_SUITE_P(Methods, WideCurves, testing::ValuesIn(furnaces()), [](const auto& test_info) {
  return std::string(test_info.param.name) + "_" + test_info.param.method;
});

// Light from one side, and a lamp whose distance is ten widths: the bands differ by factors.
TEST(WideCurve, MethodsSeeTheSameProfile) {
  const std::string lights =
      R"(LightSource "distant" "point3 from" [.2 1 .4] "point3 to" [0 0 0] "rgb L" [2 2 2]
AttributeBegin AreaLightSource "diffuse" "rgb L" [30 30 30] Translate .5 -2 .5 Shape "sphere" "float radius" .3 AttributeEnd
)";
  for (const std::string type : {"flat", "ribbon"}) {
    const Scene scene = test::scene_from_text(view + lights + red_hair + curve(type));
    constexpr int bands = 2;
    const std::vector<test::Mean> seen = bands_of(scene, "path", 16, 16, bands);
    for (const char* method : {"light", "bdpt", "vcm"}) {
      if (type == "ribbon" && std::string(method) == "light") continue;  // too noisy to tell
      const std::vector<test::Mean> found =
          bands_of(scene, method, std::string(method) == "light" ? 128 : 32, 16, bands);
      for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_TRUE(test::runs_agree(found[i], seen[i], 0.01, 0.25, test::sidak(test::false_alarm_rate, 12)))
            << type << " by " << method << ", band " << i;
    }
  }
}

// The hair's surface reflects like a mirror: where light comes from 60 degrees beside the eye, the highlight is where
// the normal of a round hair points between both, at half of its radius, on the side of the light.
TEST(WideCurve, HighlightsAreOnTheSideOfTheLight) {
  const std::string light = R"(LightSource "distant" "point3 from" [0 .866025 .5] "point3 to" [0 0 0]
)";
  const std::string dark = R"(Material "hair" "rgb sigma_a" [90 90 90] "float beta_n" .15 "float alpha" 0
)";
  for (const std::string type : {"flat", "cylinder", "ribbon"}) {
    const Scene scene = test::scene_from_text(view + light + dark + curve(type));
    const std::vector<test::Mean> bands = bands_of(scene, "path", 4, 2, rows);
    const auto brightest = std::max_element(
        bands.begin(), bands.end(), [](const test::Mean& a, const test::Mean& b) { return a.mean() < b.mean(); });
    const double offset = 2 * (static_cast<double>(brightest - bands.begin()) + .5) / rows - 1;
    EXPECT_NEAR(offset, .5, .15) << type;
  }
}

}  // namespace
}  // namespace lanthorn::wide_curves_test
