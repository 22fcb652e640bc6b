// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reverse photon mapping equals photon mapping for equal photons, rays and radii.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "lanthorn/error.h"
#include "lanthorn/metrics.h"
#include "support/open_box.h"
#include "support/runs.h"
#include "support/shapes.h"
#include "support/varied_room.h"

namespace lanthorn::reversephotonmap_test {
namespace {

const std::string box = test::camera + test::box;
// Shading normals far from the facets', a translucent sheet, and a hair.
const std::string shapes =
    R"(Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  0 1 0.5] "normal N" [0 0 1  0.7 0 0.7  0 0.7 0.7]
Shape "curve" "float width" [0.2] "point3 P" [-0.5 0.1 0.4  -0.4 0.5 0.4  0 0.6 0.4  0.4 0.5 0.4]
Material "diffusetransmission" "rgb reflectance" [0.4 0.2 0.2] "rgb transmittance" [0.3 0.3 0.3]
)" + test::patch("-0.8 0.3 0.2  -0.2 0.3 0.2  -0.8 1 0.3  -0.2 1 0.3");

RenderOptions options_of(const std::string& integrator, ColorMode color, std::uint64_t passes = 1) {
  RenderOptions options = test::options_for(integrator, passes, 3);
  options.color = color;
  options.photons = 20'000;
  options.max_depth = 6;
  return options;
}

/// Sixteen renders.
std::vector<Image> runs(const Scene& scene, const std::string& integrator, std::uint64_t passes, const char* layer,
                        std::uint64_t first_seed = 100) {
  const RenderOptions options = options_of(integrator, ColorMode::rgb, passes);
  return test::select_layers(test::independent_renders(scene, options, 16, first_seed), layer);
}

void expect_equal_pictures(const std::string& text, const std::string& parameters, ColorMode color) {
  const Scene scene = test::scene_from_text(text);
  const std::string both = ":nearest=0:caustic-nearest=0:gather=6:" + parameters;
  const Image forward = test::render_image(scene, options_of("photonmap:irradiance=estimated" + both, color));
  const Image reverse = test::render_image(scene, options_of("reversephotonmap" + both, color));
  ASSERT_EQ(forward.pixels.size(), reverse.pixels.size());
  for (std::size_t i = 0; i < forward.pixels.size(); ++i)
    ASSERT_NEAR(reverse.pixels[i], forward.pixels[i], 1e-4 * std::fabs(forward.pixels[i]) + 1e-6)
        << parameters << ", value " << i;
}

// All layers and terms, for every pixel.
TEST(ReversePhotonMap, IsPhotonMapWithTheSameRadii) {
  for (const ColorMode color : {ColorMode::rgb, ColorMode::spectral}) {
    expect_equal_pictures(test::varied_room, "max-radius=0.2", color);
    expect_equal_pictures(box + shapes, "max-radius=0.1", color);
  }
}

TEST(ReversePhotonMap, KnowsAllKernels) {
  for (const char* kernel : {"box", "cone", "gaussian"})
    expect_equal_pictures(box, std::string("max-radius=0.07:kernel=") + kernel, ColorMode::rgb);
}

// The smallest --memory that is accepted: it leaves nothing for blocks of pixels.
std::uint64_t least_memory(const Scene& scene, RenderOptions options) {
  std::uint64_t refused = 0, accepted = std::uint64_t{1} << 30;
  while (accepted - refused > 1) {
    options.memory = (refused + accepted) / 2;
    try {
      test::plan_render(scene, options);
      accepted = *options.memory;
    } catch (const Error&) {
      refused = *options.memory;
    }
  }
  return accepted;
}

TEST(ReversePhotonMap, MemoryIsNotInThePicture) {
  const Scene scene = test::scene_from_text(test::varied_room);
  for (const char* integrator : {"reversephotonmap", "reversephotonmap:radii=leaf"}) {
    RenderOptions options = options_of(integrator, ColorMode::spectral, 2);
    const std::vector<std::byte> whole = encode_state(test::render_state(scene, options));
    // Blocks of one pixel, and of a few pixels that leave a remainder at the picture's sides.
    const std::uint64_t least = least_memory(scene, options);
    for (const std::uint64_t memory : {least, least + 700'000}) {
      options.memory = memory;
      EXPECT_EQ(whole, encode_state(test::render_state(scene, options))) << integrator << ", " << memory;
    }
  }
}

// A photon's light is spread over its own disc, so that the rule for the disc's size does not change the total. The
// floor has no edges at which light could be lost: light spread beyond the lit part is still on it.
TEST(ReversePhotonMap, RadiiSpreadAllLight) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 4 0.1  0 0 0  0 1 0
Camera "perspective" "float fov" [90]
Film "rgb" "integer xresolution" [16] "integer yresolution" [16]
WorldBegin
LightSource "spot" "rgb I" [9 9 9] "point3 from" [0 2 0] "point3 to" [0 0 0] "float coneangle" [30]
Material "diffuse" "rgb reflectance" [0.7 0.7 0.7]
)" + test::patch("-9 0 -9  9 0 -9  -9 0 9  9 0 9") +
      test::patch("-9 9 -9  9 9 -9  -9 9 9  9 9 9"));
  const std::vector<Image> fixed = runs(scene, "reversephotonmap:nearest=0:max-radius=0.05:gather=64", 1, "term.D");
  EXPECT_GT(test::mean_of_means(fixed).mean(), 1e-4);
  for (const char* radii : {"nearest", "leaf"}) {
    const std::string integrator = std::string("reversephotonmap:max-radius=0.5:gather=64:radii=") + radii;
    EXPECT_TRUE(test::runs_agree(test::paired_ratio(runs(scene, integrator, 1, "term.D"), fixed), 1, 0.005, 0.2,
                                 test::false_alarm_rate / 2))
        << radii;
  }
}

// The radii are small and there are many photons, so the mean must agree with path.
TEST(ReversePhotonMap, AgreesWithPath) {
  const Scene scene = test::scene_from_text(box);
  const test::Mean expected = test::mean_of_means(runs(scene, "path", 16, "indirect"));
  for (const char* radii : {"nearest", "leaf"}) {
    const std::string integrator = std::string("reversephotonmap:max-radius=0.04:gather=4:radii=") + radii;
    EXPECT_TRUE(test::runs_agree(test::mean_of_means(runs(scene, integrator, 4, "indirect", 200)), expected, 0.01, 0.12,
                                 test::false_alarm_rate / 2))
        << radii;
  }
}

}  // namespace
}  // namespace lanthorn::reversephotonmap_test
