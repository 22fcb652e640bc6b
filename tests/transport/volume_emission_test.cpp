// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Volumetric emission: against a closed form, and methods against each other.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/runs.h"
#include "support/shapes.h"

namespace lanthorn::volume_emission_test {
namespace {

const std::string film =
    R"(Film "rgb" "integer xresolution" [8] "integer yresolution" [8]
PixelFilter "box" "float xradius" [0.5] "float yradius" [0.5]
)";

RenderOptions options(const std::string& integrator, std::uint64_t passes, std::uint64_t photons = 20'000) {
  RenderOptions o = test::options_for(integrator, passes, 1);
  o.color = ColorMode::rgb;
  o.max_depth = 16;
  o.photons = integrator == "mlt" ? 2'500 : photons;
  if (test::has_radius(integrator)) o.set["radius"] = "0.05";
  if (test::has_parameter(integrator, "volume-radius")) o.set["volume-radius"] = "0.05";
  return o;
}

// A ball that emits uniformly and transmits all light illuminates its outside like a point light at its centre:
// irradiance behaves like the gravity of a uniform ball (Newton's shell theorem). The camera looks down on a square
// metre of the floor, from under the ball.
TEST(VolumeEmission, ThinBallLightsThePlane) {
  const double height = 2, radius = 0.2, emission = 100, reflectance = 0.6, pi_d = 3.14159265358979;
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 1 0  0 0 0  0 0 1
Camera "orthographic" "float screenwindow" [-0.5 0.5 -0.5 0.5]
)" + film +
      R"(WorldBegin
MakeNamedMedium "flame" "string type" "homogeneous" "rgb sigma_a" [1e-4 1e-4 1e-4] "rgb sigma_s" [0 0 0] "rgb Le" [1e6 1e6 1e6]
AttributeBegin
MediumInterface "flame" ""
Material "interface"
Translate 0 2 0
Shape "sphere" "float radius" [0.2]
AttributeEnd
Material "diffuse" "rgb reflectance" [0.6 0.6 0.6]
)" + test::patch("-1 0 1  1 0 1  -1 0 -1  1 0 -1"));
  const double volume = 4 / 3.0 * pi_d * std::pow(radius, 3);
  double expected = 0;
  constexpr int steps = 64;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < steps; ++k) {
      const double x = (i + 0.5) / steps - 0.5, y = (k + 0.5) / steps - 0.5;
      const double d2 = x * x + y * y + height * height;
      expected += reflectance / pi_d * emission * volume * height / (d2 * std::sqrt(d2)) / steps / steps;
    }
  const std::vector<std::pair<std::string, std::uint64_t>> passes_by_noise = {
      {"path", 2}, {"light", 2}, {"bdpt", 2}, {"vcm", 2}, {"bpm", 8}, {"probppm", 2}, {"photonmap", 2}, {"mlt", 8}};
  for (const auto& [integrator, passes] : passes_by_noise) {
    const auto color =
        test::select_layers(test::independent_renders(scene, options(integrator, passes), 32, 1), "color");
    EXPECT_TRUE(test::runs_agree(test::mean_of_means(color), expected, 0.003, 0.05, test::false_alarm_rate / 8))
        << integrator;
  }
}

/// Compares a layer by Welch's t-test per tile.
void expect_agreement(const Scene& scene, const std::vector<std::string>& integrators, std::uint64_t passes,
                      const std::vector<std::string>& layers = {"color"}) {
  const std::vector<Image> path = test::independent_renders(scene, options("path", 8 * passes), 32, 100);
  const double rate = test::false_alarm_rate / static_cast<double>(integrators.size() * layers.size());
  for (const std::string& integrator : integrators) {
    const std::vector<Image> found = test::independent_renders(scene, options(integrator, passes, 7'000), 32, 200);
    for (const std::string& layer : layers)
      EXPECT_TRUE(test::tiles_agree(test::select_layers(found, layer), test::select_layers(path, layer), rate))
          << integrator << ' ' << layer;
  }
}

const std::string room = R"(Material "diffuse" "rgb reflectance" [0.7 0.6 0.8]
)" + test::patch("-1 0 1  1 0 1  -1 0 -1  1 0 -1") +
                         test::patch("-1 2 1  1 2 1  -1 2 -1  1 2 -1") +
                         test::patch("-1 0 -1  1 0 -1  -1 2 -1  1 2 -1");
const std::string camera = R"(LookAt 0 0.4 3  0 0.4 0  0 1 0
Camera "perspective" "float fov" [14]
)";

