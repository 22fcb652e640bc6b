// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Pixel filters with negative lobes: pixels are right from the first pass on, whatever the method.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "film/filter.h"
#include "integrators/integrator.h"
#include "support/render_scene.h"
#include "support/runs.h"
#include "support/statistics.h"

namespace lanthorn::filter_lobes_test {
namespace {

const std::vector<std::string> filters{
    R"("mitchell" "float xradius" 2 "float yradius" 2)",
    R"("mitchell" "float xradius" 2 "float yradius" 2 "float B" 0 "float C" .5)",  // Catmull & Rom
    R"("sinc" "float xradius" 4 "float yradius" 4)", R"("sinc" "float xradius" 3 "float yradius" 2 "float tau" 2)",
    R"("gaussian" "float xradius" 1.5 "float yradius" 1.5)"};

// A pixel is one unit wide, and the film is `columns` by `rows` pixels.
constexpr int columns = 16, rows = 32;
Scene scene_with(const std::string& filter, const std::string& world) {
  return test::scene_from_text(fmt::format(R"(
LookAt 0 0 -10  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [{} {} {} {}]
Film "rgb" "integer xresolution" {} "integer yresolution" {}
PixelFilter {}
WorldBegin
{})",
                                           -columns / 2, columns / 2, -rows / 2, rows / 2, columns, rows, filter,
                                           world));
}

// The sky fills the picture. A sphere behind the camera gives photon methods a surface.
TEST(FilterLobes, AConstantPictureIsConstantByEveryMethodFromTheFirstPass) {
  for (const std::string& filter : filters) {
    const Scene scene = scene_with(filter, R"(
LightSource "infinite" "rgb L" [.5 .5 .5]
Translate 0 0 -40
Shape "sphere" "float radius" 1)");
    for (const IntegratorInfo& info : integrator_registry()) {
      if (info.name == "splitsum") continue;  // it shades surfaces only
      for (const std::uint64_t passes : {1u, 2u, 3u, 5u, 9u}) {
        RenderOptions options = test::options_for(info.name, passes);
        options.photons = 200;
        const Image image = test::render_image(scene, options);
        for (std::size_t i = 0; i < image.pixels.size(); i += image.channel_count())
          for (std::size_t c = 0; c < 3; ++c)
            ASSERT_NEAR(image.pixels[i + c], 0.5f, 1e-6f) << info.name << ' ' << filter << ' ' << passes;
      }
    }
  }
}

// Black to the left of x = -.3, white to the right.
const char* const a_step = R"(
LightSource "infinite" "rgb L" [1 1 1]
Material "diffuse" "rgb reflectance" [0 0 0]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-90 -90 0  -.3 -90 0  -.3 90 0  -90 90 0])";

// Beside a step, the picture is darker than black where the filter has lobes.
TEST(FilterLobes, BelongToThePictureOfEveryMethod) {
  for (const std::string& filter : filters) {
    const Scene scene = scene_with(filter, a_step);
    const bool has_lobes = scene.description().view.filter.kind != description::FilterKind::gaussian;
    for (const char* method : {"path", "bdpt", "probppm", "ppm"}) {
      RenderOptions options = test::options_for(method, 32);
      if (std::string(method) == "ppm") options.set["hits"] = "16";
      const Image image = test::render_image(scene, options);
      float least = 1;
      for (int x = 0; x < columns; ++x) {
        float sum = 0;
        for (int y = 0; y < rows; ++y) sum += image.at(x, y, 0);
        least = std::min(least, sum / rows);
      }
      EXPECT_EQ(least < -0.01f, has_lobes) << method << ' ' << filter;
    }
  }
}

// The picture of a step is the filter's integral from the step on,
// which is below 0 and above 1 beside it. The limit of the passes is far beyond the first sample of the lobes, from
// which on the estimate is unbiased.
TEST(FilterLobes, AStepIsTheIntegralOfTheFilter) {
  constexpr double step = 7.7;
  for (std::size_t f = 0; f < filters.size(); ++f) {
    const Scene scene = scene_with(filters[f], a_step);
    const Image image = test::render_image(scene, test::options_for("path", 512, f));
    const Filter filter(filter_shape(scene.description().view.filter));
    double least = 1;
    for (int x = 0; x < columns; ++x) {
      const double radius = static_cast<double>(filter.radius().x), from = step - (x + 0.5);
      constexpr int steps = 20000;
      double beyond = 0, all = 0;
      for (int i = 0; i < steps; ++i) {
        const double t = (2 * (i + 0.5) / steps - 1) * radius;
        const auto value = static_cast<double>(filter.evaluate({static_cast<float>(t), 0}));
        all += value;
        if (t >= from) beyond += value;
      }
      test::Mean mean;
      for (int y = 0; y < rows; ++y) mean.add(static_cast<double>(image.at(x, y, 0)));
      least = std::min(least, mean.mean());
      const double expected = beyond / all;
      const double allowed =
          test::t_limit(test::false_alarm_rate / (columns * static_cast<double>(filters.size())), mean.count() - 1) *
          mean.error();
      EXPECT_LE(allowed, 0.05) << "too noisy to tell";
      EXPECT_TRUE(test::within(mean.mean(), expected, allowed + 1e-3)) << filters[f] << ", column " << x;
    }
    EXPECT_EQ(least<-0.01, filter.negative_share()> 0) << filters[f];
  }
}

// The scene of issue 64: white sun on a grey floor.
TEST(FilterLobes, AFloorUnderTheSunHasNoBlackPixels) {
  for (const std::string& filter : filters) {
    const Scene scene = scene_with(filter, R"(
LightSource "distant" "point3 from" [0 0 -1] "point3 to" [0 0 0] "rgb L" [1 1 1] "float scale" 3.14159265
Material "diffuse" "rgb reflectance" [.5 .5 .5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-90 -90 0  90 -90 0  90 90 0  -90 90 0])");
    for (const std::uint64_t passes : {1u, 2u, 4u, 7u}) {
      const Image image = test::render_image(scene, test::options_for("path", passes));
      for (std::size_t i = 0; i < image.pixels.size(); i += image.channel_count())
        ASSERT_NEAR(image.pixels[i], 0.5f, 1e-5f) << filter << ' ' << passes;
    }
  }
}

}  // namespace
}  // namespace lanthorn::filter_lobes_test
