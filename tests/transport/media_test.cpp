// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Light in participating media against known integrals, and integrators against each other.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "integrators/integrator.h"
#include "lanthorn/metrics.h"
#include "lanthorn/scene.h"
#include "lanthorn/threads.h"
#include "render/state.h"
#include "scene/medium_around.h"
#include "support/edited.h"
#include "support/runs.h"
#include "support/shapes.h"

namespace lanthorn::media_test {
namespace {

const std::string film =
    R"(Film "rgb" "integer xresolution" [8] "integer yresolution" [8]
PixelFilter "box" "float xradius" [0.5] "float yradius" [0.5]
)";

std::string fog(const std::string& coefficients, const std::string& type = "homogeneous") {
  return R"(MakeNamedMedium "fog" "string type" ")" + type + "\" " + coefficients + "\n";
}

RenderOptions options(const std::string& integrator, std::uint64_t passes) {
  RenderOptions o = test::options_for(integrator, passes, 1);
  o.color = ColorMode::rgb;
  o.max_depth = 64;
  o.photons = 20'000;
  return o;
}

std::vector<Image> runs(const Scene& scene, const RenderOptions& o, std::uint64_t first_seed) {
  return test::select_layers(test::independent_renders(scene, o, 32, first_seed), "color");
}

test::Mean mean(const Scene& scene, const RenderOptions& o) { return test::mean_of_means(runs(scene, o, 1)); }

// A ball of purely scattering fog under light of radiance 1 from everywhere is invisible.
TEST(Media, WhiteFurnace) {
  const Scene scene = test::scene_from_text(R"(LookAt 0 0 3  0 0 0  0 1 0
Camera "perspective" "float fov" [30]
)" + film + "WorldBegin\n" + fog(R"("rgb sigma_a" [0 0 0] "rgb sigma_s" [2 1 0.5] "float g" [0.4])") +
                                            R"(LightSource "infinite" "rgb L" [1 1 1]
MediumInterface "fog" ""
Material "interface"
Shape "sphere"
)");
  for (const char* integrator : {"path", "probppm"})
    EXPECT_TRUE(test::runs_agree(mean(scene, options(integrator, 8)), 1, 0, 0.05, test::false_alarm_rate / 2));
}

// White media in a white world are invisible, however dense: light scatters hundreds of times in them, for which the
// default limit of scattering events must be high enough. A limit of 64 darkens this ball to .84. (vcm is correct, too,
// but needs a hundred times as many passes to show it.)
TEST(Media, WhiteFurnaceOfMilk) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 0 -8  0 0 0  0 1 0
Camera "perspective" "float fov" [8]
)" + film +
      "WorldBegin\n" + fog(R"("rgb sigma_a" [0 0 0] "rgb sigma_s" [40 40 40])") +
      R"(LightSource "infinite" "rgb L" [1 1 1]
Material "interface"
MediumInterface "fog" ""
Shape "sphere" "float radius" .8
)");
  const auto expect_white = [&](const std::string& integrator, double noise) {
    RenderOptions o = test::options_for(integrator, 8, 1);
    o.photons = 16'000;
    EXPECT_TRUE(test::runs_agree(mean(scene, o), 1, 0.01, noise, test::false_alarm_rate / 2)) << integrator;
  };
  expect_white("path", 0.05);
  expect_white("probppm", 0.1);
}

