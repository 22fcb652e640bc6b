// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/convergence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/render_scene.h"

namespace lanthorn::convergence_test {
namespace {

const std::string scene_text = R"(
LookAt 0 0 3  0 0 0  0 1 0
Camera "perspective" "float fov" [60]
Film "rgb" "integer xresolution" [3] "integer yresolution" [2]
WorldBegin
LightSource "infinite" "rgb L" [1 2 3]
Material "diffuse" "rgb reflectance" [0.2 0.5 0.8]
Shape "sphere"
)";

struct Expected {
  double deviation = 0, bias = 0, error = 0;
};

// For renders with consecutive seeds: the bias without the contribution of noise.
Expected expected_of(const std::vector<Image>& renders, const Image& reference) {
  const auto runs = static_cast<double>(renders.size()), values = static_cast<double>(reference.pixels.size());
  double variance = 0, bias2 = 0, error2 = 0;
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    const auto truth = static_cast<double>(reference.pixels[i]);
    double mean = 0, squares = 0;
    for (const Image& image : renders) mean += static_cast<double>(image.pixels[i]) / runs;
    for (const Image& image : renders) {
      squares += std::pow(static_cast<double>(image.pixels[i]) - mean, 2);
      error2 += std::pow(static_cast<double>(image.pixels[i]) - truth, 2) / (runs * values);
    }
    variance += squares / (runs - 1) / values;
    bias2 += std::pow(mean - truth, 2) / values;
  }
  return {std::sqrt(variance), std::sqrt(bias2 - variance / runs), std::sqrt(error2)};
}

// Splats are means over the passes as well.
RenderOptions options(std::uint64_t passes, std::uint64_t seed) {
  RenderOptions result = test::options_for("bdpt", passes, seed);
  result.photons = 100;
  return result;
}

TEST(Convergence, IsMeasuredByItsDefinition) {
  const Scene scene = test::scene_from_text(scene_text);
  constexpr std::uint64_t runs = 3, first_seed = 5;
  const auto render = [&](std::uint64_t passes, std::uint64_t seed) {
    return *select_layer(test::render_image(scene, options(passes, seed)), "color");
  };
  Image reference = render(1, 100);
  for (float& x : reference.pixels) x *= 2;
  std::vector<Expected> expected;
  for (const std::uint64_t passes : {1, 2, 4}) {
    std::vector<Image> renders;
    for (std::uint64_t run = 0; run < runs; ++run) renders.push_back(render(passes, first_seed + run));
    expected.push_back(expected_of(renders, reference));
  }
  const auto measure = [&](std::uint64_t fit_from) {
    ConvergenceSettings settings;
    settings.runs = runs;
    settings.fit_from = fit_from;
    return measure_convergence(scene, scene.description().view, options(5, first_seed), settings, reference);
  };
  const Convergence all = measure(1), last_two = measure(2), last = measure(4);
  ASSERT_EQ(all.points.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(all.points[i].passes, std::uint64_t{1} << i);
    EXPECT_NEAR(all.points[i].deviation, expected[i].deviation, 1e-9);
    EXPECT_NEAR(*all.points[i].bias, expected[i].bias, 1e-9);
    EXPECT_NEAR(*all.points[i].error, expected[i].error, 1e-9);
  }
  // A least-squares line through points at 0, 1 and 2 is determined by the outer two.
  const auto slope = [](double from, double to, double octaves) { return std::log2(to / from) / octaves; };
  EXPECT_NEAR(*all.variance_slope, 2 * slope(expected[0].deviation, expected[2].deviation, 2), 1e-6);
  EXPECT_NEAR(*all.bias_slope, slope(expected[0].bias, expected[2].bias, 2), 1e-6);
  EXPECT_NEAR(*last_two.variance_slope, 2 * slope(expected[1].deviation, expected[2].deviation, 1), 1e-6);
  EXPECT_NEAR(*last_two.bias_slope, slope(expected[1].bias, expected[2].bias, 1), 1e-6);
  EXPECT_FALSE(last.variance_slope);
}

}  // namespace
}  // namespace lanthorn::convergence_test
