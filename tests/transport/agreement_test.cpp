// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Integrators agree where their sets of paths overlap: Welch's t-test per tile and for the whole picture.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "lanthorn/file.h"
#include "lanthorn/metrics.h"
#include "math/hash.h"
#include "math/sampling.h"
#include "support/render_scene.h"
#include "support/runs.h"
#include "support/shapes.h"
#include "support/spotlit_room.h"
#include "support/temporary_dir.h"
#include "support/varied_room.h"

namespace lanthorn::agreement_test {
namespace {

const std::filesystem::path test_scenes = std::filesystem::path(LANTHORN_SOURCE_DIR) / "tests/scenes";
const std::string overview = "LookAt 0 1 4.4  0 1 0  0 1 0\n";
// A view so close to the ball that its facets cover whole tiles.
const std::string close_up = "LookAt 0.1 0.6 1.7  0.1 0.6 0  0 1 0\n";
const std::string film =
    R"(Camera "perspective" "float fov" [36]
Film "rgb" "integer xresolution" [48] "integer yresolution" [48]
PixelFilter "gaussian"
WorldBegin
)";
const std::string area_light =
    R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [17 12 4]
Translate 0 1.7 0
Shape "sphere" "float radius" [0.2]
AttributeEnd
)";
const std::string small_lights =
    R"(LightSource "point" "rgb I" [0.6 0.5 0.4] "point3 from" [-0.6 1.6 0.3]
LightSource "spot" "rgb I" [6 6 7] "point3 from" [0.7 1.9 0.7] "point3 to" [0.3 0 -0.2] "float coneangle" [24] "float conedeltaangle" [6]
LightSource "distant" "rgb L" [0.8 0.7 0.5] "point3 from" [-0.4 0.5 1] "point3 to" [0 0 0]
)";
const std::string walls =
    R"(Material "diffuse" "rgb reflectance" [0.725 0.71 0.68]
)" + test::quad("-1 0 1  1 0 1  1 0 -1  -1 0 -1") +
    test::quad("-1 0 -1  1 0 -1  1 2 -1  -1 2 -1") + R"(Material "diffuse" "rgb reflectance" [0.63 0.065 0.05]
)" + test::quad("-1 0 1  -1 0 -1  -1 2 -1  -1 2 1");
const std::string from_above = "LookAt 0 2.6 2.2  0 0 0  0 1 0\n";
// Smooth varnish, rough varnish and metal.
const std::string varnished_floor =
    R"(Material "coateddiffuse" "rgb reflectance" [0.6 0.3 0.2] "float roughness" [0]
)" + test::patch("-1 0.01 -1  -0.4 0.01 -1  -1 0.01 1  -0.4 0.01 1") +
    R"(Material "coateddiffuse" "rgb reflectance" [0.2 0.3 0.6] "float roughness" [0.02]
)" + test::patch("-0.4 0.01 -1  0.2 0.01 -1  -0.4 0.01 1  0.2 0.01 1") +
    R"(Material "conductor" "float roughness" [0.06]
)" + test::patch("0.2 0.01 -1  1 0.01 -1  0.2 0.01 1  1 0.01 1");
// A metal surface on which both photons and walks find half of the light, lit only by a ceiling: the lamp shines up.
const std::string metal_room =
    R"(Material "diffuse" "rgb reflectance" [0.8 0.8 0.8]
)" + test::patch("-1 2 -1  1 2 -1  -1 2 1  1 2 1") +
    R"(Material "conductor" "float roughness" [0.06]
)" + test::patch("-1 0 1  1 0 1  -1 0 -1  1 0 -1") +
    test::patch("-1 0 -1  1 0 -1  -1 2 -1  1 2 -1") + test::patch("-1 0 1  -1 0 -1  -1 2 1  -1 2 -1") +
    test::patch("1 0 1  1 0 -1  1 2 1  1 2 -1") +
    R"(AreaLightSource "diffuse" "rgb L" [17 12 4]