// The light that the limit of scattering events cuts off is counted, independent of threads and shards.
TEST(Media, CutPathsAreCounted) {
  const Scene scene = test::scene_from_text(R"(LookAt 0 0 3  0 0 0  0 1 0
Camera "perspective" "float fov" [30]
)" + film + "WorldBegin\n" + fog(R"("rgb sigma_a" [0 0 0] "rgb sigma_s" [20 20 20])") +
                                            R"(LightSource "infinite" "rgb L" [1 1 1]
MediumInterface "fog" ""
Material "interface"
Shape "sphere"
)");
  RenderOptions o = options("path", 64);
  o.max_depth = 8;
  const RenderState state = test::render_state(scene, o);
  // The limit removes exactly the light of the paths that reach it; as all light comes from a world of radiance 1, the
  // loss is known.
  const double mean = test::mean_of(*select_layer(picture_of(state), "color"));
  EXPECT_EQ(state.eye.paths, 64u * 64u);
  EXPECT_GT(mean, 0.3);
  EXPECT_NEAR(mean + state.eye.share(), 1, 0.03);
  EXPECT_EQ(summarize(state).cut_share, state.eye.share());
  {
    const ThreadLimit limit(1);
    EXPECT_EQ(test::render_state(scene, o).eye.cut, state.eye.cut);
  }
  o.passes.reset();
  o.pass_range = {0, 20};
  const RenderState first = test::render_state(scene, o);
  o.pass_range = {20, 64};
  const RenderState all = merge_states(first, test::render_state(scene, o));
  EXPECT_EQ(all.eye.cut, state.eye.cut);
  EXPECT_EQ(decode_state(encode_state(all), "a.state").eye.cut, state.eye.cut);
}

// The light of a narrow beam seen in thin fog, from the integral of single scattering over the beam. Next-event
// estimation at scattering points finds it with one path in fifty.
TEST(Media, NarrowBeamInThinFog) {
  const std::string scene_text =
      R"(Film "rgb" "integer xresolution" 24 "integer yresolution" 2
PixelFilter "box"
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [.05 .05 .05] "rgb sigma_a" [0 0 0]
MediumInterface "" "fog"
LookAt 0 0 -8  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-2.8 -.4 -.1 .1]
WorldBegin
AttributeBegin
MediumInterface "" "fog"
LightSource "spot" "point3 from" [-3 0 0] "point3 to" [0 0 0] "float coneangle" 3 "float conedeltaangle" .01 "float scale" 1000
AttributeEnd
AttributeBegin
MediumInterface "fog" ""
Material "interface"
Shape "sphere" "float radius" 10
AttributeEnd
)";
  // For a pixel: sigma_s / (4 pi) I / d² exp(-sigma (d + z)) over the chord of the cone, averaged over the pixel.
  constexpr double sigma = 0.05, intensity = 1000, cone = 3 * 3.14159265358979 / 180;
  double expected = 0;
  constexpr int steps = 400;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double x = 0.2 + 2.4 * (i + 0.5) / steps, y = -0.1 + 0.2 * (j + 0.5) / steps;
      const double half2 = x * x * std::pow(std::tan(cone), 2) - y * y;
      if (half2 <= 0) continue;
      constexpr int depths = 8;
      const double half = std::sqrt(half2);
      for (int k = 0; k < depths; ++k) {
        const double z = half * (2 * (k + 0.5) / depths - 1), d = std::sqrt(x * x + y * y + z * z);
        expected += 2 * half / depths * sigma / (4 * 3.14159265358979) * intensity / (d * d) *
                    std::exp(-sigma * (d + 8 + z)) / (steps * steps);
      }
    }
  const Scene scene = test::scene_from_text(scene_text);
  for (const char* integrator : {"path", "probppm", "sppm", "ppm", "photonmap", "reversephotonmap", "vcm", "bdpt"}) {
    RenderOptions o = test::options_for(integrator, 16, 1);
    o.color = ColorMode::rgb;
    o.max_depth = 1;
    o.photons = 1'000;
    if (test::has_radius(integrator)) o.set["radius"] = "0.1";
    if (o.integrator == "vcm") o.set["volume-radius"] = "0.03";  // of a beam of .01 to .3
    const std::uint64_t runs = o.integrator == "ppm" ? 32 : 16;  // the noisiest
    const auto images = test::select_layers(test::independent_renders(scene, o, runs, 1), "color");
    EXPECT_TRUE(test::runs_agree(test::mean_of_means(images), expected, 0.002, 0.12, test::false_alarm_rate / 8))
        << integrator;
  }
}

