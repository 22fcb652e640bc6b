// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/medium_around.h"

#include <gtest/gtest.h>

#include <string>

#include "support/scene_text.h"

namespace lanthorn::media_check_test {
namespace {

const std::string view = R"(LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" [50])";
const std::string fog = R"(MakeNamedMedium "fog" "string type" "homogeneous"
)";
const std::string in_fog = R"(MediumInterface "fog" "fog"
)";
const std::string floor_of_fog = R"(Shape "bilinearmesh" "point3 P" [-1 -1 1  1 -1 1  -1 -1 -1  1 -1 -1]
)";

// A ball of fog that contains the shapes and lights of `in_it`. `prefix` comes before the ball's shape.
std::string ball(const std::string& in_it = "", const std::string& prefix = "") {
  return fog + R"(AttributeBegin MediumInterface "fog" "" Material "interface"
)" + prefix +
         R"(Shape "sphere" "float radius" 2
AttributeEnd
)" + in_it;
}

std::string warning_of(const std::string& directives, const std::string& head = view) {
  const Scene scene = test::world(directives, head);
  const std::vector<description::Warning> found = media_warnings(scene, make_view(scene.description().view));
  if (found.empty()) return "none";
  EXPECT_EQ(found.size(), 1u);
  return Error(found[0].location, found[0].message).what();
}

TEST(MediaCheck, FindsNothingWhereMediaFit) {
  const std::string light = R"(LightSource "point" "point3 from" [0 1 0]
)";
  EXPECT_EQ(warning_of(ball()), "none");
  EXPECT_EQ(warning_of(ball("", "ReverseOrientation Scale -1 1 1\n")), "none");  // pbrt-v4 flips mirrored quadrics
  EXPECT_EQ(warning_of(ball(in_fog + light + floor_of_fog)), "none");
  EXPECT_EQ(warning_of(ball(in_fog + R"(AreaLightSource "diffuse"
Shape "sphere" "float radius" 0.3
)")),
            "none");
  EXPECT_EQ(warning_of(ball(floor_of_fog + R"(LightSource "point" "point3 from" [0 1 4]
)")),
            "none");
  EXPECT_EQ(warning_of(ball(floor_of_fog + R"(LightSource "infinite"
LightSource "distant"
)")),
            "none");
  // A dense ball in the fog, with a boundary of glass.
  EXPECT_EQ(
      warning_of(ball(
          R"(MakeNamedMedium "ink" "string type" "homogeneous" MediumInterface "ink" "fog" Material "dielectric" Shape "sphere"
)")),
      "none");
  EXPECT_EQ(warning_of(ball(R"(Material "subsurface" MediumInterface "" "fog" Shape "sphere"
)")),
            "none");
}

std::string misfit(const std::string& place, const std::string& around, const std::string& claimed) {
  return "test scene:" + place + ": rays get here through " + around + ", but the shape declares " + claimed +
         " here: is the shape inside out, or does a surrounding shape, or the camera, lack a medium?";
}

TEST(MediaCheck, FindsShapesThatAreInsideOut) {
  const std::string expected = misfit("8:1", "vacuum", R"(medium "fog")");
  EXPECT_EQ(warning_of(ball("", "ReverseOrientation\n")), expected);
  EXPECT_EQ(warning_of(ball("", "Scale -1 1 1\n")), expected);
}

TEST(MediaCheck, FindsWhatLacksTheMediumAroundIt) {
  EXPECT_EQ(warning_of(ball(R"(MakeNamedMedium "ink" "string type" "homogeneous" MediumInterface "ink" ""
Material "dielectric" Shape "sphere"
)")),
            misfit("10:23", R"(medium "fog")", "vacuum"));
  const std::string view_from_within = R"(LookAt 0 0 1  0 0 0  0 1 0
Camera "perspective")";
  EXPECT_EQ(warning_of(ball(), view_from_within), misfit("7:1", "vacuum", R"(medium "fog")"));
}

std::string all_warnings_of(const std::string& directives, const std::string& head = view) {
  const Scene scene = test::world(directives, head);
  std::string all;
  for (const description::Warning& w : warnings_of(scene, scene.description().view))
    all += Error(w.location, w.message).what() + std::string("\n");
  return all;
}

TEST(MediaCheck, SaysWhereLightsAndCamerasAreTakenToBe) {
  const std::string lamp = floor_of_fog + R"(LightSource "point" "point3 from" [0 1 0]
)";
  EXPECT_EQ(
      all_warnings_of(ball(lamp)),
      R"(test scene:10:1: the light is declared to be in vacuum, but the shapes around it put it in medium "fog", which is used
)");
  EXPECT_EQ(all_warnings_of(ball(in_fog + lamp)), "");
  EXPECT_EQ(
      all_warnings_of(ball(in_fog + lamp), R"(LookAt 0 0 1  0 0 0  0 1 0
Camera "perspective")"),
      R"(test scene:3:1: the camera is declared to be in vacuum, but the shapes around it put it in medium "fog", which is used
)");
  // A shape that contradicts the others: what is claimed counts.
  const std::string inside_out =
      R"(MediumInterface "fog" "" Material "dielectric" Shape "sphere" "float radius" 0.5
)";
  for (const std::string& claim : {in_fog, std::string(R"(MediumInterface "" ""
)")}) {
    const Scene scene = test::world(ball(inside_out + claim + lamp), view);
    ASSERT_EQ(scene.lights().size(), 1u);
    EXPECT_EQ(scene.light_media(0).outside, claim == in_fog ? MediumId(1) : MediumId::vacuum);
  }
}

TEST(MediaCheck, FindsLightsWithoutTheirMedium) {
  const std::string message =
      R"(: light from here starts in vacuum, but rays get here through medium "fog": give the light the )"
      "MediumInterface of its surroundings";
  EXPECT_EQ(warning_of(ball(floor_of_fog + R"(AreaLightSource "diffuse"
Shape "sphere" "float radius" 0.3
)")),
            "test scene:11:1" + message);
}

}  // namespace
}  // namespace lanthorn::media_check_test
