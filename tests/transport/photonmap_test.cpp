// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Two-pass photon mapping: its terms, the display of its maps, and the effects of its shortcuts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/metrics.h"
#include "support/open_box.h"
#include "support/runs.h"
#include "support/shapes.h"
#include "support/varied_room.h"

namespace lanthorn::photonmap_test {
namespace {

using test::box, test::camera, test::mean_of;

RenderOptions options_of(const std::string& integrator, std::uint64_t passes) {
  RenderOptions options = test::options_for(integrator, passes, 3);
  options.color = ColorMode::rgb;
  options.photons = 20'000;
  options.max_depth = 5;
  return options;
}

Image render_with(const Scene& scene, const std::string& integrator, std::uint64_t passes,
                  const char* layer = "color") {
  return *select_layer(test::render_image(scene, options_of(integrator, passes)), layer);
}

std::vector<Image> runs(const Scene& scene, const std::string& integrator, std::uint64_t passes, const char* layer,
                        std::uint64_t first_seed = 100, std::uint64_t count = 16) {
  return test::select_layers(test::independent_renders(scene, options_of(integrator, passes), count, first_seed),
                             layer);
}

TEST(PhotonMap, TermsAndEmissionAreThePicture) {
  const Scene scene = test::scene_from_text(test::varied_room);
  for (const ColorMode color : {ColorMode::rgb, ColorMode::spectral}) {
    RenderOptions options = test::options_for("photonmap:gather=2", 2, 1);
    options.color = color;
    options.photons = 20'000;
    const Image image = test::render_image(scene, options), all = *select_layer(image, "color");
    std::vector<double> rest(all.pixels.begin(), all.pixels.end());
    for (const char* layer : {"emission", "term.A", "term.B", "term.C", "term.D"}) {
      const Image part = *select_layer(image, layer);
      EXPECT_GT(*std::max_element(part.pixels.begin(), part.pixels.end()), 0) << layer;
      for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= static_cast<double>(part.pixels[i]);
    }
    for (const double x : rest) ASSERT_NEAR(x, 0, 1e-5);
  }
}

// With only diffuse surfaces: light scattered once is A, light scattered more often D.
TEST(PhotonMap, TermsOfDiffuseSurfacesAreLayers) {
  const Scene scene = test::scene_from_text(camera + box);
  RenderOptions options = test::options_for("photonmap", 2, 1);
  options.photons = 20'000;
  const Image image = test::render_image(scene, options);
  EXPECT_EQ(select_layer(image, "term.A")->pixels, select_layer(image, "direct")->pixels);
  EXPECT_EQ(select_layer(image, "term.D")->pixels, select_layer(image, "indirect")->pixels);
  EXPECT_GT(mean_of(*select_layer(image, "term.D")), 0.01);
}

// Half of it is found by rays that leave the scene.
TEST(PhotonMap, LightOfTheSkyIsDirect) {
  const Scene scene = test::scene_from_text(camera + R"(LightSource "infinite" "rgb L" [1 1 1]
Material "conductor" "float roughness" [0.02]
)" + test::patch("-9 0 -9  9 0 -9  -9 0 9  9 0 9"));
  EXPECT_GT(mean_of(render_with(scene, "photonmap", 1, "direct")), 0.1);
  EXPECT_EQ(mean_of(render_with(scene, "photonmap", 1, "term.B")), 0);
}

// With the same photons, the means agree up to the difference between the record at the nearest photon and an estimate
// in place.
TEST(PhotonMap, PrecomputedIrradianceLeavesTheMean) {
  const Scene scene = test::scene_from_text(camera + box);
  const std::vector<Image> estimated = runs(scene, "photonmap:irradiance=estimated", 1, "term.D");
  EXPECT_TRUE(test::runs_agree(test::paired_ratio(runs(scene, "photonmap", 1, "term.D"), estimated), 1, 0.015, 0.02));
}

// Radiance of a ceiling 3 m above a floor, x metres from the axis of a spotlight that lights a disc on the floor:
// irradiance I cos³/h² there, scattered once by the floor and once by the ceiling (both of reflectance 1/2).
double radiance_of_ceiling(double x, double cone_degrees) {
  constexpr double intensity = 100, lamp = 2.9, ceiling = 3;
  constexpr int rings = 200, sectors = 64;
  const double radius = lamp * std::tan(cone_degrees * std::numbers::pi / 180), step = radius / rings;
  double irradiance = 0;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double s = (i + 0.5) * step, angle = 2 * std::numbers::pi * j / sectors;
      const double cos = lamp / std::hypot(lamp, s),
                   floor = 0.5 / std::numbers::pi * intensity * cos * cos * cos / (lamp * lamp);
      const double d2 = ceiling * ceiling + s * s + x * x - 2 * s * x * std::cos(angle);
      irradiance += floor * ceiling * ceiling / (d2 * d2) * s * step * 2 * std::numbers::pi / sectors;
    }
  return 0.5 / std::numbers::pi * irradiance;
}

// A spot lights a small part of a floor, and the ceiling sees it: records hold up to the edge of the light only. Beyond
// the edge, the largest radius is up to a quarter of the spot's.
TEST(NightlyPhotonMap, PrecomputedIrradianceEndsAtTheEdgeOfTheLight) {
  for (const double cone : {10.0, 3.0}) {
    const Scene scene = test::scene_from_text(
        R"(LookAt 0 1.5 0  0 3 0  0 0 1
Camera "perspective" "float fov" [4]
Film "rgb" "integer xresolution" [8] "integer yresolution" [8]
PixelFilter "box" "float xradius" [0.5] "float yradius" [0.5]
WorldBegin
LightSource "spot" "rgb I" [100 100 100] "point3 from" [0 2.9 0] "point3 to" [0 0 0] "float coneangle" [)" +
        std::to_string(cone) +
        R"(] "float conedeltaangle" [0.001]
Material "diffuse" "rgb reflectance" [.5 .5 .5]
)" + test::patch("-3 0 -3  3 0 -3  -3 0 3  3 0 3") +
        test::patch("-3 3 -3  3 3 -3  -3 3 3  3 3 3"));
    for (const char* integrator :
         {"photonmap", "photonmap:nearest=0", "photonmap:final-gather=cached", "reversephotonmap"}) {
      RenderOptions options = options_of(integrator + std::string(":gather=256"), 1);
      options.max_depth = 2;
      const std::vector<Image> found = test::independent_renders(scene, options, 16, 100);
      // At most 5 cm from the axis, where radiance changes by 0.1 %.
      EXPECT_TRUE(test::runs_agree(test::mean_of_means(test::select_layers(found, "color")),
                                   radiance_of_ceiling(0.025, cone), 0.01, 0.05))
          << integrator << ' ' << cone;
    }
  }
}