// The camera sees an emitter of radiance 1 through a metre of absorber, at normal incidence in the middle of the film.
Scene lamp_behind(const std::string& medium) {
  return test::scene_from_text(
      R"(LookAt 0 0 3  0 0 0  0 1 0
Camera "perspective" "float fov" [0.05]
)" + film +
      "WorldBegin\n" + medium +
      R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [1 1 1] "bool twosided" true
Translate 0 0 -2
Shape "disk"
AttributeEnd
MediumInterface "fog" ""
Material "interface"
Shape "sphere" "float radius" [0.5]
)");
}

TEST(Media, BeersLaw) {
  const Scene scene = lamp_behind(fog(R"("rgb sigma_a" [0.7 0.7 0.7] "rgb sigma_s" [0 0 0])"));
  EXPECT_NEAR(mean(scene, options("path", 1)).mean(), std::exp(-0.7), 1e-4);
}

// A grid of equal values is the same medium, except for half a cell at each end, where the density falls linearly to
// half.
TEST(Media, BeersLawOnGrids) {
  const std::string grid =
      R"("point3 p0" [-0.5 -0.5 -0.5] "point3 p1" [0.5 0.5 0.5] "integer nx" 1 "integer ny" 1 "integer nz" 4 )";
  const double expected = std::exp(-1.4 * (1 - 2 * 0.25 * 0.5 / 4));
  const Scene uniform = lamp_behind(
      fog(grid + R"("float density" [2 2 2 2] "rgb sigma_a" [0.7 0.7 0.7] "rgb sigma_s" [0 0 0])", "uniformgrid"));
  const double rate = test::false_alarm_rate / 2;
  EXPECT_TRUE(test::runs_agree(mean(uniform, options("path", 64)), expected, 0.002, 0.1, rate));
  const Scene coloured = lamp_behind(fog(grid + R"("rgb sigma_a" [0.7 0.7 0.7  0.7 0.7 0.7  0.7 0.7 0.7  0.7 0.7 0.7] )"
                                                R"("rgb sigma_s" [0 0 0  0 0 0  0 0 0  0 0 0] )"
                                                R"("float scale" 2)",
                                         "rgbgrid"));
  EXPECT_TRUE(test::runs_agree(mean(coloured, options("path", 64)), expected, 0.002, 0.1, rate));
}

// Single scattering of a point light in an infinite medium, along the camera's axis: the integral of sigma_s / (4 pi) I
// / d² exp(-sigma_t (t + d)) over t.
TEST(Media, SingleScattering) {
  const double sigma_t = 0.5, sigma_s = 0.3, height = 1, intensity = 2, reach = 2;
  const Scene scene = test::scene_from_text(
      R"(MediumInterface "" "fog"
LookAt 0 0 0  0 0 -1  0 1 0
Camera "perspective" "float fov" [0.1]
)" + film +
      "WorldBegin\n" + fog(R"("rgb sigma_a" [0.2 0.2 0.2] "rgb sigma_s" [0.3 0.3 0.3])") +
      R"(MediumInterface "" "fog"
LightSource "point" "rgb I" [2 2 2] "point3 from" [0 1 -1]
Material "diffuse" "rgb reflectance" [0 0 0]
Translate 0 0 -2
Shape "disk"
)");
  double expected = 0;
  constexpr int steps = 10'000;
  for (int i = 0; i < steps; ++i) {
    const double t = reach * (i + 0.5) / steps;
    const double d2 = height * height + (t - 1) * (t - 1);
    expected +=
        reach / steps * sigma_s / (4 * 3.14159265358979) * intensity / d2 * std::exp(-sigma_t * (t + std::sqrt(d2)));
  }
  for (const char* integrator : {"path", "probppm"}) {
    RenderOptions o = options(integrator, 8);
    o.max_depth = 1;
    EXPECT_TRUE(test::runs_agree(mean(scene, o), expected, 0.001, 0.15, test::false_alarm_rate / 2)) << integrator;
  }
}

