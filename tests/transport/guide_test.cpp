// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Guided sampling where it should help: a room lit by a spot light via a small area of a wall.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lanthorn/metrics.h"
#include "support/runs.h"
#include "support/spotlit_room.h"

namespace lanthorn::guide_test {
namespace {

std::vector<Image> renders_of(const std::string& integrator, std::uint64_t runs, std::uint64_t passes,
                              const char* layer) {
  const Scene scene = test::scene_from_text(test::spotlit_room);
  RenderOptions options = test::options_for(integrator, passes);
  options.color = ColorMode::rgb;
  options.photons = 20'000;
  options.max_depth = 6;
  return test::select_layers(test::independent_renders(scene, options, runs, 0), layer);
}

// Variance of pixels, averaged over the picture.
double variance_of(const std::vector<Image>& images) {
  double variance = 0;
  const std::size_t n = images[0].pixels.size();
  for (std::size_t i = 0; i < n; ++i) {
    test::Mean pixel;
    for (const Image& image : images) pixel.add(static_cast<double>(image.pixels[i]));
    variance += pixel.squared_error() * pixel.count() / static_cast<double>(n);
  }
  return variance;
}

// The ratio is 0.26 with a standard deviation of 0.02 over seeds.
TEST(Guide, LessensNoiseOfPaths) {
  const double alone = variance_of(renders_of("path", 6, 16, "indirect")),
               guided = variance_of(renders_of("path:guide=photons", 6, 16, "indirect"));
  EXPECT_TRUE(test::below(guided / alone, 0.5));
}

TEST(Guide, LessensNoiseOfFinalGathering) {
  const std::string gather = "photonmap:max-radius=0.1:gather=4";
  const double alone = variance_of(renders_of(gather + ":guide=none", 6, 4, "term.D")),
               guided = variance_of(renders_of(gather + ":guide=photons", 6, 4, "term.D"));
  EXPECT_TRUE(test::below(guided / alone, 0.5));
}

// Both renders use the same photons, so they differ in little but the directions: the standard error of the ratio is
// 0.5 %.
TEST(Guide, LeavesTheMeanOfFinalGathering) {
  const std::string gather = "photonmap:max-radius=0.1:gather=64";
  const std::vector<Image> alone = renders_of(gather + ":guide=none", 16, 1, "term.D"),
                           guided = renders_of(gather + ":guide=photons", 16, 1, "term.D");
  EXPECT_TRUE(test::runs_agree(test::paired_ratio(guided, alone), 1, 0, 0.15));
}

}  // namespace
}  // namespace lanthorn::guide_test