// An infinitely thin wall between a lit room and a dark one. The floor ends at the wall.
TEST(PhotonMap, WallsDoNotLeak) {
  const std::string text =
      R"(LookAt 0 1 -3  0 1 0  0 1 0
Camera "perspective" "float fov" [30]
Film "rgb" "integer xresolution" [16] "integer yresolution" [16]
WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [17 12 4]
Translate 0 1 1.5
Shape "sphere" "float radius" [0.2]
AttributeEnd
Material "diffuse" "rgb reflectance" [0.7 0.7 0.7]
)" + test::patch("-9 -9 0  9 -9 0  -9 9 0  9 9 0") +
      test::patch("-9 0 0  9 0 0  -9 0 3  9 0 3");
  const Scene scene = test::scene_from_text(text);
  for (const char* integrator : {"photonmap", "photonmap:show=global", "photonmap:nearest=0:max-radius=0.5"}) {
    const Image image = render_with(scene, integrator, 1);
    EXPECT_EQ(*std::max_element(image.pixels.begin(), image.pixels.end()), 0) << integrator;
  }
  const std::string from_the_other_side = "LookAt 0 1 3  0 1 0  0 1 0" + text.substr(text.find('\n'));
  EXPECT_GT(mean_of(render_with(test::scene_from_text(from_the_other_side), "photonmap:show=global", 1)), 0.1);
}

