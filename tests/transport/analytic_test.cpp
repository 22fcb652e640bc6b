// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scenes with closed-form radiance, by every integrator that can find their paths, at limited depths.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/runs.h"

namespace lanthorn::analytic_test {
namespace {

struct AnalyticScene {
  std::string name;
  std::string text;
  /// Radiance of every pixel with at most `depth` scatterings (grey).
  double (*radiance)(int depth);
};

// Inside a diffuse sphere of albedo 1/2 that emits 1/2: sum over k <= depth of emission * albedo^k.
double furnace(int depth) { return 0.5 * (1 - std::pow(0.5, depth + 1)) / (1 - 0.5); }
// A point light of intensity pi in the middle of a unit sphere of albedo 1/2: irradiance pi, so 1/2 after one
// scattering, and each further scattering adds half of the previous term.
double lit_sphere(int depth) { return depth == 0 ? 0 : 0.5 * (1 - std::pow(0.5, depth)) / (1 - 0.5); }
// A convex diffuse body of albedo 0.7 under a uniform sky of radiance 1.
double under_sky(int depth) { return depth == 0 ? 0 : 0.7; }

const char* const camera =
    R"(Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" [16] "integer yresolution" [16]
PixelFilter "box" "float xradius" [0.5] "float yradius" [0.5]
WorldBegin
)";

std::vector<AnalyticScene> scenes() {
  return {{"furnace",
           std::string("LookAt 0 0 0.3  0 0 -1  0 1 0\n") + camera +
               R"(AreaLightSource "diffuse" "rgb L" [0.5 0.5 0.5]
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
ReverseOrientation
Shape "sphere"
)",
           furnace},
          {"point light in a sphere",
           std::string("LookAt 0 0 0.3  0 0 -1  0 1 0\n") + camera +
               R"(LightSource "point" "rgb I" [3.14159265 3.14159265 3.14159265]
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "sphere"
)",
           lit_sphere},
          {"disk under a uniform sky",
           std::string("LookAt 0 0 2  0 0 0  0 1 0\n") + camera +
               R"(LightSource "infinite" "rgb L" [1 1 1]
Material "diffuse" "rgb reflectance" [0.7 0.7 0.7]
Shape "disk" "float radius" [1.5]
)",
           under_sky}};
}

struct Case {
  AnalyticScene scene;
  std::string integrator;
  ColorMode color;
  int depth;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const AnalyticScene& scene : scenes())
    for (const char* integrator :
         {"path", "light", "probppm", "sppm", "ppm", "bdpt", "bpm", "vcm", "auto", "mlt", "mlt:over=path"})
      for (const ColorMode color : {ColorMode::rgb, ColorMode::spectral})
        for (const int depth : {2, 3, 5})
          if ((color == ColorMode::spectral) == (depth == 3)) all.push_back({scene, integrator, color, depth});
  return all;
}

RenderOptions options_of(const Case& c) {
  // Where a pass keeps light paths, eye paths share its wavelengths: the tint averages out only over several passes.
  const bool shares_wavelengths = c.integrator != "path" && c.integrator != "light";
  const bool is_tinted = shares_wavelengths && c.color == ColorMode::spectral;
  RenderOptions options = test::options_for(c.integrator, is_tinted ? 6 : shares_wavelengths ? 2 : 1);
  options.color = c.color;
  options.max_depth = c.depth;
  options.photons = shares_wavelengths && c.integrator != "bpm" ? 5'000 : 20'000;
  if (is_tinted) options.photons = *options.photons / 2;
  if (options.integrator == "mlt") options.photons = 2'500;
  if (test::has_radius(c.integrator)) options.set["radius"] = "0.05";
  return options;
}

class Analytic : public testing::TestWithParam<Case> {};

// The 0.4 % allow for upsampling of greys and, in photon methods, the radius.
TEST_P(Analytic, RadianceIsRight) {
  const Case& c = GetParam();
  const Scene scene = test::scene_from_text(c.scene.text);
  const auto images = test::select_layers(test::independent_renders(scene, options_of(c), 32, 0), "color");
  EXPECT_TRUE(test::runs_agree(test::mean_of_means(images), c.scene.radiance(c.depth), 0.004, 0.15));
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  return test::identifier(info.param.scene.name + "_" + info.param.integrator +
                          (info.param.color == ColorMode::rgb ? "_rgb_" : "_spectral_") +
                          std::to_string(info.param.depth));
}

INSTANTIATE_TEST_SUITE_P(Scenes, Analytic, testing::ValuesIn(cases()), case_name);

}  // namespace
}  // namespace lanthorn::analytic_test