// Scenes without interfaces take a shorter path through the code. An interface hidden behind a wall changes no pixel.
TEST(Media, InterfacesElsewhereChangeNothing) {
  const std::string room =
      R"(LookAt 0 0 0.9  0 0 0  0 1 0
MediumInterface "" "fog"
Camera "perspective" "float fov" [60]
)" + film +
      "WorldBegin\n" + fog(R"("rgb sigma_a" [0.1 0.2 0.3] "rgb sigma_s" [0.9 0.6 0.3])") +
      R"(MediumInterface "fog" "fog"
LightSource "point" "rgb I" [1 1 1] "point3 from" [0 0.6 0]
Material "diffuse" "rgb reflectance" [.5 .5 .5]
Shape "sphere"
Shape "sphere" "float radius" [0.2]
MediumInterface "" "fog"
Material "interface"
)";
  // Inside the ball.
  const Scene with = test::scene_from_text(room + R"(Shape "sphere" "float radius" [0.1]
)");
  const Scene without = test::scene_from_text(room);
  ASSERT_TRUE(with.has_interfaces());
  ASSERT_FALSE(without.has_interfaces());
  EXPECT_TRUE(test::edited(with, [](SceneDescription&) {})->has_interfaces());
  for (const char* integrator : {"path", "bdpt"})
    EXPECT_EQ(test::render_image(with, options(integrator, 2)).pixels,
              test::render_image(without, options(integrator, 2)).pixels)
        << integrator;
}

// Rays stay in the medium from which they reach an opaque surface, whatever the shape specifies for its sides.
TEST(Media, OpaqueShapesMayBeInsideOut) {
  const auto room = [](const std::string& walls, const std::string& ball) {
    return test::scene_from_text(
        R"(LookAt 0 0 0.9  0 0 0  0 1 0
MediumInterface "" "fog"
Camera "perspective" "float fov" [60]
)" + film +
        "WorldBegin\n" + fog(R"("rgb sigma_a" [0.1 0.2 0.3] "rgb sigma_s" [0.9 0.6 0.3])") +
        R"(MediumInterface "fog" "fog"
LightSource "point" "rgb I" [1 1 1] "point3 from" [0 0.6 0]
Material "diffuse" "rgb reflectance" [.5 .5 .5]
MediumInterface )" +
        walls + R"(
Shape "sphere"
MediumInterface )" +
        ball + R"(
Shape "sphere" "float radius" [0.2]
)");
  };
  const Scene fitting = room(R"("fog" "fog")", R"("fog" "fog")");
  const Scene inside_out = room(R"("" "fog")", R"("fog" "")");
  EXPECT_TRUE(media_warnings(inside_out, make_view(inside_out.description().view)).empty());
  for (const char* integrator : {"path", "bdpt", "vcm", "probppm", "photonmap", "light"})
    EXPECT_EQ(test::render_image(inside_out, options(integrator, 2)).pixels,
              test::render_image(fitting, options(integrator, 2)).pixels)
        << integrator;
}

// Lights and cameras are in the medium that shapes define around them, whatever they specify.
TEST(Media, LightsAndCamerasMayClaimTheWrongMedium) {
  // A ball of fog containing a ball of glass, on a floor with wrong specifications.
  const auto ball = [](const std::string& of_camera, const std::string& of_lamp, const std::string& place,
                       const std::string& of_light, const std::string& from) {
    return test::scene_from_text("LookAt " + place + R"(  0 0.2 0  0 1 0
MediumInterface "" )" + of_camera +
                                 R"(
Camera "perspective" "float fov" [60]
)" + film + "WorldBegin\n" + fog(R"("rgb sigma_a" [0.1 0.2 0.3] "rgb sigma_s" [0.9 0.6 0.3])") +
                                 R"(AttributeBegin MediumInterface "" )" + of_light + R"(
LightSource "point" "rgb I" [9 9 9] "point3 from" [)" +
                                 from +
                                 R"(]
AttributeEnd AttributeBegin MediumInterface "" )" +
                                 of_lamp +
                                 R"(
