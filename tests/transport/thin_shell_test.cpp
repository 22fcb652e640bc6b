// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Shells thinner than the radius: light inside must not leak through.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "lanthorn/image.h"
#include "support/render_scene.h"

namespace lanthorn::thin_shell_test {
namespace {

// A black lamp between two discs, such as one close below a ceiling without thickness; the camera sees the middle of
// the front disc from outside. The discs face the same way, unless `turns_front` turns the front one away.
std::string two_sheets(const std::string& turns_front) {
  return R"(LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" [12]
Film "rgb" "integer xresolution" [16] "integer yresolution" [16]
WorldBegin
Material "diffuse" "rgb reflectance" [0.8 0.8 0.8]
AttributeBegin
)" + turns_front +
         R"(Shape "disk" "float radius" [1]
AttributeEnd
AttributeBegin
Translate 0 0 0.01
Shape "disk" "float radius" [1]
AttributeEnd
AreaLightSource "diffuse" "rgb L" [1000 1000 1000]
Material "diffuse" "rgb reflectance" [0 0 0]
Translate 0 0 0.005
Shape "sphere" "float radius" [0.004]
)";
}

void set_radius(RenderOptions& options, const std::string& integrator, const std::string& radius) {
  options.set.emplace(integrator.ends_with("photonmap") ? "max-radius" : "radius", radius);
}

TEST(ThinShell, IsDarkOutside) {
  const std::vector<std::string> integrators{"probppm", "sppm", "ppm", "vcm", "bpm", "photonmap", "reversephotonmap"};
  for (const char* turns_front : {"", "ReverseOrientation\n"}) {
    const Scene scene = test::scene_from_text(two_sheets(turns_front));
    for (const ColorMode color : {ColorMode::rgb, ColorMode::spectral})
      for (const std::string& integrator : integrators) {
        RenderOptions options = test::options_for(integrator, 1);
        options.color = color;
        options.photons = 20'000;
        set_radius(options, integrator, "0.1");
        const Image picture = *select_layer(test::render_image(scene, options), "color");
        EXPECT_EQ(*std::max_element(picture.pixels.begin(), picture.pixels.end()), 0) << integrator;
      }
  }
}

// Two halves of a floor with normals that face opposite ways: no seam, as if both faced up.
TEST(ThinShell, HalvesOfAFloorMayFaceEitherWay) {
  const auto floor = [](const char* of_right) {
    const auto half = [](const char* from, const char* to, const std::string& normal) {
      const std::string x0 = from, x1 = to;
      return R"(Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [)" + x0 + " 0 -4 " + x1 + " 0 -4 " +
             x1 + " 0 4 " + x0 + R"( 0 4] "normal N" [)" + normal + normal + normal + normal + "]\n";
    };
    return R"(LookAt 1.5 1.5 0  0 0 0  0 0 1
Camera "perspective" "float fov" [12]
Film "rgb" "integer xresolution" [16] "integer yresolution" [16]
WorldBegin
Material "diffuse" "rgb reflectance" [0.8 0.8 0.8]
AttributeBegin
LightSource "spot" "rgb I" [20 20 20] "point3 from" [0 1 0] "point3 to" [0 2 0]
Translate 0 2 0
Rotate 90 1 0 0
Shape "disk" "float radius" [0.5]
AttributeEnd
)" + half("-4", "0", "0 1 0 ") +
           half("0", "4", of_right);
  };
  for (const std::string integrator : {"probppm", "vcm", "photonmap"}) {
    RenderOptions options = test::options_for(integrator, 1);
    options.photons = 20'000;
    set_radius(options, integrator, "0.3");
    if (integrator == "photonmap") options.set.insert({{"show", "global"}, {"nearest", "0"}});
    options.set.emplace("emission", "power");
    const Image same = test::render_image(test::scene_from_text(floor("0 1 0 ")), options);
    const Image turned = test::render_image(test::scene_from_text(floor("0 -1 0 ")), options);
    const Image a = *select_layer(same, "color"), b = *select_layer(turned, "color");
    double difference = 0, sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
      difference += std::fabs(static_cast<double>(a.pixels[i] - b.pixels[i]));
      sum += static_cast<double>(a.pixels[i]);
    }
    EXPECT_GT(sum, 0) << integrator;
    EXPECT_LT(difference, 0.02 * sum) << integrator << ": the same photons, but for those that met the floor twice";
  }
}

}  // namespace
}  // namespace lanthorn::thin_shell_test
