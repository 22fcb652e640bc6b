// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Metropolis light transport where the properties of chains matter: as few and short as possible, and their noise.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "lanthorn/convergence.h"
#include "support/runs.h"

namespace lanthorn::metropolis_test {
namespace {

// A point light of intensity pi at the centre of a unit sphere of albedo 1/2: radiance 1/2 after one scattering event,
// and half as much after each further one.
Scene lit_sphere(int side) {
  return test::scene_from_text(fmt::format(R"(
LookAt 0 0 0.3  0 0 -1  0 1 0
Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" [{0}] "integer yresolution" [{0}]
PixelFilter "box" "float xradius" [0.5] "float yradius" [0.5]
WorldBegin
LightSource "point" "rgb I" [3.14159265 3.14159265 3.14159265]
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "sphere"
)",
                                           side));
}

// In each pass, one chain of two mutations, seeded from a bootstrap of two paths: if the chain did not start in
// proportion to the light, or if a state of chain or bootstrap had a wrong weight, one of the layers would show it.
void expect_unbiased_layers(const std::string& integrator) {
  const Scene scene = lit_sphere(2);
  RenderOptions options = test::options_for(integrator + ":chain-length=2:bootstrap=1", 2000);
  options.max_depth = 3;
  options.photons = 2;
  const std::vector<Image> images = test::independent_renders(scene, options, 32, 0);
  const std::map<const char*, double> expected{{"direct", 0.5}, {"indirect", 0.25 + 0.125}};
  for (const auto& [layer, radiance] : expected)
    EXPECT_TRUE(test::runs_agree(test::mean_of_means(test::select_layers(images, layer)), radiance, 0.002, 0.1,
                                 test::false_alarm_rate / 4))
        << integrator << ", " << layer;
}

TEST(NightlyMetropolis, ShortChainsAreUnbiased) {
  expect_unbiased_layers("mlt");
  expect_unbiased_layers("mlt:over=path");
}

// Variance of a pixel over renders with this many passes and mutations.
double variance(const std::string& integrator, std::uint64_t passes, std::uint64_t mutations) {
  const Scene scene = lit_sphere(4);
  RenderOptions options = test::options_for(integrator, passes);
  options.max_depth = 3;
  options.photons = mutations;
  ConvergenceSettings settings;
  settings.runs = 96;
  return std::pow(measure_convergence(scene, scene.description().view, options, settings, {}).points.back().deviation,
                  2);
}

// Over 32 runs, the exponents had a standard deviation of 0.2, so over 96 it is 0.12.
TEST(Metropolis, NoiseFallsWithPassesAndChains) {
  const std::string chains = "mlt:chain-length=32:bootstrap=0.5";
  const double one = variance(chains, 1, 64);
  EXPECT_TRUE(test::within(std::log2(variance(chains, 32, 64) / one), -5, 0.75));
  EXPECT_TRUE(test::within(std::log2(variance(chains, 1, 64 * 32) / one), -5, 0.75));
}

// Chains with only large steps draw independent paths; chains with hardly any stay where they are: the ratio is 0.016
// to 0.02.
TEST(Metropolis, LargeStepsForget) {
  const auto with_large_steps = [](const char* share) {
    return variance(fmt::format("mlt:chain-length=256:sigma=1e-6:large-steps={}", share), 8, 256);
  };
  EXPECT_TRUE(test::below(with_large_steps("1") / with_large_steps("0.001"), 0.2));
}

}  // namespace
}  // namespace lanthorn::metropolis_test
