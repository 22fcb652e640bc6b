// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Split-sum shading: exact under a white sky, and near path tracing without visibility where n = v = r.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "lanthorn/ibl.h"
#include "lanthorn/image_file.h"
#include "support/render_scene.h"
#include "support/temporary_dir.h"

namespace lanthorn {
namespace {

const std::string white_sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

// A wide plane, seen from above at an angle from the zenith by parallel rays: every pixel sees the same.
std::string plane(double degrees, const std::string& sky, const std::string& material) {
  const double angle = degrees * 0.017453292519943295;
  return fmt::format(
             "LookAt {} 0 {}  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-0.1 0.1 -0.1 0.1]\n"
             "Film \"rgb\" \"integer xresolution\" [8] \"integer yresolution\" [8]\nWorldBegin\n",
             3 * std::sin(angle), 3 * std::cos(angle)) +
         sky + "Material " + material + "\nShape \"disk\" \"float radius\" [50]\n";
}

std::string metal(double alpha) {
  return fmt::format(
      "\"conductor\" \"rgb reflectance\" [0.9 0.6 0.3] \"float roughness\" [{}] \"bool remaproughness\" false", alpha);
}

Rgb mean_of(const std::string& scene, const std::string& integrator, std::uint64_t passes,
            const std::filesystem::path& folder = ".") {
  RenderOptions options = test::options_for(integrator, passes);
  options.max_depth = 1;
  options.color = ColorMode::rgb;
  const Image image = *select_layer(test::render_image(test::scene_from_text(scene, folder), options), "color");
  Rgb sum;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3)
    sum += Rgb{image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]};
  return (3.0f / static_cast<float>(image.pixels.size())) * sum;
}

class SplitSumShading : public testing::Test {
 protected:
  // Uneven, without anything small and bright: the zenith of the file is +z.
  SplitSumShading() {
    Image image(256, 128, {"R", "G", "B"});
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const float up = std::cos(3.14159265f * (static_cast<float>(y) + 0.5f) / 128),
                    turn = static_cast<float>(x) / 256 * 6.2831853f;
        image.at(x, y, 0) = 1 + up;
        image.at(x, y, 1) = 1 + 0.8f * std::sin(3 * turn) * (1 - up * up);
        image.at(x, y, 2) = up > 0.9f ? 3.0f : 0.5f;
      }
    write_exr(dir_.path() / "sky.exr", image);
  }
  std::string uneven_sky() const { return "LightSource \"infinite\" \"string filename\" \"sky.exr\"\n"; }

  test::TemporaryDir dir_;
};

TEST_F(SplitSumShading, IsExactUnderAWhiteSky) {
  for (const double degrees : {0.0, 50.0})
    for (const double alpha : {0.05, 0.4, 1.0}) {
      const std::string scene = plane(degrees, white_sky, metal(alpha));
      const Rgb found = mean_of(scene, "splitsum", 1), truth = mean_of(scene, "path", 64);
      // Schlick's term is not the metal's own.
      EXPECT_NEAR(found.r, truth.r, 0.02f) << degrees << ' ' << alpha;
      EXPECT_NEAR(found.b, truth.b, 0.04f) << degrees << ' ' << alpha;
    }
}

TEST_F(SplitSumShading, MultipleScatteringKeepsAllLightOfAWhiteMetal) {
  const std::string white =
      "\"conductor\" \"rgb reflectance\" [0.9999 0.9999 0.9999] \"float roughness\" [1] \"bool remaproughness\" false";
  for (const double degrees : {0.0, 60.0}) {
    EXPECT_LT(mean_of(plane(degrees, white_sky, white), "splitsum", 1).g, 0.8f);
    EXPECT_NEAR(mean_of(plane(degrees, white_sky, white), "splitsum:scattering=multiple", 1).g, 1, 5e-3f);
  }
}

TEST_F(SplitSumShading, OfDiffuseSurfacesIsPathTracings) {
  const std::string scene = plane(30, uneven_sky(), "\"diffuse\" \"rgb reflectance\" [0.8 0.5 0.2]");
  const Rgb found = mean_of(scene, "splitsum", 1, dir_.path()), truth = mean_of(scene, "path", 2048, dir_.path());
  EXPECT_NEAR(found.r / truth.r, 1, 0.01f);
  EXPECT_NEAR(found.g / truth.g, 1, 0.01f);
  EXPECT_NEAR(found.b / truth.b, 1, 0.01f);
}

