// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Replacing a scene's environment: orientation, and built-in environments.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>

#include "lanthorn/error.h"
#include "lanthorn/ibl.h"
#include "lanthorn/image_file.h"
#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "lanthorn/state.h"
#include "light/light.h"
#include "math/octahedral.h"
#include "scene/scene.h"
#include "staging/environments.h"
#include "support/gltf_writer.h"
#include "support/temporary_dir.h"

namespace lanthorn::environment_test {
namespace {

// A smooth function that gives each direction of the environment its own colour.
Rgb colour_of(const Vec3& d) { return {1.5f + d.x, 1.5f + d.y, 1.5f + d.z}; }

template <class Direction>
Image painted(int width, int height, Direction&& direction) {
  Image image(width, height, {"R", "G", "B"});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Rgb c = colour_of(direction((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                                        (static_cast<float>(y) + 0.5f) / static_cast<float>(height)));
      image.at(x, y, 0) = c.r, image.at(x, y, 1) = c.g, image.at(x, y, 2) = c.b;
    }
  return image;
}
// In the layout of lanthorn/ibl.h.
Image equirectangular() {
  return painted(128, 64, [](float u, float v) {
    const float azimuth = 2 * pi * u - pi, polar = pi * v;
    return Vec3(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth));
  });
}
Image octahedral() {
  return painted(128, 128, [](float u, float v) {
    const lanthorn::Direction d = direction_from_octahedral({u, v});
    return Vec3(d.x, d.z, -d.y);
  });
}
// OpenGL's faces.
Image cube() {
  return painted(6 * 32, 32, [](float u, float v) {
    const int face = static_cast<int>(6 * u);
    const float s = 2 * (6 * u - static_cast<float>(face)) - 1, t = 2 * v - 1;
    const Vec3 faces[] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
    return normalize(faces[face]);
  });
}

class Environment : public testing::Test {
 protected:
  Environment() {
    test::GltfWriter model;
    model.mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
    model.node({{"mesh", 0}});
    dir_.write("model.gltf", model.text());
    dir_.write("zup.pbrt", R"(LookAt 0 -4 1  0 0 1  0 0 1
Camera "perspective"
WorldBegin
)" + lights_);
    dir_.write("mirrored.pbrt",
               R"(Scale -1 1 1
LookAt 0 1 4  0 1 0  0 1 0
Camera "perspective"
WorldBegin
)" + lights_);
  }
  std::string file(const Image& image) const {
    write_exr(dir_.path() / "sky.exr", image);
    return (dir_.path() / "sky.exr").string();
  }
  SceneDescription read(const std::string& name, const EnvironmentChoice& choice) const {
    return read_scene(dir_.path() / name, {.environment = choice});
  }
  // Radiance from a direction of the world, from the only environment.
  static Rgb light_from(const SharedScene& scene, const Vec3& towards) {
    Rgb sum;
    int environments = 0;
    for (const Light& light : scene->lights())
      if (const auto* sky = std::get_if<ImageSky>(&light)) {
        const Spectrum s = sky->emitted(Point(0), normalize(towards), Wavelengths::rgb(0.5f));
        sum = {s[0], s[1], s[2]};
        ++environments;
      }
    EXPECT_EQ(environments, 1);
    return sum;
  }
  // In the world's direction `shown` the environment's direction `painted` is visible.
  static void expect(const SharedScene& scene, const Vec3& shown, const Vec3& painted, float scale = 1) {
    const Rgb light = light_from(scene, shown), expected = scale * colour_of(normalize(painted));
    constexpr float tolerance = 0.03f;
    EXPECT_NEAR(light.r, expected.r, tolerance * scale) << shown.x << ' ' << shown.y << ' ' << shown.z;
    EXPECT_NEAR(light.g, expected.g, tolerance * scale) << shown.x << ' ' << shown.y << ' ' << shown.z;
    EXPECT_NEAR(light.b, expected.b, tolerance * scale) << shown.x << ' ' << shown.y << ' ' << shown.z;
  }

  const std::string lights_ =
      R"(LightSource "point"
LightSource "infinite"
LightSource "distant"
LightSource "infinite"
Shape "sphere"
)";
  test::TemporaryDir dir_;
};

const std::vector<Vec3> directions{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {1, 2, 3}, {-3, 1, -2}, {2, -2, 1}};

TEST_F(Environment, StandsAsTheMapsOfIblDo) {
  for (const Image& image : {equirectangular(), octahedral(), cube()}) {
    const SharedScene scene = build_scene(read("model.gltf", {.source = file(image)}));
    for (const Vec3& d : directions) expect(scene, d, d);
  }
}