// The whole map's density on the floor, in place: flux over area.
TEST(PhotonMap, ShowsItsMaps) {
  const Scene scene = test::scene_from_text(camera + box);
  const Image density = render_with(scene, "photonmap:show=density:nearest=50", 1);
  const Image radius = render_with(scene, "photonmap:show=radius:nearest=50", 1);
  const std::size_t floor = 3 * (20 * 24 + 12);  // well within its edges
  // Consistent kernels do not count the 50th photon.
  EXPECT_NEAR(static_cast<double>(density.pixels[floor] * pi * sqr(radius.pixels[floor])), 49, 0.1);
  EXPECT_EQ(mean_of(render_with(scene, "photonmap:show=caustic", 1, "caustic")), 0);
  EXPECT_GT(mean_of(render_with(scene, "photonmap:show=global", 1, "indirect")), 0.05);
}

TEST(PhotonMap, KeptMapsAreOfOnePass) {
  const Scene scene = test::scene_from_text(camera + box);
  const Image once = render_with(scene, "photonmap:maps=kept:show=density", 1);
  const Image first = render_with(scene, "photonmap:show=density", 1);
  EXPECT_EQ(once.pixels, first.pixels);
  const auto floor_of = [](const Image& image) { return image.pixels[3 * (22 * 24 + 12)]; };
  const Image fresh = render_with(scene, "photonmap:show=density", 8),
              kept = render_with(scene, "photonmap:maps=kept:show=density", 8);
  EXPECT_NE(floor_of(fresh), floor_of(kept));
}

TEST(PhotonMap, KeptMapsNeedOneSetOfWavelengthsAndOneTime) {
  RenderOptions options = test::options_for("photonmap:maps=kept", 1, 1);
  options.color = ColorMode::spectral;
  EXPECT_THROW(test::render_state(test::scene_from_text(camera + box), options), Error);
  options.color = ColorMode::rgb;
  EXPECT_THROW(test::render_state(test::scene_from_text(test::varied_room), options), Error);  // moves
  EXPECT_NO_THROW(test::render_state(test::scene_from_text(camera + box), options));
}

// Half of the floor's light comes from the eye path and half from the maps, including caustics of a point light.
TEST(NightlyPhotonMap, SharesOfNarrowLobesAddUp) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 1 1.4  0 0 0  0 1 0
Camera "perspective" "float fov" [36]
Film "rgb" "integer xresolution" [32] "integer yresolution" [32]
WorldBegin
)" + box +
      R"(LightSource "point" "rgb I" [1 1 1] "point3 from" [0.4 1.6 0.3]
Material "coateddiffuse" "rgb reflectance" [0.4 0.4 0.4] "float roughness" [0.01]
)" + test::patch("-1 0.01 -1  1 0.01 -1  -1 0.01 1  1 0.01 1") +
      R"(Material "conductor" "float roughness" [0.01]
)" + test::patch("-1 0.02 -0.2  1 0.02 -0.2  -1 0.02 1  1 0.02 1") +
      R"(Material "dielectric" "float eta" [1.5]
Translate 0 0.4 0
Shape "sphere" "float radius" [0.3]
)");
  const std::string two_passes = "photonmap:nearest=0:caustic-nearest=0:max-radius=0.06:gather=4:irradiance=estimated";
  const auto all_layers = [&](const std::string& integrator) {
    return test::independent_renders(scene, options_of(integrator, 6), 32, 100);
  };
  const std::vector<Image> progressive = all_layers("probppm:radius=0.06:alpha=1"), in_two = all_layers(two_passes);
  for (const auto& [layer, noise] :
       {std::pair<const char*, double>{"direct", 0.1}, {"indirect", 0.25}, {"caustic", 0.5}})
    EXPECT_TRUE(test::runs_agree(
        test::paired_ratio(test::select_layers(in_two, layer), test::select_layers(progressive, layer)), 1, 0.01, noise,
        test::false_alarm_rate / 3))
        << layer;
}