LightSource "point" "rgb I" [1 1 1] "point3 from" [0 0.8 0.3]
AttributeEnd
AttributeBegin
MediumInterface "fog" ""
Material "interface"
Shape "sphere"
AttributeEnd
AttributeBegin
MediumInterface "" "fog"
Material "dielectric"
Shape "sphere" "float radius" [0.3]
AttributeEnd
Material "diffuse"
MediumInterface "" "fog"
)" + test::patch("-9 -0.5 9  9 -0.5 9  -9 -0.5 -9  9 -0.5 -9"));
  };
  const std::string none = R"("")", in_fog = R"("fog")", outside = "0.5 0.5 2.5", inside = "0.1 0.5 0.7";
  for (const std::string& eye : {outside, inside}) {
    const std::string& around_eye = eye == inside ? in_fog : none;
    const std::string& elsewhere = eye == inside ? none : in_fog;
    const Scene right = ball(around_eye, in_fog, eye, none, "0 3 1");
    const Scene wrong = ball(elsewhere, none, eye, in_fog, "0 3 1");
    EXPECT_TRUE(warnings_of(right, right.description().view).empty());
    EXPECT_EQ(warnings_of(wrong, wrong.description().view).size(), 3u);
    for (const char* integrator : {"path", "bdpt", "vcm", "probppm", "light"})
      EXPECT_EQ(test::render_image(wrong, options(integrator, 2)).pixels,
                test::render_image(right, options(integrator, 2)).pixels)
          << integrator << " from " << eye;
  }
  // The same after an edit: the light moves into the fog.
  const Scene before = ball(none, in_fog, outside, none, "0 3 1");
  const SharedScene edited = test::edited(before, [](SceneDescription& description) {
    std::get<description::PointLight>(description.lights[0].node).from = {0.1f, 0.6f, 0.1f};
  });
  const Scene after = ball(none, in_fog, outside, in_fog, "0.1 0.6 0.1");
  EXPECT_EQ(test::render_image(*edited, options("light", 2)).pixels,
            test::render_image(after, options("light", 2)).pixels);
}

// Thick coloured fog around a grey ball in a room, the camera outside the fog: all integrators must agree.
Scene foggy_room(const std::string& medium) {
  return test::scene_from_text(
      R"(LookAt 0 1 3  0 1 0  0 1 0
Camera "perspective" "float fov" [40]
)" + film +
      "WorldBegin\n" + "AttributeBegin\nTranslate 0 0.8 0\n" + medium +
      R"(AttributeEnd
AttributeBegin
AreaLightSource "diffuse" "rgb L" [6 6 6]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
  "point3 P" [-0.5 1.99 -0.5 0.5 1.99 -0.5 0.5 1.99 0.5 -0.5 1.99 0.5]
AttributeEnd
Material "diffuse" "rgb reflectance" [0.7 0.7 0.7]
)" + test::quad("-1 0 1  1 0 1  1 0 -1  -1 0 -1") +
      test::quad("-1 0 -1  1 0 -1  1 2 -1  -1 2 -1") +
      R"(Translate 0 0.8 0
AttributeBegin
MediumInterface "fog" ""
Material "interface"
Shape "sphere" "float radius" [0.7]
AttributeEnd
MediumInterface "fog" "fog"
Shape "sphere" "float radius" [0.3]
)");
}