Material "diffuse" "rgb reflectance" [0 0 0]
Translate 0 1.7 0
Rotate -90 1 0 0
Shape "disk" "float radius" [0.3]
)";
// A tessellated ball with interpolated normals: light paths agree only with the adjoint of shading normals.
const std::string smooth_ball_material = "Translate 0.1 0.6 0\nScale 0.5 0.5 0.5\n";

// An icosahedron whose vertex normals point from its centre.
std::string icosahedron() {
  const char* const points =
      "[0 0.5257 0.8507  0 -0.5257 0.8507  0 0.5257 -0.8507  0 -0.5257 -0.8507  0.5257 0.8507 0  -0.5257 0.8507 0 "
      "0.5257 -0.8507 0  -0.5257 -0.8507 0  0.8507 0 0.5257  -0.8507 0 0.5257  0.8507 0 -0.5257  -0.8507 0 -0.5257]";
  return std::string(R"(Shape "trianglemesh" "point3 P" )") + points + R"( "normal N" )" + points +
         R"( "integer indices" [0 1 8 0 8 4 0 4 5 0 5 9 0 9 1 1 6 8 8 6 10 8 10 4 4 10 2 4 2 5 5 2 11 5 11 9 9 11 7 9 7 1 1 7 6 3 6 7 3 7 11 3 11 2 3 2 10 3 10 6]
)";
}

// The same body with the normals of each facet mirrored in the facet's own: it looks dented, and no ray leaves it from
// a smooth surface above its facets (`SurfacePoint::rise`), where no light path can end.
std::string dented_ball() {
  constexpr float a = 0.5257f, b = 0.8507f;
  const std::array<Vec3, 12> corners{Vec3(0, a, b), {0, -a, b},  {0, a, -b}, {0, -a, -b}, {a, b, 0},  {-a, b, 0},
                                     {a, -b, 0},    {-a, -b, 0}, {b, 0, a},  {-b, 0, a},  {b, 0, -a}, {-b, 0, -a}};
  const float edge2 = 4.1f * a * a;
  std::string points, normals;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = i + 1; j < corners.size(); ++j)
      for (std::size_t k = j + 1; k < corners.size(); ++k) {
        const std::array<Vec3, 3> facet{corners[i], corners[j], corners[k]};
        if (distance_squared(facet[0], facet[1]) > edge2 || distance_squared(facet[1], facet[2]) > edge2 ||
            distance_squared(facet[2], facet[0]) > edge2)
          continue;
        const Normal n = normalize(facet[0] + facet[1] + facet[2]);
        for (const Vec3& p : facet) {
          const Vec3 mirrored = 2 * dot(p, n) * n - p;
          points += fmt::format("{} {} {} ", p.x, p.y, p.z);
          normals += fmt::format("{} {} {} ", mirrored.x, mirrored.y, mirrored.z);
        }
      }
  std::string indices;
  for (int i = 0; i < 60; ++i) indices += fmt::format("{} ", i);
  return R"(Shape "trianglemesh" "point3 P" [)" + points + R"(] "normal N" [)" + normals + R"(] "integer indices" [)" +
         indices + "]\n";
}

// A loose ball of hairs in all directions.
std::string hairs() {
  std::string text = R"(Material "hair" "rgb color" [0.9 0.5 0.1] "float beta_m" [0.8] "float beta_n" [0.3]
)";
  HashRng rng(1);
  for (int i = 0; i < 400; ++i) {
    const Vec3 along = 0.12f * sample_uniform_sphere(rng.next2());
    const Vec3 middle = Vec3(0, 0.7f, 0) + 0.4f * std::cbrt(rng.next()) * sample_uniform_sphere(rng.next2());
    text += R"(Shape "curve" "float width" [0.01] "point3 P" [)";
    for (const float t : {-3.0f, -1.0f, 1.0f, 3.0f}) {
      const Vec3 p = middle + t * along;
      text += fmt::format("{} {} {} ", p.x, p.y, p.z);
    }
    text += "]\n";
  }
  return text;
}

