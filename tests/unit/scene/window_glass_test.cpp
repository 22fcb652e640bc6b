// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/scene_text.h"
#include "surface/thin_dielectric.h"

namespace lanthorn::window_glass_test {
namespace {

const std::string patch = R"(Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]
)";
const std::string box_4_mm_thick =
    R"(Shape "trianglemesh" "integer indices" [0 1 2 1 3 2  4 6 5 5 6 7  0 4 1 1 4 5  2 3 6 3 7 6  0 2 4 2 6 4  1 5 3 3 5 7]
 "point3 P" [-1 -1 0  1 -1 0  -1 1 0  1 1 0  -1 -1 .004  1 -1 .004  -1 1 .004  1 1 .004]
)";

SceneDescription description_of(const std::string& directives) {
  const std::string head = R"(Film "rgb" "integer xresolution" 8 "integer yresolution" 8
WorldBegin
)";
  return read_pbrt_string(head + directives, ".", "test scene");
}

std::string patch_at(float height, float side = 1) {
  return "AttributeBegin\nTranslate 0 0 " + std::to_string(height) + "\nScale " + std::to_string(side) + " 1 1\n" +
         patch + "AttributeEnd\n";
}

// Fraction of rays that pass from height `from` to a height 3 above it at an angle of incidence with this cosine.
double passing(const Scene& scene, double cos, float from = -1) {
  const auto c = static_cast<float>(cos);
  const Direction direction(std::sqrt(1 - c * c), 0, c);
  constexpr int rays = 20'000;
  int passed = 0;
  HashRng rng(1);
  for (int i = 0; i < rays; ++i) {
    const Point through(0.4f * rng.next(), 0.4f * rng.next(), 0);
    passed += scene.visible({through + (from / c) * direction, direction, 3 / c, 0}) ? 1 : 0;
  }
  return static_cast<double>(passed) / rays;
}
// With 20,000 rays, one standard deviation is at most .0035.
constexpr double tolerance = 0.018;

Scene scene_with_panes(const std::string& directives, std::size_t panes) {
  SceneDescription description = description_of(directives);
  EXPECT_EQ(replace_window_glass(description), panes) << directives;
  return Scene(std::move(description));
}

double of_face(double cos, float eta = 1.5f) {
  return static_cast<double>(fresnel_dielectric(static_cast<float>(cos), eta).reflectance);
}

// Light that passes parallel faces without absorption, by adding one face after the other: of the light that passes the
// stack so far, with reflectance r from behind, the new face with reflectance f passes (1 - f) Σ (f r)^k.
double through(const std::vector<double>& faces) {
  double passed = 1, back = 0;  // of the stack so far: transmittance and reflectance
  for (const double f : faces) {
    const double echo = 1 / (1 - f * back);
    const double reflected = f + (1 - f) * (1 - f) * back * echo;  // seen from behind the new face
    passed *= (1 - f) * echo;
    back = reflected;
  }
  return passed;
}

TEST(WindowGlass, LetsRaysPassStraightAndReflectsTheRest) {
  struct Case {
    std::string material, shape;
  };
  for (const Case& c : {Case{R"(Material "thindielectric"
)",
                             patch},
                        Case{R"(Material "dielectric"
)",
                             box_4_mm_thick}}) {
    SceneDescription description = description_of(c.material + c.shape);
    EXPECT_EQ(replace_window_glass(description), 1u);
    const Scene scene(std::move(description));
    for (const float cos : {1.0f, 0.7f, 0.4f}) {
      const double face = of_face(cos);
      EXPECT_NEAR(passing(scene, static_cast<double>(cos)), through({face, face}), tolerance) << c.material << cos;
    }
  }
}

TEST(WindowGlass, KnowsTwoFacesOfOneSheet) {
  const std::string glass = R"(Material "dielectric"
)";
  SceneDescription window = description_of(glass + patch_at(0) + patch_at(0.004f));
  EXPECT_EQ(replace_window_glass(window), 2u);
  EXPECT_NEAR(passing(Scene(std::move(window)), 0.7), through({of_face(.7), of_face(.7)}), tolerance);
  // Not a window: too far apart, different sizes, both in one plane, different glass.
  for (const std::string& others : {patch_at(0) + patch_at(0.5f), patch_at(0) + patch_at(0.004f, 0.8f),
                                    patch_at(0) + patch_at(0), patch_at(0) + R"(Material "dielectric" "float eta" 1.6
)" + patch_at(0.004f)}) {
    SceneDescription description = description_of(glass + others);
    EXPECT_EQ(replace_window_glass(description), 0u) << others;
  }
}

std::string raised(const std::string& shapes, float height) {
  return "AttributeBegin\nTranslate 0 0 " + std::to_string(height) + "\n" + shapes + "AttributeEnd\n";
}

