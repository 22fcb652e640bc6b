// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Occluders a fifth of a millimetre in front of a lamp, and lamps far from the origin: the light on a floor, by every
// kind of method. Methods could agree on a wrong value, so the expected values are independent.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "support/runs.h"

namespace lanthorn::shadow_ends_test {
namespace {

struct Case {
  const char* scene;
  double floor;  // mean radiance of the picture
};

// The first two expected values were measured with the stencil or pane at 1 mm, where all methods of other renderers
// agree. A fifth of a millimetre is 7e-5 of the distance. The third is the same lamp at the origin, whose centre is
// .0500 analytically.
const Case stencil{"stencil-at-lamp", .0850}, pane{"pane-at-lamp", .1695}, far_away{"lamp-10km-away", .04135};

class ShadowEnds : public testing::TestWithParam<const char*> {};

void expect_light(const Case& expected, const std::string& integrator) {
  const Scene scene(read_scene(std::string(LANTHORN_SOURCE_DIR "/tests/scenes/") + expected.scene + ".pbrt"));
  RenderOptions options = test::options_for(integrator, integrator == "mlt" ? 64 : 16);
  options.photons = 20000;
  const test::Mean found =
      test::mean_of_means(test::select_layers(test::independent_renders(scene, options, 4, 1), "color"));
  const double noise = 4 * found.error() / expected.floor;
  EXPECT_NEAR(found.mean() / expected.floor, 1, std::max(.03, noise)) << expected.scene << " by " << integrator;
  EXPECT_LT(noise, .2);  // the error tested for is a factor of two
}

TEST_P(ShadowEnds, StencilBeforeALampCastsItsShadow) { expect_light(stencil, GetParam()); }
TEST_P(ShadowEnds, LightPassesAPaneBeforeALampOnce) { expect_light(pane, GetParam()); }
TEST_P(ShadowEnds, LampsFarFromTheOriginLightAsMuch) { expect_light(far_away, GetParam()); }

INSTANTIATE_TEST_SUITE_P(Methods, ShadowEnds,
                         testing::Values("path", "light", "bdpt", "vcm", "auto", "probppm", "mlt"));

}  // namespace
}  // namespace lanthorn::shadow_ends_test