/// By Welch's t-test per tile; for tests with up to eleven integrators.
void expect_agreement(const Scene& scene, const std::vector<std::string>& integrators, std::uint64_t effort) {
  const std::vector<Image> path = runs(scene, options("path", 8 * effort), 100);
  for (const std::string& integrator : integrators) {
    RenderOptions o = options(integrator, integrator == "light" ? 1 : 2 * effort);
    if (o.integrator == "mlt") o.photons = 2'500;
    if (test::has_radius(integrator)) o.set["radius"] = "0.05";
    if (test::has_parameter(integrator, "volume-radius")) o.set["volume-radius"] = "0.05";
    EXPECT_TRUE(test::tiles_agree(runs(scene, o, 200), path, test::false_alarm_rate / 11)) << integrator;
  }
}

TEST(Media, IntegratorsAgree) {
  const std::string coefficients = R"("rgb sigma_a" [0.1 0.2 0.4] "rgb sigma_s" [0.3 1 2] "float g" [0.5] )";
  expect_agreement(foggy_room(fog(coefficients)), {"light", "probppm", "bdpt", "vcm", "auto", "mlt", "mlt:over=path"},
                   2);
  const std::string box = R"("point3 p0" [-0.7 -0.7 -0.7] "point3 p1" [0.7 0.7 0.7] )";
  expect_agreement(foggy_room(fog(coefficients + box + R"("float density" 6)", "cloud")), {"light", "probppm"}, 1);
  const std::string grid = box + R"("integer nx" 2 "integer ny" 1 "integer nz" 1 "float g" -0.3 )";
  expect_agreement(
      foggy_room(fog(grid + R"("rgb sigma_a" [0.1 0.2 0.3  0.3 0.1 0] "rgb sigma_s" [1 3 0.5  4 1 2])", "rgbgrid")),
      {"light", "bdpt", "mlt"}, 1);
}

// A flame that scatters is the only light, over a glossy floor, beside a ball of glass, seen in a rough mirror.
TEST(NightlyMedia, VolumeEmissionLightsItsSurroundings) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 1 3  0 1 0  0 1 0
Camera "perspective" "float fov" [40]
)" + film +
      "WorldBegin\n" + "AttributeBegin\nTranslate -0.3 0.8 0\n" +
      fog(R"("point3 p0" [-0.4 -0.4 -0.4] "point3 p1" [0.4 0.4 0.4] "integer nx" 1 "integer ny" 2 )"
          R"("integer nz" 1 "float density" [2 1] "rgb sigma_a" [1 1 2] "rgb sigma_s" [1 2 1] "rgb Le" [3 2 1])",
          "uniformgrid") +
      R"(MediumInterface "fog" ""
Material "interface"
Shape "sphere" "float radius" [0.4]
AttributeEnd
Material "coateddiffuse" "rgb reflectance" [0.8 0.8 0.9] "float roughness" [0.3]
)" + test::patch("-1 0 1  1 0 1  -1 0 -1  1 0 -1") +
      R"(Material "diffuse" "rgb reflectance" [0.9 0.9 0.9]
)" + test::patch("-1 2 1  1 2 1  -1 2 -1  1 2 -1") +
      test::patch("1 0 1  1 0 -1  1 2 1  1 2 -1") +
      R"(Material "conductor" "float roughness" [0.01]
)" + test::patch("-1 0 -1  1 0 -1  -1 2 -1  1 2 -1") +
      R"(Material "dielectric"
Translate 0.4 0.4 0.2
Shape "sphere" "float radius" [0.3]
)");
  EXPECT_TRUE(scene.warnings().empty());
  EXPECT_TRUE(media_warnings(scene, make_view(scene.description().view)).empty());
  expect_agreement(scene, {"light", "probppm", "bdpt", "vcm", "auto"}, 2);
}

// On the right, a ball of fog in front of a black wall: all light comes from the medium, also behind a pane of glass.
// On the left, a white wall that the fog also lights: no light comes from the medium.
class LayerOfMedia : public testing::TestWithParam<const char*> {};

TEST_P(LayerOfMedia, HasAllLightThatComesOutOfThem) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 0 5  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-1 1 -1 1]
)" + film +
      "WorldBegin\n" + fog(R"("rgb sigma_a" [0.2 0.1 0.3] "rgb sigma_s" [1 2 1] "rgb Le" )" + std::string(GetParam())) +
      R"(LightSource "point" "point3 from" [0.2 0 4]