// A picture large enough to have coarser levels: single dark texels among bright ones, in stripes of both kinds. Eye
// paths see its levels, light paths single texels.
std::string large_texture() {
  constexpr int side = 2048;
  std::string image = fmt::format("P6\n{} {}\n255\n", side, side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) image.append(3, (x + y) % (x / 256 % 2 == 0 ? 2 : 5) == 0 ? '\x20' : '\xe0');
  static const test::TemporaryDir folder;
  return R"(Texture "large" "spectrum" "imagemap" "string filename" ")" + folder.write("large.ppm", image).string() +
         R"("
Material "diffuse" "texture reflectance" "large"
)" + test::patch("-1 0 -1  1 0 -1  -1 0 1  1 0 1") +
         test::patch("-1 0 -1  1 0 -1  -1 2 -1  1 2 -1");
}

// The radius is as small as the other methods' radii.
const char* const photonmap = "photonmap:nearest=0:caustic-nearest=0:max-radius=0.012:gather=4:irradiance=estimated";
const char* const reversephotonmap = "reversephotonmap:caustic-nearest=0:max-radius=0.012:gather=4";

struct Case {
  std::string scene;       ///< a name of `scenes()`
  std::string integrator;  ///< against path
  ColorMode color;
  std::uint64_t effort = 1;  ///< factor of the passes
  std::uint64_t runs = 24;   ///< that share the passes
};

const std::map<std::string, std::string>& scenes() {
  const auto placed = [](const std::string& material, const std::string& shape) {
    return "AttributeBegin\n" + material + smooth_ball_material + shape + "AttributeEnd\n";
  };
  const auto ball = [&](const std::string& material) { return placed(material, icosahedron()); };
  const std::string ochre = R"(Material "diffuse" "rgb reflectance" [0.6 0.6 0.2]
)";
  const std::string diffuse_ball = placed(ochre, dented_ball());
  const std::string under_lamp = overview + film + area_light + walls;
  // A lamp in a glass globe: all light comes from photons, and illuminates a ball whose shading normals differ much
  // from its facets'.
  const std::string globe =
      R"(AttributeBegin
