// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <utility>

#include "lanthorn/description_data.h"
#include "lanthorn/error.h"

namespace lanthorn::partial_description_test {
namespace {

using plain::Dict;
using plain::Value;

Dict dict(std::initializer_list<std::pair<const char*, Value>> entries) {
  Dict result;
  for (const auto& [name, value] : entries) result.set(name, value);
  return result;
}

Dict lamp(double scale) {
  return dict({{"type", std::string("point")}, {"intensity", dict({{"spectrum", 1.0}, {"scale", scale}})}});
}
Dict ball(const char* material) {
  return dict({{"shapes", plain::List{dict({{"type", std::string("sphere")}, {"material", std::string(material)}})}}});
}
Dict camera(double fov) { return dict({{"type", std::string("perspective")}, {"fov", fov}}); }

Dict everything() {
  return dict({{"camera", camera(40)},
               {"film", dict({{"width", std::int64_t{30}}, {"height", std::int64_t{20}}})},
               {"materials", dict({{"red", dict({{"type", std::string("diffuse")}})}})},
               {"objects", dict({{"ball", ball("red")}})},
               {"instances", dict({{"first", dict({{"object", std::string("ball")}})}})},
               {"lights", dict({{"lamp", lamp(1)}})}});
}

bool have_same_surfaces(const SceneDescription& a, const SceneDescription& b) {
  return is_same(a.materials, b.materials) && is_same(a.objects, b.objects) && is_same(a.instances, b.instances);
}

TEST(PartialDescription, ACameraChangesNoTable) {
  PartialDescription scene(everything());
  const SceneDescription before = scene.description();
  ASSERT_TRUE(scene.read_again(dict({{"camera", camera(60)}})));
  const SceneDescription& now = scene.description();
  EXPECT_EQ(std::get<description::PerspectiveCamera>(now.view.camera.node).fov, 60);
  EXPECT_EQ(now.view.film.width, 30);
  EXPECT_TRUE(have_same_surfaces(now, before) && is_same(now.lights, before.lights));
}

TEST(PartialDescription, ANewLampChangesOnlyLights) {
  PartialDescription scene(everything());
  const SceneDescription before = scene.description();
  ASSERT_TRUE(scene.read_again(dict({{"lights", dict({{"lamp", lamp(1)}, {"other", lamp(2)}})}})));
  EXPECT_EQ(scene.description().lights.size(), 2u);
  EXPECT_TRUE(have_same_surfaces(scene.description(), before));
}

// What an update leaves out has its default value, as if all had been read at once.
TEST(PartialDescription, PartsAreReplacedAsAWhole) {
  PartialDescription scene(everything());
  ASSERT_TRUE(scene.read_again(dict({{"film", dict({{"height", std::int64_t{10}}})}})));
  EXPECT_EQ(scene.description().view.film.width, description::Film().width);
  EXPECT_EQ(scene.description().view.film.height, 10);
}

TEST(PartialDescription, EntriesThatMoveNeedAllToBeRead) {
  PartialDescription scene(everything());
  const Dict materials =
      dict({{"blue", dict({{"type", std::string("diffuse")}})}, {"red", dict({{"type", std::string("diffuse")}})}});
  EXPECT_FALSE(scene.read_again(dict({{"materials", materials}})));
  EXPECT_FALSE(scene.read_again(dict({{"media", dict({{"fog", dict({{"sigma_a", 1.0}})}})}})));
  EXPECT_EQ(scene.description().materials.size(), 1u);
  EXPECT_TRUE(scene.description().media.empty());
}

TEST(PartialDescription, ErrorsChangeNothing) {
  PartialDescription scene(everything());
  const SceneDescription before = scene.description();
  EXPECT_THROW(scene.read_again(dict({{"objects", dict({{"ball", ball("green")}})}})), Error);
  EXPECT_THROW(scene.read_again(dict({{"camera", camera(60)}, {"lamps", Dict()}})), Error);
  EXPECT_EQ(std::get<description::PerspectiveCamera>(scene.description().view.camera.node).fov, 40);
  EXPECT_TRUE(have_same_surfaces(scene.description(), before));
}

}  // namespace
}  // namespace lanthorn::partial_description_test
