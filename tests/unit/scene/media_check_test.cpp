// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/media_check.h"

#include <gtest/gtest.h>

#include <string>

#include "support/scene_text.h"

namespace lanthorn::media_check_test {
namespace {

const std::string view = "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" [50]";
const std::string fog = "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n";
const std::string in_fog = "MediumInterface \"fog\" \"fog\"\n";
const std::string floor_of_fog = "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 1  1 -1 1  -1 -1 -1  1 -1 -1]\n";

// A ball of fog that contains the shapes and lights of `in_it`. `prefix` comes before the ball's shape.
std::string ball(const std::string& in_it = "", const std::string& prefix = "") {
  return fog + "AttributeBegin MediumInterface \"fog\" \"\" Material \"interface\"\n" + prefix +
         "Shape \"sphere\" \"float radius\" 2\nAttributeEnd\n" + in_it;
}

std::string warning_of(const std::string& directives, const std::string& head = view) {
  const Scene scene = test::world(directives, head);
  const std::vector<description::Warning> found = media_warnings(scene, make_view(scene.description().view));
  if (found.empty()) return "none";
  EXPECT_EQ(found.size(), 1u);
  return Error(found[0].location, found[0].message).what();
}

TEST(MediaCheck, FindsNothingWhereMediaFit) {
  const std::string light = "LightSource \"point\" \"point3 from\" [0 1 0]\n";
  EXPECT_EQ(warning_of(ball()), "none");
  EXPECT_EQ(warning_of(ball("", "ReverseOrientation Scale -1 1 1\n")), "none");  // pbrt-v4 flips mirrored quadrics
  EXPECT_EQ(warning_of(ball(in_fog + light + floor_of_fog)), "none");
  EXPECT_EQ(warning_of(ball(in_fog + "AreaLightSource \"diffuse\"\nShape \"sphere\" \"float radius\" 0.3\n")), "none");
  EXPECT_EQ(warning_of(ball(floor_of_fog + "LightSource \"point\" \"point3 from\" [0 1 4]\n")), "none");
  EXPECT_EQ(warning_of(ball(floor_of_fog + "LightSource \"infinite\"\nLightSource \"distant\"\n")), "none");
  // A dense ball in the fog, with a boundary of glass.
  EXPECT_EQ(warning_of(ball("MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" MediumInterface \"ink\" \"fog\" "
                            "Material \"dielectric\" Shape \"sphere\"\n")),
            "none");
  EXPECT_EQ(warning_of(ball("Material \"subsurface\" MediumInterface \"\" \"fog\" Shape \"sphere\"\n")), "none");
}

std::string misfit(const std::string& place, const std::string& around, const std::string& claimed) {
  return "test scene:" + place + ": rays get here through " + around + ", but the shape declares " + claimed +
         " here: is the shape inside out, or does a surrounding shape, or the camera, lack a medium?";
}

TEST(MediaCheck, FindsShapesThatAreInsideOut) {
  const std::string expected = misfit("8:1", "vacuum", "medium \"fog\"");
  EXPECT_EQ(warning_of(ball("", "ReverseOrientation\n")), expected);
  EXPECT_EQ(warning_of(ball("", "Scale -1 1 1\n")), expected);
}

TEST(MediaCheck, FindsWhatLacksTheMediumAroundIt) {
  EXPECT_EQ(warning_of(ball("MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" MediumInterface \"ink\" \"\"\n"
                            "Material \"dielectric\" Shape \"sphere\"\n")),
            misfit("10:23", "medium \"fog\"", "vacuum"));
  const std::string view_from_within = "LookAt 0 0 1  0 0 0  0 1 0\nCamera \"perspective\"";
  EXPECT_EQ(warning_of(ball(), view_from_within), misfit("7:1", "vacuum", "medium \"fog\""));
}

std::string all_warnings_of(const std::string& directives, const std::string& head = view) {
  const Scene scene = test::world(directives, head);
  std::string all;
  for (const description::Warning& w : warnings_of(scene, scene.description().view))
    all += Error(w.location, w.message).what() + std::string("\n");
  return all;
}

TEST(MediaCheck, SaysWhereLightsAndCamerasAreTakenToBe) {
  const std::string lamp = floor_of_fog + "LightSource \"point\" \"point3 from\" [0 1 0]\n";
  EXPECT_EQ(all_warnings_of(ball(lamp)),
            "test scene:10:1: the light is declared to be in vacuum, but the shapes around it put it in medium "
            "\"fog\", which "
            "is used\n");
  EXPECT_EQ(all_warnings_of(ball(in_fog + lamp)), "");
  EXPECT_EQ(all_warnings_of(ball(in_fog + lamp), "LookAt 0 0 1  0 0 0  0 1 0\nCamera \"perspective\""),
            "test scene:3:1: the camera is declared to be in vacuum, but the shapes around it put it in medium "
            "\"fog\", which "
            "is used\n");
  // A shape that contradicts the others: what is claimed counts.
  const std::string inside_out =
      "MediumInterface \"fog\" \"\" Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.5\n";
  for (const std::string& claim : {in_fog, std::string("MediumInterface \"\" \"\"\n")}) {
    const Scene scene = test::world(ball(inside_out + claim + lamp), view);
    ASSERT_EQ(scene.lights().size(), 1u);
    EXPECT_EQ(scene.light_media(0).outside, claim == in_fog ? MediumId(1) : MediumId::vacuum);
  }
}

TEST(MediaCheck, FindsLightsWithoutTheirMedium) {
  const std::string message =
      ": light from here starts in vacuum, but rays get here through medium \"fog\": give the light the "
      "MediumInterface of its surroundings";
  EXPECT_EQ(warning_of(ball(floor_of_fog + "AreaLightSource \"diffuse\"\nShape \"sphere\" \"float radius\" 0.3\n")),
            "test scene:11:1" + message);
}

}  // namespace
}  // namespace lanthorn::media_check_test