Material "dielectric" "float eta" [1.5]
Translate 0 1.7 0
Shape "sphere" "float radius" [0.3]
AttributeEnd
)";
  static const std::map<std::string, std::string> all{
      {"shading_normals", under_lamp + diffuse_ball},
      // Facets that stand in for a surface which bulges out: eye paths alone find the light that they themselves would
      // block.
      {"smooth_ball", under_lamp + ball(ochre)},
      {"small_lights", overview + film + small_lights + walls + diffuse_ball},
      {"rough_glass", under_lamp + ball(R"(Material "dielectric" "float eta" [1.5] "float roughness" [0.3]
)")},
      {"rough_metal", under_lamp + ball(R"(Material "conductor" "float roughness" [0.3]
)")},
      // Narrow lobes, over wide ones and alone. Photons and eye paths share their indirect light, and both techniques
      // find their direct light.
      {"varnish", from_above + film + area_light + walls + diffuse_ball + varnished_floor},
      {"varnish_under_sky", from_above + film + R"(LightSource "infinite" "rgb L" [0.3 0.4 0.6]
)" + walls + varnished_floor},
      {"metal_room", overview + film + metal_room},
      {"leaf",
       under_lamp +
           ball(R"(Material "diffusetransmission" "rgb reflectance" [0.3 0.3 0.1] "rgb transmittance" [0.2 0.6 0.2]
)")},
      {"sky", overview + film + R"(LightSource "infinite" "rgb L" [0.3 0.4 0.6]
)" + walls + diffuse_ball},
      // A sky seen through an opening. Most lines through the world's origin in the direction of the light miss the
      // opening.
      {"window",
       overview + film +
           R"(LightSource "infinite" "rgb L" [3 4 6] "point3 portal" [1 0.5 -0.5  1 0.5 0.5  1 1.5 0.5  1 1.5 -0.5]
)" + walls +
           diffuse_ball},
      // Light through clear glass with strongly interpolated normals: photons must carry the adjoint of shading
      // normals. (Light tracing cannot find what the eye sees through clear glass.)
      {"clear_glass", close_up + film + area_light + walls + ball(R"(Material "dielectric" "float eta" [1.5]
)")},
      {"lamp_in_glass", close_up + film + area_light + globe + diffuse_ball},
      // Hair, with a different normal for each ray: light passes from strand to strand.
      {"hair", under_lamp + hairs()},
      {"large_texture", overview + film + area_light + large_texture()},
      {"spotlit_room", test::spotlit_room},
      {"varied_room", test::varied_room},
      // Images, alpha and instances on emitters.
      {"emitters", read_file(test_scenes / "emitters.pbrt")},
      // Curves; emitting ones are meshes.
      {"curve_lamps", read_file(test_scenes / "curve-lamps.pbrt")},
      // Shading normals far from the surface's, with all kinds of closures.
      {"relief", read_file(test_scenes / "relief.pbrt")}};
  return all;
}

constexpr ColorMode rgb = ColorMode::rgb, spectral = ColorMode::spectral;
const std::string guided_photonmap = std::string(photonmap) + ":guide=photons";
const std::string own_caustics = std::string(photonmap) + ":caustic-photons=60000:emission=";

// Tests each method with every closure, kind of light and technique for which it has its own code. Methods share the
// code of closures and lights, so not every combination is tested.
const std::vector<Case> cases{
    // Photons alone, and connections of light paths to the lens alone, so that no other technique hides an error.
    {"shading_normals", "light", rgb, 1, 12},
    {"small_lights", "light", rgb, 1, 12},
    {"rough_glass", "light", spectral, 1, 12},
    {"sky", "light", rgb, 1, 12},
    {"emitters", "light", rgb, 1, 12},
    {"curve_lamps", "light", rgb, 1, 12},
    {"large_texture", "light", rgb, 1, 12},
    {"shading_normals", "probppm", rgb},
    {"small_lights", "probppm", rgb},
    {"rough_glass", "probppm", spectral},
    {"rough_metal", "probppm", spectral},
    {"varnish", "probppm", rgb},
    {"varnish_under_sky", "probppm", rgb},
    {"metal_room", "probppm", rgb},
    {"leaf", "probppm", spectral},
    {"sky", "probppm", rgb},
    {"clear_glass", "probppm", rgb},
    {"relief", "probppm", rgb},
    {"small_lights", "sppm", rgb},
    {"rough_metal", "ppm", spectral},
    // Many techniques, whose weights must add up to 1.
    {"shading_normals", "bdpt", rgb},
    {"smooth_ball", "bdpt", rgb},
    {"smooth_ball", "vcm", rgb},
    {"smooth_ball", "probppm", rgb},
    {"rough_glass", "bdpt", rgb},
    {"rough_metal", "bdpt", spectral},
    {"sky", "bdpt", rgb},
    {"hair", "bdpt", rgb},
    {"small_lights", "vcm", rgb},
    {"small_lights", "auto", rgb},
    {"rough_glass", "auto", rgb},
    {"emitters", "auto", rgb},
    {"leaf", "auto", rgb},
    {"rough_glass", "vcm", rgb},
    {"leaf", "vcm", rgb},
    {"clear_glass", "vcm", spectral},
    {"emitters", "vcm", rgb},
    {"window", "bdpt", rgb},
    {"small_lights", "bpm", rgb},
    {"leaf", "bpm", rgb},
    {"shading_normals", "mlt", rgb},
    {"small_lights", "mlt", rgb},
    {"rough_glass", "mlt", spectral},
    {"rough_metal", "mlt:over=path", spectral},
    {"small_lights", photonmap, rgb},
    {"rough_metal", photonmap, spectral},
    {"varnish", photonmap, rgb},
    {"varnish_under_sky", photonmap, rgb},
    {"metal_room", photonmap, rgb},
    {"clear_glass", photonmap, spectral},
    {"rough_metal", reversephotonmap, rgb},
    // Photons that a guide aims, for lights of all kinds, and through glass.
    {"small_lights", "probppm:emission=projected", rgb},
    {"small_lights", "probppm:emission=learned", rgb, 1, 12},
    {"leaf", "vcm:emission=learned", rgb, 1, 12},
    {"sky", "bpm:emission=learned", rgb, 1, 12},
    {"clear_glass", own_caustics + "projected", rgb},
    // Guided walks with all that they meet.
    {"rough_metal", "path:guide=photons", spectral},
    {"leaf", "path:guide=photons", rgb},
    {"spotlit_room", "path:guide=photons", rgb},
    {"sky", "path:guide=photons", rgb},
    {"varied_room", "path:guide=photons", spectral, 6},
    {"leaf", guided_photonmap, rgb},
};

// Further pairs of scenes and methods, whose parts are tested in other pairs above.
const std::vector<Case> nightly_cases{
    {"rough_metal", "light", spectral, 1, 12},
    {"leaf", "light", spectral, 1, 12},
    {"hair", "light", rgb, 2, 12},
    {"emitters", "probppm", rgb},
    {"curve_lamps", "probppm", rgb},
    {"hair", "probppm", rgb, 2},
    {"clear_glass", "probppm", spectral},
    {"lamp_in_glass", "probppm", rgb, 10},
    {"rough_metal", "sppm", spectral},
    {"small_lights", "ppm", rgb},
    {"small_lights", "bdpt", rgb},
    {"leaf", "bdpt", rgb},
    {"curve_lamps", "bdpt", rgb},
    {"shading_normals", "vcm", rgb},
    {"shading_normals", "auto", rgb},
    {"smooth_ball", "auto", rgb},
    {"smooth_ball", "mlt", rgb},
    {"rough_metal", "auto", spectral},
    {"sky", "auto", rgb},
    {"clear_glass", "auto", rgb},
    {"rough_metal", "vcm", spectral},
    {"sky", "vcm", rgb},
    {"clear_glass", "vcm", rgb},
    {"large_texture", "vcm", rgb},
    {"emitters", "mlt", rgb},
    {"leaf", photonmap, rgb},
    {"varnish", "sppm", spectral},
    {"varnish", reversephotonmap, spectral},
    {"clear_glass", photonmap, rgb},
    {"rough_metal", guided_photonmap, spectral},
    {"sky", "sppm:emission=learned", rgb, 1, 12},
    {"small_lights", "vcm:emission=learned", rgb, 1, 12},
    {"sky", "vcm:emission=learned", rgb, 1, 12},
    {"emitters", "vcm:emission=projected", rgb},
    {"clear_glass", own_caustics + "projected", spectral},
    {"clear_glass", own_caustics + "learned", spectral, 1, 12},
};

class Agreement : public testing::TestWithParam<Case> {};

std::vector<Image> renders(const Scene& scene, const Case& c, const std::string& integrator, std::uint64_t passes,
                           std::uint64_t runs, std::uint64_t first_seed) {
  RenderOptions options = test::options_for(integrator, passes);
  options.color = c.color;
  options.max_depth = 5;
  options.photons = 60'000;
  if (options.integrator == "mlt") {  // the accuracy of its means depends on the number of independent paths
    options.photons = 10'000;
    options.set["bootstrap"] = "1";
  }
  if (test::has_radius(integrator)) options.set["radius"] = "0.012";
  return test::select_layers(test::independent_renders(scene, options, runs, first_seed), "color");
}

// The same for all integrators with which it is compared.
const std::vector<Image>& reference_renders(const Scene& scene, const Case& c) {
  static std::map<std::tuple<std::string, ColorMode, std::uint64_t>, std::vector<Image>> known;
  std::vector<Image>& images = known[{c.scene, c.color, c.effort}];
  if (images.empty()) images = renders(scene, c, "path", 6 * c.effort, 24, 100);
  return images;
}

// Many runs of few passes: limits of t-tests fall faster with the number of runs than the noise of a run grows. Half as
// many where starting each is expensive, and for light tracing, whose few splats in a dark tile are far from normally
// distributed: with 24 runs of one pass, one of three seeds gave p = 3e-6, and with 12 of two passes another 2e-7.
TEST_P(Agreement, WithPath) {
  const Case& c = GetParam();
  const Scene scene = test::scene_from_text(scenes().at(c.scene), test_scenes);
  const std::uint64_t passes = c.effort * 48 / c.runs;
  const std::vector<Image>& reference = reference_renders(scene, c);
  const std::vector<Image> other = renders(scene, c, c.integrator, passes, c.runs, 200);
  EXPECT_TRUE(test::tiles_agree(other, reference, test::false_alarm_rate / 2));
  // The whole image: finds small errors that are spread out. 0.5 % allows for the bias of radii.
  EXPECT_TRUE(test::runs_agree(test::mean_of_means(other), test::mean_of_means(reference), 0.005, 0.2,
                               test::false_alarm_rate / 2));
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  return test::identifier(info.param.scene + "_" + info.param.integrator +
                          (info.param.color == ColorMode::rgb ? "_rgb" : "_spectral"));
}

INSTANTIATE_TEST_SUITE_P(Cases, Agreement, testing::ValuesIn(cases), case_name);
INSTANTIATE_TEST_SUITE_P(Nightly, Agreement, testing::ValuesIn(nightly_cases), case_name);

std::string room_with_emissive_fog() {
  std::string text = test::varied_room;
  return text.insert(text.find(R"("rgb sigma_a")"), R"("rgb Le" [1 2 3] )");
}

// With one seed; each strategy shows some light.
TEST(Bidirectional, StrategiesAddUpToTheImage) {
  const Scene scene = test::scene_from_text(test::varied_room);
  constexpr int depth = 2;
  const auto render = [&](const std::string& integrator) {
    RenderOptions options = test::options_for(integrator, 2, 1);
    options.max_depth = depth;
    options.photons = 2'000;
    return *select_layer(test::render_image(scene, options), "color");
  };
  const Image all = render("bdpt");
  std::vector<double> sum(all.pixels.size());
  for (int vertices = 2; vertices <= depth + 2; ++vertices)
    for (int s = 0; s < vertices; ++s) {
      const Image one = render(fmt::format("bdpt:strategy={},{}", s, vertices - s));
      double light = 0;
      for (std::size_t i = 0; i < sum.size(); ++i) {
        sum[i] += static_cast<double>(one.pixels[i]);
        light += static_cast<double>(one.pixels[i]);
      }
      if (vertices > 2 || s == 0) {  // no light is connected to the lens itself
        EXPECT_GT(light, 0) << s << ", " << vertices - s;
      }
    }
  for (std::size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(sum[i], static_cast<double>(all.pixels[i]), 1e-4);
}

// Light of a strategy is in its technique's layer. The fog is emissive, so that the walk finds light in it too.
TEST(Techniques, ShowTheirStrategies) {
  const Scene scene = test::scene_from_text(room_with_emissive_fog());
  constexpr int depth = 2;
  const auto expect_only = [&](const std::string& integrator, const std::vector<std::string>& techniques) {
    RenderOptions options = test::options_for(integrator, 1, 1);
    options.max_depth = depth;
    options.photons = 2'000;
    const Image image = test::render_image(scene, options), color = *select_layer(image, "color");
    std::vector<double> rest(color.pixels.begin(), color.pixels.end());
    for (const std::string& technique : techniques) {
      const Image part = *select_layer(image, "technique." + technique);
      for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= static_cast<double>(part.pixels[i]);
    }
    for (const double x : rest) ASSERT_NEAR(x, 0, 1e-5) << integrator;
  };
  for (int vertices = 2; vertices <= depth + 2; ++vertices)
    for (int s = 0; s < vertices; ++s) {
      const int t = vertices - s;
      const char* const technique = s == 0 ? "hit" : t == 1 ? "splat" : s == 1 ? "nee" : "vc";
      expect_only(fmt::format("bdpt:strategy={},{}", s, t), {technique});
    }
  expect_only("bpm:radius=0.1", {"hit", "vm"});
}

TEST(Layers, OfOneScatteringAreDirect) {
  const Scene scene = test::scene_from_text(test::varied_room);
  for (const IntegratorInfo& info : integrator_registry()) {
    if (info.name == "splitsum") continue;  // the room has no sky
    RenderOptions options = test::options_for(info.name, 1, 1);
    options.max_depth = 1;
    options.photons = 2'000;
    if (test::has_radius(info.name)) options.set["radius"] = "0.1";
    const Image image = test::render_image(scene, options);
    const auto largest = [&](const char* layer) {
      const Image selected = *select_layer(image, layer);
      return *std::max_element(selected.pixels.begin(), selected.pixels.end());
    };
    EXPECT_GT(largest("direct"), 0) << info.name;
    EXPECT_EQ(largest("indirect"), 0) << info.name;
    EXPECT_EQ(largest("caustic"), 0) << info.name;
  }
}

// The room's only delta surface is dispersive glass. A path through it carries light of its hero alone, whose colour is
// out of gamut: pixels that few paths reach have a channel below 0. Four wavelengths together are never so pure.
TEST(Layers, DispersedCausticsAreOfPureColors) {
  const Scene scene = test::scene_from_text(test::varied_room);
  for (const char* integrator : {"probppm", "bdpt", "vcm", "bpm", "mlt", "mlt:over=path"}) {
    RenderOptions options = test::options_for(integrator, 1, 1);
    options.color = ColorMode::spectral;
    options.max_depth = 5;
    options.photons = 20'000;
    if (test::has_radius(integrator)) options.set["radius"] = "0.05";
    const Image caustic = *select_layer(test::render_image(scene, options), "caustic");
    float purest = 0;
    for (std::size_t i = 0; i < caustic.pixels.size(); i += 3) {
      const Vec3 color(caustic.pixels[i], caustic.pixels[i + 1], caustic.pixels[i + 2]);
      const float size = std::sqrt(length_squared(color));
      if (size > 0) purest = std::min(purest, std::min({color.x, color.y, color.z}) / size);
    }
    EXPECT_LT(purest, -0.1f) << integrator;
  }
}

// Light is in the class of its path, whichever technique finds it. A glass ball under a lamp that path can hit: a fifth
// of the light that the camera sees is its caustic.
TEST(Layers, AgreeWithPath) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 1 1.4  0 0 0  0 1 0
Camera "perspective" "float fov" [36]
Film "rgb" "integer xresolution" [16] "integer yresolution" [16]
WorldBegin
)" + area_light +
      walls +
      R"(Material "dielectric" "float eta" [1.5]
Translate 0 0.4 0
Shape "sphere" "float radius" [0.3]
)");
  const auto render_runs = [&](const std::string& integrator, std::uint64_t passes, std::uint64_t first_seed) {
    RenderOptions options = test::options_for(integrator, passes);
    options.max_depth = 4;
    options.color = ColorMode::rgb;
    options.photons = 2'000;
    if (test::has_radius(integrator)) options.set["radius"] = "0.02";
    return test::independent_renders(scene, options, 16, first_seed);
  };
  const std::vector<Image> reference = render_runs("path", 128, 100);
  for (const char* integrator : {"bdpt", "vcm", "mlt", "mlt:over=path"}) {
    const std::vector<Image> images = render_runs(integrator, 16, 200);
    for (const char* layer : {"emission", "direct", "indirect", "caustic"})
      EXPECT_TRUE(test::tiles_agree(test::select_layers(images, layer), test::select_layers(reference, layer),
                                    test::false_alarm_rate / 16))
          << integrator << ", " << layer;
  }
}

}  // namespace
}  // namespace lanthorn::agreement_test