// A sun of 2 x 2 texels of a fine image, turned: its light is neither missed nor counted twice.
TEST_F(SplitSumShading, SeesSmallSuns) {
  constexpr int size = 1024;
  const double irradiance = 4 * 4 * 3.14159265 / (size * size) * 1e5 / 3.14159265;
  for (const int place : {505, 511}) {
    Image image(size, size, {"R", "G", "B"});
    for (const int y : {place, place + 1})
      for (const int x : {place, place + 1})
        for (std::size_t c = 0; c < 3; ++c) image.at(x, y, c) = 1e5f;
    write_exr(dir_.path() / "suns.exr", image);
    const std::string sky =
        "AttributeBegin\nRotate 7 1 0 0\nLightSource \"infinite\" \"string filename\" "
        "\"suns.exr\"\nAttributeEnd\n";
    const Rgb found = mean_of(plane(0, sky, "\"diffuse\" \"rgb reflectance\" [1 1 1]"), "splitsum", 1, dir_.path());
    EXPECT_NEAR(found.g / irradiance, std::cos(0.122), 0.04) << place;
  }
}

// What remains is the Fresnel term, which the separated sum takes for independent of the light.
TEST_F(SplitSumShading, IsNearPathTracingWhereNormalViewAndReflectionAreOne) {
  const auto expect_near = [&](double alpha, float limit) {
    const std::string scene = plane(0, uneven_sky(), metal(alpha));
    const Rgb found = mean_of(scene, "splitsum", 1, dir_.path()), truth = mean_of(scene, "path", 2048, dir_.path());
    EXPECT_NEAR(found.r / truth.r, 1, limit) << alpha;
    EXPECT_NEAR(found.g / truth.g, 1, limit) << alpha;
    EXPECT_NEAR(found.b / truth.b, 1, limit) << alpha;
  };
  // Standard error of path tracing: 0.3 % at most. The levels of the map have roughness k / 6; between them it is
  // interpolated.
  for (const int k : {2, 3, 4}) expect_near(k * k / 36.0, 0.02f);
  for (const double alpha : {0.05, 0.17}) expect_near(alpha, 0.045f);
}

TEST_F(SplitSumShading, OfGlassIsTheTablesReflection) {
  constexpr int size = 128, column = 22;
  const double cos = (column + 0.5) / size, roughness = 64.5 / size;
  const std::string glass =
      fmt::format("\"dielectric\" \"float eta\" [1.5] \"float roughness\" [{}] \"bool remaproughness\" false",
                  roughness * roughness);
  const Image table = brdf_table(size, false);
  EXPECT_NEAR(mean_of(plane(std::acos(cos) / 0.017453292519943295, white_sky, glass), "splitsum", 1).g,
              0.04f * table.at(column, 64, 0) + table.at(column, 64, 1), 2e-3f);
}

TEST_F(SplitSumShading, SaysWhatItLeavesOut) {
  const std::string lamp = "LightSource \"point\" \"rgb I\" [1 1 1]\n";
  const auto plan_of = [](const Scene& scene) { return test::plan_render(scene, test::options_for("splitsum", 1)); };
  const Scene glass = test::scene_from_text(plane(20, white_sky + lamp, "\"dielectric\""));
  RenderPlan plan = plan_of(glass);
  render(glass, plan, plan.stop);
  EXPECT_EQ(plan.integrator->remark(), "splitsum leaves out light through glass");
  EXPECT_EQ(plan.integrator->limitation(glass), "splitsum lights by the environment alone: 1 other light is ignored");
  const Scene clay = test::scene_from_text(plane(20, white_sky, "\"diffuse\""));
  plan = plan_of(clay);
  render(clay, plan, plan.stop);
  EXPECT_EQ(plan.integrator->remark(), "");
  EXPECT_EQ(plan.integrator->limitation(clay), "");
}

}  // namespace
}  // namespace lanthorn