// Rays pass panes one behind another with the light that the panes reflect to and fro.
TEST(WindowGlass, PanesOfOneWindowReflectBetweenEachOther) {
  const std::string slab = R"(Material "dielectric"
)" + box_4_mm_thick,
                    sheet = R"(Material "thindielectric"
)" + patch;
  const std::string dense = R"(Material "dielectric" "float eta" 2.2
)" + box_4_mm_thick;
  struct Case {
    std::string directives;
    std::size_t panes;
    std::vector<float> etas;  // of all faces
  };
  const std::string three = slab + raised(slab, .05f) + raised(slab, -.1f);
  for (const Case& c :
       {Case{slab + raised(slab, .1f), 2, {1.5f, 1.5f, 1.5f, 1.5f}},
        Case{sheet + raised(sheet, .1f), 2, {1.5f, 1.5f, 1.5f, 1.5f}},
        Case{sheet + raised(dense, .1f), 2, {1.5f, 1.5f, 2.2f, 2.2f}}, Case{three, 3, std::vector<float>(6, 1.5f)},
        Case{"Rotate 180 1 0 0 " + three, 3, std::vector<float>(6, 1.5f)},
        Case{R"(ObjectBegin "o" )" + three + R"(ObjectEnd Scale 1 1 -1 ObjectInstance "o"
)",
             3, std::vector<float>(6, 1.5f)},
        Case{R"(Material "dielectric"
)" + patch_at(0) +
                 patch_at(.004f) + patch_at(.05f) + patch_at(.054f),
             4, std::vector<float>(4, 1.5f)}}) {
    const Scene scene = scene_with_panes(c.directives, c.panes);
    for (const double cos : {1.0, .5, .3}) {
      std::vector<double> faces;
      for (const float eta : c.etas) faces.push_back(of_face(cos, eta));
      EXPECT_NEAR(passing(scene, cos), through(faces), tolerance) << c.directives << cos;
    }
  }
  // The value of ../shared/cases/two-panes-60.pbrt.
  EXPECT_NEAR(passing(scene_with_panes(slab + raised(slab, .1f), 2), .5), .718556, tolerance);
}

TEST(WindowGlass, RaysFromBetweenPanesMeetThePanesBeforeThem) {
  const std::string slab = R"(Material "dielectric"
)" + box_4_mm_thick;
  const Scene scene = scene_with_panes(slab + raised(slab, .1f), 2);
  const double f = of_face(.5);
  EXPECT_NEAR(passing(scene, .5, .05f), through({f, f}), tolerance);
  // Light that a face has reflected leaves on the side it came from: it passes all other faces of the window.
  for (const float face : {0.0f, .004f, .1f, .104f}) EXPECT_EQ(passing(scene, .5, face), 1) << face;
}

TEST(WindowGlass, PanesFarApartOrAtAnAngleAreTwoWindows) {
  const std::string slab = R"(Material "dielectric"
)" + box_4_mm_thick;
  const double one = through({of_face(.5), of_face(.5)});
  EXPECT_NEAR(passing(scene_with_panes(slab + raised(slab, .25f), 2), .5), one * one, tolerance);
  const std::string leaning = "AttributeBegin Rotate 3 0 1 0 Translate 0 0 .1\n" + slab + "AttributeEnd\n";
  const double leant = of_face(std::cos(std::acos(.5) - 3 * std::numbers::pi / 180));
  EXPECT_NEAR(passing(scene_with_panes(slab + leaning, 2), .5), one * through({leant, leant}), tolerance);
}

TEST(WindowGlass, SaysWhichPanesStayAsTheyAre) {
  const std::string two_faces = patch_at(0) + patch_at(.004f);
  const std::string medium = R"(MakeNamedMedium "m" "string type" "homogeneous"
)";
  struct Case {
    std::string directives, message;
  };
  const std::string rest =
      "; only panes of clear, smooth glass let all rays pass. Methods with photons find the light "
      "behind the others";
  for (const Case& c : {Case{R"(Material "dielectric" "float roughness" .1
)" + box_4_mm_thick,
                             "this pane stays as before, because its glass is rough"},
                        Case{R"(Material "thindielectric" "spectrum eta" "glass-BK7"
)" + patch,
                             "this pane stays as before, because its glass has dispersion"},
                        Case{medium + R"(MediumInterface "m" "" Material "dielectric"
)" + two_faces,
                             "2 panes stay as before, because their glass has a medium inside"},
                        Case{R"(AreaLightSource "diffuse" Material "dielectric"
)" + box_4_mm_thick,
                             "this pane stays as before, because its glass emits light"}}) {
    SceneDescription description = description_of(c.directives);
    EXPECT_EQ(replace_window_glass(description), 0u) << c.directives;
    ASSERT_EQ(description.warnings.size(), 1u) << c.directives;
    EXPECT_EQ(description.warnings[0].message, "--window-glass: " + c.message + rest);
    EXPECT_GT(description.warnings[0].location.line, 2);
  }
  SceneDescription tinted = description_of(R"(Material "dielectric"
)" + box_4_mm_thick);
  std::get<description::DielectricMaterial>(tinted.materials.at(tinted.shapes[0].material).node).tint =
      description::SpectrumParameter{description::RgbSpectrum{{.5f, .9f, .5f}}, {}};
  EXPECT_EQ(replace_window_glass(tinted), 0u);
  ASSERT_EQ(tinted.warnings.size(), 1u);
  EXPECT_NE(tinted.warnings[0].message.find("its glass is tinted"), std::string::npos);
}

TEST(WindowGlass, LeavesWhatIsNoWindow) {
  for (const std::string& directives : {std::string(R"(Material "dielectric"
Shape "sphere"
)"),
                                        R"(Material "dielectric"
)" + patch,
                                        R"(Material "thindielectric" "spectrum eta" "glass-BK7"
)" + patch,
                                        patch}) {
    SceneDescription description = description_of(directives);
    EXPECT_EQ(replace_window_glass(description), 0u) << directives;
  }
  SceneDescription rough = description_of(R"(Material "dielectric" "float roughness" .1
)" + box_4_mm_thick);
  EXPECT_EQ(replace_window_glass(rough), 0u);
}

}  // namespace
}  // namespace lanthorn::window_glass_test