// So many gather rays that the map is hardly used, under a sky that continued rays would hit, too.
TEST(PhotonMap, ShortRaysFindWhatTheMapWouldTell) {
  const Scene scene = test::scene_from_text(camera + R"(LightSource "infinite" "rgb L" [1 1 1]
)" + box);
  const std::vector<Image> expected = runs(scene, "path", 4, "indirect", 100, 32);
  EXPECT_TRUE(test::runs_agree(test::mean_of_means(runs(scene, "photonmap:max-radius=4", 1, "indirect", 200, 24)),
                               test::mean_of_means(expected), 0.005, 0.15));
}

// Separate caustic paths are another estimate of the same caustics.
TEST(PhotonMap, CausticPhotonsLeaveTheMean) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 1 1.4  0 0 0  0 1 0
Camera "perspective" "float fov" [36]
Film "rgb" "integer xresolution" [32] "integer yresolution" [32]
WorldBegin
)" + box +
      R"(Material "dielectric" "float eta" [1.5]
Translate 0 0.4 0
Shape "sphere" "float radius" [0.3]
)");
  // With a fixed radius: the reach of the nearest photons, and so the blur, depends on their number.
  const std::string fixed = "photonmap:gather=1:caustic-nearest=0:max-radius=0.05";
  const std::vector<Image> shared = runs(scene, fixed, 1, "term.C", 100, 32),
                           own = runs(scene, fixed + ":caustic-photons=40000", 1, "term.C", 100, 32);
  EXPECT_GT(test::mean_of_means(shared).mean(), 0.01);
  EXPECT_TRUE(test::runs_agree(test::paired_ratio(own, shared), 1, 0, 0.3));
}

// Means of tiles of 8 x 8 pixels, all channels.
std::vector<double> tile_means(const Image& image) {
  const std::size_t columns = static_cast<std::size_t>(image.width) / 8,
                    rows = static_cast<std::size_t>(image.height) / 8;
  std::vector<double> means(3 * columns * rows);
  for (std::size_t y = 0; y < 8 * rows; ++y)
    for (std::size_t x = 0; x < 8 * columns; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        means[3 * (y / 8 * columns + x / 8) + c] +=
            static_cast<double>(image.pixels[3 * (y * static_cast<std::size_t>(image.width) + x) + c]) / 64;
  return means;
}

// Fine enough for such small pictures.
const std::string cached = "photonmap:final-gather=cached:cache-error=0.15:cache-min-spacing=0.5:cache-rays=256";

// Also in corners and at the block's edges. Interpolation may change tiles by 1.5 %, the whole by 0.4 %.
TEST(PhotonMap, CachedGathersLeaveTheMean) {
  const Scene scene = test::scene_from_text(camera + box + R"(Translate -0.2 0.3 0
Rotate 20 0 1 0
Material "diffuse" "rgb reflectance" [0.2 0.5 0.7]
)" + test::patch("-0.3 -0.3 0.3  0.3 -0.3 0.3  -0.3 0.3 0.3  0.3 0.3 0.3") +
                                            test::patch("-0.3 0.3 -0.3  0.3 0.3 -0.3  -0.3 0.3 0.3  0.3 0.3 0.3") +
                                            test::patch("0.3 -0.3 -0.3  0.3 -0.3 0.3  0.3 0.3 -0.3  0.3 0.3 0.3"));
  const std::vector<Image> brute = runs(scene, "photonmap:gather=48", 2, "term.D"),
                           interpolated = runs(scene, cached, 2, "term.D");
  const double rate = test::false_alarm_rate / 28;
  EXPECT_TRUE(test::runs_agree(test::paired_ratio(interpolated, brute), 1, 0.004, 0.03, rate));
  std::vector<test::Mean> differences(tile_means(brute[0]).size()), expected = differences;
  for (std::size_t run = 0; run < brute.size(); ++run) {
    const std::vector<double> without = tile_means(brute[run]), with = tile_means(interpolated[run]);
    for (std::size_t i = 0; i < without.size(); ++i) {
      expected[i].add(without[i]);
      differences[i].add(with[i] - without[i]);
    }
  }
  const double least = 0.002 * test::mean_of_means(brute).mean();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double allowed = test::t_limit(rate, 15) * differences[i].error();
    EXPECT_TRUE(test::within(differences[i].mean(), 0, 0.015 * expected[i].mean() + least + allowed)) << i;
    EXPECT_LT(allowed, 0.2 * expected[i].mean() + least) << i;
  }
  EXPECT_EQ(render_with(scene, "photonmap:gather=64", 1, "term.A").pixels,
            render_with(scene, cached + ":gather=64", 1, "term.A").pixels);
}