AttributeBegin
MediumInterface "fog" ""
Material "interface"
Translate -2.01 0 0
Shape "sphere" "float radius" [2]
AttributeEnd
AttributeBegin
Material "thindielectric"
)" + test::patch("-1 -1 3  -0.01 -1 3  -1 0 3  -0.01 0 3") +
      R"(AttributeEnd
AttributeBegin
Material "diffuse" "rgb reflectance" [0 0 0]
)" + test::patch("-2 -1 -2.5  0 -1 -2.5  -2 1 -2.5  0 1 -2.5") +
      "AttributeEnd\n" + test::patch("0 -1 -2.5  2 -1 -2.5  0 1 -2.5  2 1 -2.5"));
  for (const IntegratorInfo& info : integrator_registry()) {
    if (info.name == "splitsum") continue;  // shades surfaces only
    RenderOptions o = options(info.name, 2);
    o.photons = info.name == "mlt" ? 2'000 : 5'000;
    o.max_depth = 8;
    const Image image = test::render_image(scene, o);
    const Image media = *select_layer(image, "media"), color = *select_layer(image, "color");
    double from_media = 0, from_wall = 0;
    for (std::size_t i = 0; i < color.pixels.size(); ++i) {
      const bool in_fog = i / 3 % 8 >= 4;
      const float expected = in_fog ? color.pixels[i] : 0.0f;
      EXPECT_NEAR(media.pixels[i], expected, 1e-5f * color.pixels[i]) << info.name << ' ' << i;
      (in_fog ? from_media : from_wall) += static_cast<double>(color.pixels[i]);
    }
    EXPECT_GT(from_media, 0) << info.name;
    EXPECT_GT(from_wall, 0) << info.name;
  }
}
INSTANTIATE_TEST_SUITE_P(Media, LayerOfMedia, testing::Values("[0 0 0]", "[0.5 0.2 0.1]"));

// A ball that is partly skin, partly paint: purely one of them where the mix says so, elsewhere with the skin's medium
// inside, which every integrator finds.
TEST(Media, MixesOfSkinAndPaint) {
  const auto ball = [](const std::string& material) {
    return test::scene_from_text(
        R"(LookAt 0 1 3  0 1 0  0 1 0
Camera "perspective" "float fov" [28]
)" + film +
        R"(WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [6 6 6]
Translate 0.5 2.4 1
Shape "sphere" "float radius" [0.4]
AttributeEnd
MakeNamedMaterial "skin" "string type" "subsurface" "rgb sigma_s" [6 4 3] "rgb sigma_a" [0.1 0.3 0.6] "float eta" [1.3] "float roughness" [0.3]
MakeNamedMaterial "paint" "string type" "diffuse" "rgb reflectance" [0.2 0.6 0.7]
Material "diffuse" "rgb reflectance" [0.7 0.7 0.7]
)" + test::patch("-2 0.3 2  2 0.3 2  -2 0.3 -2  2 0.3 -2") +
        material +
        R"(Translate 0 1 0
Shape "sphere" "float radius" [0.6]
)");
  };
  const auto mix = [&](const std::string& amount) {
    return ball(R"(Material "mix" "string materials" ["skin" "paint"] "float amount" [)" + amount + "]\n");
  };
  const auto picture = [](const Scene& scene) { return test::render_image(scene, options("path", 4)); };
  EXPECT_EQ(picture(mix("0")).pixels, picture(ball(R"(NamedMaterial "skin"
)"))
                                          .pixels);
  EXPECT_EQ(picture(mix("1")).pixels, picture(ball(R"(NamedMaterial "paint"
)"))
                                          .pixels);
  expect_agreement(mix("0.5"), {"bdpt", "probppm"}, 2);
}

}  // namespace
}  // namespace lanthorn::media_test
