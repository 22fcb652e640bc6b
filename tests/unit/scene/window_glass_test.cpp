// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/scene_text.h"
#include "surface/thin_dielectric.h"

namespace lanthorn::window_glass_test {
namespace {

const std::string patch = "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]\n";
const std::string box_4_mm_thick =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2  4 6 5 5 6 7  0 4 1 1 4 5  2 3 6 3 7 6  0 2 4 2 6 4  1 5 "
    "3 3 "
    "5 7]\n \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0  -1 -1 .004  1 -1 .004  -1 1 .004  1 1 .004]\n";

SceneDescription description_of(const std::string& directives) {
  const std::string head = "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n";
  return read_pbrt_string(head + directives, ".", "test scene");
}

std::string patch_at(float height, float side = 1) {
  return "AttributeBegin\nTranslate 0 0 " + std::to_string(height) + "\nScale " + std::to_string(side) + " 1 1\n" +
         patch + "AttributeEnd\n";
}

// Fraction of rays that pass at an angle of incidence with this cosine.
double passing(const Scene& scene, double cos) {
  const auto c = static_cast<float>(cos);
  const Direction direction(std::sqrt(1 - c * c), 0, c);
  constexpr int rays = 20'000;
  int passed = 0;
  HashRng rng(1);
  for (int i = 0; i < rays; ++i) {
    const Point through(0.4f * rng.next(), 0.4f * rng.next(), 0);
    passed += scene.visible({through - direction, direction, 3, 0}) ? 1 : 0;
  }
  return static_cast<double>(passed) / rays;
}

TEST(WindowGlass, LetsRaysPassStraightAndReflectsTheRest) {
  struct Case {
    std::string material, shape;
    bool thin;
  };
  for (const Case& c :
       {Case{"Material \"thindielectric\"\n", patch, true}, Case{"Material \"dielectric\"\n", box_4_mm_thick, false}}) {
    SceneDescription description = description_of(c.material + c.shape);
    EXPECT_EQ(replace_window_glass(description), 1u);
    const Scene scene(std::move(description));
    for (const float cos : {1.0f, 0.7f, 0.4f}) {
      // Rays cross two faces of a slab. Light reflected between them is left to walks, not to shadow rays.
      const double face = static_cast<double>(fresnel_dielectric(cos, 1.5f).reflectance);
      const double expected =
          c.thin ? 1 - static_cast<double>(thin_reflectance({1.5f}, cos)[0]) : (1 - face) * (1 - face);
      EXPECT_NEAR(passing(scene, static_cast<double>(cos)), expected, 0.015) << c.material << cos;
    }
  }
}

TEST(WindowGlass, KnowsTwoFacesOfOneSheet) {
  const std::string glass = "Material \"dielectric\"\n";
  SceneDescription window = description_of(glass + patch_at(0) + patch_at(0.004f));
  EXPECT_EQ(replace_window_glass(window), 2u);
  const double face = static_cast<double>(fresnel_dielectric(0.7f, 1.5f).reflectance);
  EXPECT_NEAR(passing(Scene(std::move(window)), 0.7), (1 - face) * (1 - face), 0.015);
  // Not a window: too far apart, different sizes, both in one plane, different glass.
  for (const std::string& others :
       {patch_at(0) + patch_at(0.5f), patch_at(0) + patch_at(0.004f, 0.8f), patch_at(0) + patch_at(0),
        patch_at(0) + "Material \"dielectric\" \"float eta\" 1.6\n" + patch_at(0.004f)}) {
    SceneDescription description = description_of(glass + others);
    EXPECT_EQ(replace_window_glass(description), 0u) << others;
  }
}

TEST(WindowGlass, LeavesWhatIsNoWindow) {
  for (const std::string& directives :
       {std::string("Material \"dielectric\"\nShape \"sphere\"\n"), "Material \"dielectric\"\n" + patch,
        "Material \"thindielectric\" \"spectrum eta\" \"glass-BK7\"\n" + patch, patch}) {
    SceneDescription description = description_of(directives);
    EXPECT_EQ(replace_window_glass(description), 0u) << directives;
  }
  SceneDescription rough = description_of("Material \"dielectric\" \"float roughness\" .1\n" + box_4_mm_thick);
  EXPECT_EQ(replace_window_glass(rough), 0u);
}

}  // namespace
}  // namespace lanthorn::window_glass_test