TEST_F(Environment, IsTurnedAndScaled) {
  const SharedScene scene =
      build_scene(read("model.gltf", {.source = file(equirectangular()), .rotation = 90, .scale = 3}));
  // Counter-clockwise seen from above: +x turns to -z, +z to +x.
  for (const Vec3& d : directions) expect(scene, {d.z, d.y, -d.x}, d, 3);
  const SharedScene upright = build_scene(read("model.gltf", {.source = file(equirectangular()), .up = UpAxis::z}));
  for (const Vec3& d : directions) expect(upright, {d.x, -d.z, d.y}, d);
}

// The camera looks along +y in a left-handed world, so its right is +x. It sees the picture unmirrored.
TEST_F(Environment, OfPbrtFilesStandsAsTheCameraDoes) {
  SceneDescription zup = read("zup.pbrt", {.source = file(equirectangular())});
  ASSERT_FALSE(zup.warnings.empty());
  EXPECT_NE(zup.warnings.back().message.find("+z is up"), std::string::npos) << zup.warnings.back().message;
  EXPECT_NE(zup.warnings.back().message.find("use --environment-up y to change it"), std::string::npos);
  const Transform to_world = zup.view.camera.camera_to_world.start;
  const SharedScene scene = build_scene(std::move(zup));
  expect(scene, {0, 0, 1}, {0, 1, 0});
  expect(scene, {1, 0, 0}, {1, 0, 0});
  // On the right of +x, in the camera's sense, is the environment's +z.
  const Vec3 right = to_world.vector({1, 0, 0}), up = to_world.vector({0, 1, 0}), forward = to_world.vector({0, 0, 1});
  const float handedness = dot(cross(forward, up), right);  // +1: right-handed
  expect(scene, handedness * cross(Vec3(1, 0, 0), Vec3(0, 0, 1)), {0, 0, 1});
  const SharedScene y_up = build_scene(read("zup.pbrt", {.source = file(equirectangular()), .up = UpAxis::y}));
  expect(y_up, {0, 1, 0}, {0, 1, 0});
  // A right-handed world, as in most converted scenes, is treated like the world of glTF.
  const SharedScene mirrored = build_scene(read("mirrored.pbrt", {.source = file(equirectangular()), .rotation = 90}));
  for (const Vec3& d : directions) expect(mirrored, {d.z, d.y, -d.x}, d);
}

TEST_F(Environment, TakesThePlaceOfEnvironmentsAlone) {
  const SceneDescription scene = read("zup.pbrt", {.source = "overcast", .up = UpAxis::z});
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_TRUE(std::holds_alternative<description::PointLight>(scene.lights[0].node));
  EXPECT_TRUE(std::holds_alternative<description::InfiniteLight>(scene.lights[1].node));
  EXPECT_TRUE(std::get<description::InfiniteLight>(scene.lights[1].node).texels);
  EXPECT_TRUE(std::holds_alternative<description::DistantLight>(scene.lights[2].node));
  // No studio, and the exposure is measured.
  const SceneDescription model = read("model.gltf", {.source = "overcast"});
  EXPECT_EQ(model.lights.size(), 1u);
  EXPECT_TRUE(model.view.film.measures_exposure);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_EQ(model.warnings[0].message.find("studio"), std::string::npos) << model.warnings[0].message;
}

TEST_F(Environment, AnotherOneIsAnotherScene) {
  const auto hash = [&](const EnvironmentChoice& choice) {
    RenderOptions options;
    options.integrator = "path";
    const Session session(build_scene(read("model.gltf", choice)), options);
    return summarize(session.state()).record.identity.scene_hash;
  };
  const std::string plain = hash({});
  EXPECT_EQ(hash({.source = "studio"}), hash({.source = "studio"}));
  EXPECT_NE(hash({.source = "studio"}), plain);
  EXPECT_NE(hash({.source = "studio"}), hash({.source = "overcast"}));
  EXPECT_NE(hash({.source = "studio"}), hash({.source = "studio", .rotation = 1}));
  EXPECT_NE(hash({.source = "studio"}), hash({.source = "studio", .scale = 2}));
  const SceneDescription scene = read("model.gltf", {.source = file(equirectangular())});
  ASSERT_EQ(scene.files.size(), 1u);
  EXPECT_TRUE(scene.files.begin()->second.hash);
}

