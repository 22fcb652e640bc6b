// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/scene.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lanthorn::light_names_test {

namespace {

std::vector<std::string> words_of(const std::string& lights, const std::string& camera) {
  const std::string room = R"(
WorldBegin
Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [-2 -2 -2  2 -2 -2  2 2 2]
)";
  std::vector<std::string> words;
  for (const NamedLight& light : lights_of(*build_scene(read_pbrt_string(camera + room + lights, ".", "room.pbrt"))))
    words.push_back(light.id + ": " + light.words);
  return words;
}

std::string lamp(const std::string& points) {
  return R"(AttributeBegin AreaLightSource "diffuse" Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" )"
         "[" +
         points + "] AttributeEnd\n";
}

using Words = std::vector<std::string>;
// pbrt's coordinates are left-handed: seen from +z with y up, -x is on the right.
const std::string y_up = R"(LookAt 0 0 9  0 0 0  0 1 0
Camera "perspective"
)";

TEST(LightNames, SayWhereALightIs) {
  const std::string lights = lamp("0 1.9 0  1 1.9 0  0 1.9 1") + lamp("0 -1.9 0  1 -1.9 0  0 -1.9 1") +
                             lamp("-1.9 0 0  -1.9 1 0  -1.9 0 1") +
                             R"(LightSource "point" "point3 from" [1.5 0 0]
)" + R"(LightSource "point" "point3 from" [0 0 -1.5]
)" +
                             R"(LightSource "spot" "point3 from" [.1 .1 .1]
LightSource "infinite"
)";
  EXPECT_EQ(words_of(lights, y_up), (Words{"area1: Lamp 1, ceiling", "area2: Lamp 2, floor", "area3: Lamp 3, right",
                                           "light1: Point light 1, left", "light2: Point light 2, back",
                                           "light3: Spot light, middle", "light4: Environment"}));
}

TEST(LightNames, UpIsWhereTheCameraHasIt) {
  const std::string lights = lamp("0 0 1.9  1 0 1.9  0 1 1.9") + lamp("1.9 0 0  1.9 1 0  1.9 0 1");
  EXPECT_EQ(words_of(lights, R"(LookAt 0 -9 0  0 0 0  0 0 1
Camera "perspective"
)"),
            (Words{"area1: Lamp 1, ceiling", "area2: Lamp 2, left"}));
  EXPECT_EQ(words_of(lights, R"(LookAt 0 9 0  0 0 0  0 0 1
Camera "perspective"
)"),
            (Words{"area1: Lamp 1, ceiling", "area2: Lamp 2, right"}));
}

TEST(LightNames, AreThoseOfTheFilesMaterials) {
  const std::string lights = R"(MakeNamedMaterial "neon" "string type" "diffuse"
NamedMaterial "neon"
)" + lamp("0 1.9 0  1 1.9 0  0 1.9 1") +
                             lamp("0 0 -1.9  1 0 -1.9  0 1 -1.9");
  EXPECT_EQ(words_of(lights, y_up), (Words{"area1: neon 1, ceiling", "area2: neon 2, back"}));
}

}  // namespace

}  // namespace lanthorn::light_names_test