// A thick coloured ball that scatters and emits, above the view. Half of it lies in another ball that only absorbs.
TEST(NightlyVolumeEmission, BallInARoom) {
  const Scene scene = test::scene_from_text(camera + film +
                                            R"(WorldBegin
MakeNamedMedium "flame" "string type" "homogeneous" "rgb sigma_a" [0.5 1 2] "rgb sigma_s" [1 2 0.5] "float g" [0.4] "rgb Le" [6 4 3]
MakeNamedMedium "smoke" "string type" "homogeneous" "rgb sigma_a" [0.3 0.2 0.1] "rgb sigma_s" [0 0 0]
AttributeBegin
Translate 0.1 1.3 0
Material "interface"
MediumInterface "flame" "smoke"
Shape "sphere" "float radius" [0.3]
MediumInterface "smoke" ""
Shape "sphere" "float radius" [0.4]
AttributeEnd
)" + room);
  EXPECT_EQ(scene.lights().size(), 1u);
  EXPECT_FALSE(scene.has_unlit_emission());
  expect_agreement(
      scene, {"light", "bdpt", "vcm", "bpm", "probppm", "sppm", "ppm", "photonmap", "reversephotonmap", "mlt"}, 1);
}

// A flame above a ball of glass, both above the view: its caustic on the floor, which every method can find.
TEST(VolumeEmission, CausticOfAFlame) {
  const Scene scene = test::scene_from_text(camera + film +
                                            R"(WorldBegin
AttributeBegin
Translate 0.2 1.62 0
MakeNamedMedium "flame" "string type" "uniformgrid" "point3 p0" [-0.2 -0.3 -0.2] "point3 p1" [0.2 0.3 0.2] "integer nx" 1 "integer ny" 3 "integer nz" 2 "float density" [1 2 0 3 0.5 0] "rgb sigma_a" [1 1 2] "rgb sigma_s" [0.5 0.2 0.1] "rgb Le" [60 30 10]
MediumInterface "flame" ""
Material "interface"
Shape "sphere" "float radius" [0.37]
AttributeEnd
AttributeBegin
Material "dielectric"
Translate 0.1 1 0.1
Shape "sphere" "float radius" [0.22]
AttributeEnd
)" + room);
  expect_agreement(scene, {"light", "bdpt", "vcm", "probppm", "sppm", "photonmap"}, 2, {"color", "caustic"});
}

// Unbounded emissive fog is not a light. Eye paths find its emission; in photon methods, they do so in addition to
// gathering the photons of other lights.
TEST(VolumeEmission, FogWithoutEndIsFoundByEyePaths) {
  const Scene scene = test::scene_from_text(
      R"(MediumInterface "" "fog"
)" + camera +
      film +
      R"(WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0.1 0.1 0.2] "rgb sigma_s" [0.1 0.2 0.1] "rgb Le" [1 2 3]
MediumInterface "" "fog"
LightSource "point" "rgb I" [2 2 2] "point3 from" [0 1.5 0]
)" + room);
  EXPECT_EQ(scene.lights().size(), 1u);
  EXPECT_TRUE(scene.has_unlit_emission());
  expect_agreement(scene, {"light", "bdpt", "vcm", "auto", "probppm", "photonmap"}, 1, {"color", "media"});
}

}  // namespace
}  // namespace lanthorn::volume_emission_test
