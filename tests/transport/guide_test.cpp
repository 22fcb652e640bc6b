// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Guided sampling where it should help: a room that a spotlight lights by way of a small place on a wall.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "film/metrics.h"
#include "support/render_scene.h"
#include "support/spotlit_room.h"

namespace lanthorn {
namespace {

struct Estimate {
  double mean = 0, variance = 0;  ///< of pixels: mean over the picture
};

Estimate estimate_of(const std::string& integrator, std::uint64_t passes, const char* layer) {
  constexpr int runs = 6;
  const Scene scene = test::scene_from_text(test::spotlit_room);
  std::vector<Image> images;
  for (std::uint64_t run = 0; run < runs; ++run) {
    RenderOptions options = test::options_for(integrator, passes, run);
    options.color = ColorMode::rgb;
    options.photons = 20'000;
    options.max_depth = 6;
    images.push_back(*select_layer(test::render_image(scene, options), layer));
  }
  Estimate result;
  const std::size_t n = images[0].pixels.size();
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0, squares = 0;
    for (const Image& image : images) {
      sum += static_cast<double>(image.pixels[i]);
      squares += sqr(static_cast<double>(image.pixels[i]));
    }
    result.mean += sum / runs / static_cast<double>(n);
    result.variance += (squares - sum * sum / runs) / (runs - 1) / static_cast<double>(n);
  }
  return result;
}

TEST(Guide, LessensNoiseOfPaths) {
  const Estimate alone = estimate_of("path", 16, "indirect"),
                 guided = estimate_of("path:guide=photons", 16, "indirect");
  EXPECT_LT(guided.variance, 0.5 * alone.variance);
}

// Of the same photons, so that little but the directions differs.
TEST(Guide, LessensNoiseOfFinalGatheringAndLeavesTheMean) {
  const std::string gather = "photonmap:max-radius=0.1:gather=4";
  const Estimate alone = estimate_of(gather + ":guide=none", 8, "term.D"),
                 guided = estimate_of(gather + ":guide=photons", 8, "term.D");
  EXPECT_LT(guided.variance, 0.5 * alone.variance);
  EXPECT_NEAR(guided.mean / alone.mean, 1, 0.01);
}

}  // namespace
}  // namespace lanthorn