TEST_F(Environment, TheScenesOwnComesBack) {
  const SceneDescription own = read("zup.pbrt", {});
  SceneDescription scene = own;
  replace_environment(scene, {.source = file(equirectangular())});
  replace_environment(scene, {.source = "overcast", .rotation = 10});
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_TRUE(scene.files.empty()) << "the first picture's file is none of the scene's any more";
  EXPECT_EQ(scene.warnings.size(), own.warnings.size() + 1) << "one line says which way is up";
  replace_environment(scene, {});
  ASSERT_EQ(scene.lights.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(scene.lights[i].node.index(), own.lights[i].node.index());
  EXPECT_FALSE(std::get<description::InfiniteLight>(scene.lights[1].node).texels);
  EXPECT_EQ(scene.environment, EnvironmentChoice());
}

// The file is named by the user, not by the scene.
TEST_F(Environment, MayLieOutsideOfASandbox) {
  const test::TemporaryDir elsewhere;
  write_exr(elsewhere.path() / "sky.exr", equirectangular());
  ReadOptions options{.sandbox = true, .environment = {.source = (elsewhere.path() / "sky.exr").string()}};
  const SceneDescription scene = read_scene(dir_.path() / "model.gltf", options);
  EXPECT_TRUE(scene.files.begin()->second.hash);
  expect(build_scene(scene), {1, 0, 0}, {1, 0, 0});
}

TEST_F(Environment, BadOnesSayWhatWasExpected) {
  const auto message = [&](const EnvironmentChoice& choice) {
    try {
      read("model.gltf", choice);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(message({.rotation = 90}).find("expected --environment FILE"), std::string::npos);
  EXPECT_NE(message({.source = "nowhere.exr"}).find("nowhere.exr: no such file"), std::string::npos);
  const std::string odd = message({.source = file(Image(10, 4, {"R", "G", "B"}))});
  EXPECT_NE(odd.find("10 x 4 pixels; expected 2:1"), std::string::npos) << odd;
  EXPECT_NE(message({.source = "studio", .scale = -1}).find("a scale of 0 or more"), std::string::npos);
}

// Radiance of a white floor under an equirectangular picture with y up, and the part of it that comes from within half
// a degree of the brightest texel, the sun.
struct Floor {
  double radiance = 0, sun = 0;
  Vec3 brightest{0};
};
Floor floor_of(const Image& image) {
  Floor floor;
  const auto at = [&](int x, int y) {
    const float azimuth = 2 * pi * (static_cast<float>(x) + 0.5f) / static_cast<float>(image.width) - pi;
    const float polar = pi * (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height);
    return Vec3(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth));
  };
  const auto sum = [&](auto&& counts) {
    double total = 0;
    for (int y = 0; y < image.height / 2; ++y)
      for (int x = 0; x < image.width; ++x) {
        const Vec3 d = at(x, y);
        const double omega = 2 * 9.8696044 / image.width / image.height * std::sqrt(1 - static_cast<double>(d.y) * d.y);
        const Rgb c{image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
        if (counts(d)) total += omega * static_cast<double>(d.y * luminance(c)) / 3.14159265;
      }
    return total;
  };
  float most = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (image.at(x, y, 1) > most) most = image.at(x, y, 1), floor.brightest = at(x, y);
  floor.radiance = sum([](const Vec3&) { return true; });
  floor.sun = sum([&](const Vec3& d) { return dot(d, floor.brightest) > std::cos(to_radians(1.0f)); });
  return floor;
}

TEST(OwnEnvironments, LightAWhiteFloorWhite) {
  EXPECT_NEAR(floor_of(*own_environment("overcast")).radiance, 1, 0.01);
  const Floor sunny = floor_of(*own_environment("sunny"));
  EXPECT_NEAR(sunny.radiance, 1, 0.01);
  // On a clear day with the sun at 40 degrees, about four fifths of the light come from the sun.
  EXPECT_GT(sunny.sun, 0.65);
  EXPECT_LT(sunny.sun, 0.9);
  EXPECT_NEAR(std::asin(sunny.brightest.y), to_radians(40.0f), 0.01f);
  EXPECT_LT(sunny.brightest.x, 0);
  EXPECT_GT(sunny.brightest.z, 0);
}

TEST(OwnEnvironments, TheClearSkyIsBlueAndTheOvercastOneBrightestAbove) {
  const Image sunny = *own_environment("sunny"), overcast = *own_environment("overcast");
  // Opposite to the sun, 50 degrees above the horizon.
  const int x = static_cast<int>(0.875f * 1024), y = static_cast<int>(40.0f / 180 * 512);
  EXPECT_GT(sunny.at(x, y, 2), 1.8f * sunny.at(x, y, 0));
  // The zenith is three times as bright as the horizon (Moon & Spencer).
  EXPECT_NEAR(overcast.at(0, 0, 1) / overcast.at(0, 63, 1), 3, 0.1);
}

TEST(OwnEnvironments, HaveTheNamesThatAreTold) {
  for (const std::string& name : environment_names()) EXPECT_TRUE(own_environment(name)) << name;
  EXPECT_FALSE(own_environment("nosuch"));
}

}  // namespace
}  // namespace lanthorn::environment_test