// Tests cached gathers in mirrors and in motion, in both colour modes, and at a depth at which gather rays end.
TEST(PhotonMap, CachedGathersBehindMirrors) {
  const Scene scene = test::scene_from_text(camera + box +
                                            R"(AttributeBegin
Material "diffuse" "rgb reflectance" [0.2 0.5 0.7]
ActiveTransform StartTime
Translate -0.3 0.4 0
ActiveTransform EndTime
Translate -0.1 0.4 0
ActiveTransform All
Shape "sphere" "float radius" [0.3]
AttributeEnd
Material "conductor" "float roughness" [0]
Translate 0.5 0.4 -0.2
Shape "sphere" "float radius" [0.4]
)");
  for (const ColorMode color : {ColorMode::rgb, ColorMode::spectral}) {
    const int depth = color == ColorMode::rgb ? 3 : 6;
    const auto pictures = [&](const std::string& integrator) {
      RenderOptions options = options_of(integrator, 1);
      options.color = color;
      options.max_depth = depth;
      return test::independent_renders(scene, options, 16, 100);
    };
    const std::vector<Image> brute = pictures("photonmap:gather=32"),
                             interpolated = pictures(cached + ":cache-rays=128:gather=32");
    for (const char* layer : {"term.D", "term.B"})
      EXPECT_TRUE(test::runs_agree(
          test::paired_ratio(test::select_layers(interpolated, layer), test::select_layers(brute, layer)), 1, 0.005,
          0.08, test::false_alarm_rate / 4))
          << layer << ' ' << depth;
  }
}

// Behind a glass ball, a fifth of `indirect`, and out of focus, where the points seen by a pixel are far apart.
TEST(PhotonMap, CachedGathersBehindGlassAndOutOfFocus) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 1 4.4  0 1 0  0 1 0
Camera "perspective" "float fov" [36] "float lensradius" [0.1] "float focaldistance" [2.5]
Film "rgb" "integer xresolution" [24] "integer yresolution" [24]
PixelFilter "box"
WorldBegin
)" + box +
      R"(Material "dielectric" "float eta" [1.5]
Translate 0.3 0.7 0.6
Shape "sphere" "float radius" [0.5]
)");
  const auto pictures = [&](const std::string& integrator, std::uint64_t first_seed) {
    RenderOptions options = options_of(integrator, 2);
    options.max_depth = 6;
    return test::independent_renders(scene, options, 16, first_seed);
  };
  const std::vector<Image> brute = pictures("photonmap:gather=32", 100),
                           interpolated = pictures(cached + ":gather=32", 200);
  const double rate = test::false_alarm_rate / 4;
  for (const char* layer : {"term.D", "indirect"}) {
    const std::vector<Image> expected = test::select_layers(brute, layer),
                             found = test::select_layers(interpolated, layer);
    EXPECT_TRUE(test::tiles_agree(found, expected, rate)) << layer;
    EXPECT_TRUE(test::runs_agree(test::mean_of_means(found), test::mean_of_means(expected), 0.005, 0.1, rate)) << layer;
  }
}

// With room for few records, points seen later between them are gathered in full.
TEST(PhotonMap, KeptCachesLeaveTheMean) {
  const Scene scene = test::scene_from_text(camera + box);
  const std::vector<Image> expected = runs(scene, "photonmap:maps=kept:gather=64", 2, "term.D", 100, 8),
                           found = runs(scene, cached + ":maps=kept:cache-rays=1024", 2, "term.D", 100, 8);
  EXPECT_TRUE(test::runs_agree(test::paired_ratio(found, expected), 1, 0.006, 0.04));
}

TEST(PhotonMap, ShowsItsRecords) {
  const Scene scene = test::scene_from_text(camera + box);
  const std::string show = cached + ":cache-min-spacing=1.5:show=records";
  const Image few = render_with(scene, show + ":cache-error=0.6", 1, "indirect");
  const Image many = render_with(scene, show, 1, "indirect");
  EXPECT_GT(mean_of(few), 0.005);
  EXPECT_GT(mean_of(many), 1.5 * mean_of(few));  // more dots
  EXPECT_THROW(render_with(scene, "photonmap:show=records", 1), Error);
}

TEST(PhotonMap, RefusesCachesThatCannotBe) {
  const Scene scene = test::scene_from_text(camera + box);
  for (const char* parameter : {"final-gather=some", "cache-error=0", "cache-error=1.5", "cache-min-spacing=0",
                                "cache-min-spacing=50", "cache-max-spacing=2", "cache-rays=3"})
    EXPECT_THROW(render_with(scene, "photonmap:final-gather=cached:" + std::string(parameter), 1), Error) << parameter;
}

// A ball above the floor, and its illumination on the right.
std::string shaded_box(const std::string& light) {
  return camera + light + R"(Material "diffuse" "rgb reflectance" [0.7 0.7 0.7]
)" + test::patch("-1 0 -1  1 0 -1  -1 0 1  1 0 1") +
         test::patch("-1 0 -1  1 0 -1  -1 2 -1  1 2 -1") +
         R"(AttributeBegin
Translate 0 0.7 0
Shape "sphere" "float radius" [0.4]
AttributeEnd
)";
}
const std::vector<std::string> lights_of_box{
    R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [17 12 4]
Translate 0.4 1.7 0.3
Shape "sphere" "float radius" [0.1]
AttributeEnd
)",
    R"(LightSource "point" "point3 from" [0.4 1.7 0.3]
LightSource "point" "point3 from" [-0.4 1.7 0.6]
)",
    R"(LightSource "distant" "point3 from" [1 3 2]
)"};

TEST(PhotonMap, ShadowPhotonsSpareShadowRays) {
  for (const std::string& light : lights_of_box) {
    const Scene scene = test::scene_from_text(shaded_box(light));
    const std::string shadows = "photonmap:gather=1:shadows=photons:max-radius=0.25";
    const std::vector<Image> by_rays = runs(scene, "photonmap:gather=1", 1, "term.A", 100, 8),
                             by_photons = runs(scene, shadows, 1, "term.A", 100, 8);
    // Both renders use the same samples: the difference is the part of thin shadows that the search radius removes.
    EXPECT_TRUE(test::runs_agree(test::paired_ratio(by_photons, by_rays), 1, 0.004, 0.03)) << light;

    RenderPlan plan = test::plan_render(scene, options_of(shadows, 1));
    const RenderStatistics statistics = render(scene, plan, plan.stop);
    EXPECT_GT(statistics.rays.spared, statistics.rays.shadow) << light;
  }
}

TEST(PhotonMap, ShowsShadows) {
  const Scene scene = test::scene_from_text(shaded_box(lights_of_box[1]));
  const Image shares = render_with(scene, "photonmap:show=shadow:max-radius=0.1", 1, "direct");
  const auto [least, most] = std::minmax_element(shares.pixels.begin(), shares.pixels.end());
  EXPECT_EQ(*least, 0);
  EXPECT_EQ(*most, 1);
  EXPECT_GT(mean_of(shares), 0.1);
}

}  // namespace
}  // namespace lanthorn::photonmap_test
