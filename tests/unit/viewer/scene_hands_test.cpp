// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Picking, editing and saving scenes by hand; none of it needs OpenGL.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "camera/view.h"
#include "lanthorn/error.h"
#include "lanthorn/viewer.h"
#include "math/vec.h"
#include "support/gltf_triangle.h"
#include "support/read_gltf.h"
#include "viewer/edited_scene.h"
#include "viewer/interaction.h"
#include "viewer/picking.h"

namespace lanthorn::scene_hands_test {
namespace {

// A wall at z = 0 with a lamp in it, a ball (an instance) in front of it, a point light, a spot light and a sun.
constexpr const char* text = R"(LookAt 0 0 8  0 0 0  0 1 0
Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" [200] "integer yresolution" [100]
WorldBegin
# a comment with "quotes and LightSource
LightSource "point" "rgb I" [5 2.5 1] "point3 from" [2 1 1] # the key
LightSource "spot" "blackbody I" [3000] "float scale" [2]
  "point3 from" [-2 2 1] "point3 to" [0 0 0]
LightSource "distant" "rgb L" [1 1 1] "float illuminance" [3] "point3 from" [0 1e+1 0]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [4 4 2] "bool twosided" true
  Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [1 -1 .1  2 -1 .1  2 0 .1  1 0 .1]
AttributeEnd
ObjectBegin "ball"
  Shape "sphere" "float radius" [.5]
ObjectEnd
AttributeBegin
  Translate -1 -1 2
  ObjectInstance "ball"
AttributeEnd
)";

SharedScene scene_of(const std::string& t) { return build_scene(read_pbrt_string(t, ".", "scene.pbrt")); }
Ray ray_to(const Point& p) { return {Point(0, 0, 8), normalize(p - Point(0, 0, 8))}; }

TEST(Picking, ATriangleIsHitFromBothSidesAndMissedBesideIt) {
  const Point a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_FLOAT_EQ(hit_triangle({0.2f, 0.2f, 3}, {0, 0, -1}, a, b, c).value(), 3);
  EXPECT_FLOAT_EQ(hit_triangle({0.2f, 0.2f, -3}, {0, 0, 2}, a, b, c).value(), 1.5f) << "in units of the direction";
  EXPECT_FALSE(hit_triangle({0.6f, 0.6f, 3}, {0, 0, -1}, a, b, c));
  EXPECT_FALSE(hit_triangle({-0.1f, 0.2f, 3}, {0, 0, -1}, a, b, c));
  EXPECT_FALSE(hit_triangle({0.2f, 0.2f, 3}, {0, 0, 1}, a, b, c)) << "behind the origin";
}

// Two corners that differ only by rounding, as at a sphere's pole: the ray through the pole must not hit the triangle
// anywhere else.
TEST(Picking, TrianglesWithoutAreaAreNotHit) {
  const Point pole(-1, -1, 2.5f);
  for (int i = 0; i < 64; ++i) {
    const float x = 0.05f * std::cos(0.1f * static_cast<float>(i)), y = 0.05f * std::sin(0.1f * static_cast<float>(i));
    const Point beside(pole.x + 1e-7f * y, pole.y - 1e-7f * x, pole.z), rim(pole.x + x, pole.y + y, 2.49f);
    const auto hit = hit_triangle({0, 0, 8}, normalize(pole - Point(0, 0, 8)), pole, beside, rim);
    EXPECT_NEAR(hit.value_or(std::sqrt(32.25f)), std::sqrt(32.25f), 0.01f) << i;
  }
}

TEST(Picking, FindsWallLampAndBall) {
  const SharedScene scene = scene_of(text);
  const Picker picker(*scene);
  const auto wall = picker.pick(ray_to({-3, 1, 0}));
  ASSERT_TRUE(wall);
  EXPECT_NEAR(wall->distance, std::sqrt(9.0f + 1 + 64), 1e-4f);
  EXPECT_FALSE(wall->instance || wall->area_light);
  const auto lamp = picker.pick(ray_to({1.5f, -0.5f, 0.1f}));
  ASSERT_TRUE(lamp);
  EXPECT_EQ(lamp->area_light, 0u);
  const auto ball = picker.pick(ray_to({-1, -1, 2}));
  ASSERT_TRUE(ball);
  EXPECT_EQ(ball->instance, 0u);
  EXPECT_NEAR(ball->distance, std::sqrt(38.0f) - 0.5f, 0.01f);
  description::Table<description::Instance> moved = description_of(*scene).instances;
  moved[0].object_to_world = AnimatedTransform(translate({3, 2, 2}));
  EXPECT_FALSE(picker.pick(ray_to({-1, -1, 2}), moved)->instance);
  EXPECT_EQ(picker.pick(ray_to({3, 2, 2}), moved)->instance, 0u);
  EXPECT_FALSE(picker.pick({Point(0, 0, 8), Direction(0, 0, 1)}));
}

// Three nodes of a glTF file: two share a mesh, one has its own.
TEST(EditedScene, EveryNodeOfAFileCanBeMoved) {
  test::GltfWriter file;
  file.mesh(test::corners, {0, 1, 2});
  file.mesh(test::corners, {0, 1, 2});
  file.node({{"mesh", 0}});
  file.node({{"mesh", 0}, {"translation", {2, 0, 0}}});
  file.node({{"mesh", 1}, {"translation", {-2, 0, 0}}});
  SceneDescription description = test::read_gltf(file);
  ASSERT_EQ(description.shapes.size(), 1u);
  make_nodes_movable(description);
  EXPECT_TRUE(description.shapes.empty());
  EditedScene scene(build_scene(std::move(description)));
  const Picker picker(*scene.scene());
  const auto under = [&](const Point& p) { return picker.pick(ray_to(p), scene.description().instances); };
  for (const float x : {-1.75f, 0.25f, 2.25f}) {
    const auto hit = under({x, 0.25f, 0});
    ASSERT_TRUE(hit && hit->instance) << x;
    scene.move_instance(*hit->instance, {0, 3, 0});
    EXPECT_FALSE(under({x, 0.25f, 0})) << x;
    EXPECT_EQ(under({x, 3.25f, 0})->instance, hit->instance) << x;
  }
}

TEST(EditedScene, ListsLightsAndChangesThem) {
  EditedScene scene(scene_of(text));
  ASSERT_EQ(scene.lights().size(), 4u);
  EXPECT_EQ(scene.lights()[0].colour, (Rgb{1, 0.5f, 0.2f}));
  EXPECT_FALSE(scene.lights()[2].position);
  EXPECT_TRUE(scene.lights()[3].is_area);
  LightRow row = scene.lights()[0];
  row.colour = {0, 1, 0.5f};
  row.strength = 2;
  scene.set_light(0, row);
  scene.move_light(0, {0, 1, 0});
  const auto& light = description_of(*scene.scene()).lights[0];
  const auto& point = std::get<description::PointLight>(light.node);
  EXPECT_EQ(std::get<description::RgbSpectrum>(point.intensity.spectrum).rgb, (Rgb{0, 5, 2.5f}));
  EXPECT_FLOAT_EQ(point.intensity.scale, 2);
  EXPECT_EQ(light.light_to_world.point(point.from), Point(2, 2, 1));
  EXPECT_THROW(scene.move_light(2, {1, 0, 0}), Error);
  scene.move_instance(0, {1, 0, 0});
  scene.move_instance(0, {1, 0, 0});
  EXPECT_EQ(description_of(*scene.scene()).instances[0].object_to_world.start.point(Point(0)), Point(1, -1, 2));
}

TEST(EditedScene, LightsGoOffAndOnAgain) {
  EditedScene scene(scene_of(text));
  for (std::size_t i = 0; i < scene.lights().size(); ++i) {
    LightRow row = scene.lights()[i];
    row.on = false;
    scene.set_light(i, row);
  }
  for (const Light& light : scene.scene()->lights()) EXPECT_EQ(power(light), 0);
  for (std::size_t i = 0; i < scene.lights().size(); ++i) {
    LightRow row = scene.lights()[i];
    row.on = true;
    scene.set_light(i, row);
  }
  const SharedScene original = scene_of(text);
  for (std::size_t i = 0; i < original->lights().size(); ++i)
    EXPECT_FLOAT_EQ(power(scene.scene()->lights()[i]), power(original->lights()[i]));
}

TEST(EditedScene, StrengthMultipliesLightsOnceHoweverTheirMagnitudeIsGiven) {
  const SharedScene original = scene_of(
      R"(WorldBegin LightSource "point" "float power" 10 "float scale" 3
LightSource "distant" "float illuminance" 5
LightSource "infinite" "float illuminance" 5
AttributeBegin AreaLightSource "diffuse" "float power" 7 Shape "sphere" AttributeEnd
)");
  EditedScene scene(original);
  ASSERT_EQ(scene.lights().size(), 4u);
  for (std::size_t i = 0; i < scene.lights().size(); ++i) {
    LightRow row = scene.lights()[i];
    row.strength = 4;
    scene.set_light(i, row);
  }
  ASSERT_EQ(scene.scene()->lights().size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_FLOAT_EQ(power(scene.scene()->lights()[i]), 4 * power(original->lights()[i])) << i;
}

TEST(SavedScene, IsReadBackAsWhatWasEdited) {
  const SharedScene original = scene_of(text);
  EditedScene scene(original);
  for (std::size_t i = 0; i < scene.lights().size(); ++i) {
    LightRow row = scene.lights()[i];
    row.strength = 0.5f;
    row.colour = {1, 0.25f, 0.125f};
    scene.set_light(i, row);
  }
  scene.move_light(0, {0.5f, 0, 0});
  scene.move_light(1, {0, -0.5f, 0});
  scene.move_instance(0, {0.25f, 0, 0});
  const CameraPose pose = orbit(pose_of(description_of(*original).view.camera.camera_to_world.start, 8), {30, 10});
  const std::string saved = edited_pbrt(text, description_of(*original), pose, scene.description());
  EXPECT_NE(saved.find("# a comment with \"quotes and LightSource"), saved.npos);
  const SharedScene read = scene_of(saved);
  const SceneDescription &a = description_of(*read), &b = description_of(*scene.scene());
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      EXPECT_NEAR(a.view.camera.camera_to_world.start.matrix[column][row], pose.camera_to_world.matrix[column][row],
                  1e-5f);
  ASSERT_EQ(read->lights().size(), scene.scene()->lights().size());
  for (std::size_t i = 0; i < read->lights().size(); ++i) {
    EXPECT_FLOAT_EQ(power(read->lights()[i]), power(scene.scene()->lights()[i])) << i;
    const auto bounds = emission_bounds(read->lights()[i]), wanted = emission_bounds(scene.scene()->lights()[i]);
    ASSERT_EQ(bounds.has_value(), wanted.has_value());
    if (!bounds) continue;
    EXPECT_LT(glm::length(bounds->box.centre() - wanted->box.centre()), 1e-5f) << i;
  }
  EXPECT_LT(glm::length(a.instances[0].object_to_world.start.point(Point(0)) -
                        b.instances[0].object_to_world.start.point(Point(0))),
            1e-5f);
}

TEST(SavedScene, RefusesEditsOfOtherFiles) {
  const SharedScene original = scene_of(text);
  EditedScene scene(original);
  scene.move_light(0, {1, 0, 0});
  SceneDescription edited = scene.description();
  edited.lights.at(0).location.file = "included.pbrt";
  const CameraPose pose = pose_of(description_of(*original).view.camera.camera_to_world.start, 8);
  EXPECT_THROW(edited_pbrt(text, description_of(*original), pose, edited), Error);
}

/// A pointer over a picture of the scene, 200 x 100 pixels.
struct Hand {
  EditedScene scene{scene_of(text)};
  Picker picker{*scene.scene()};
  View view = make_view(description_of(*scene.scene()).view);
  Interaction interaction{pose_of(description_of(*scene.scene()).view.camera.camera_to_world.start, 8), 1};
  Panel panel;

  Vec2 pixel_of(const Point& p) const { return view.camera.connect(p, Vec2(0.5f), 0)->raster; }
  Interaction::Change act(const Input& input) { return interaction.apply(input, view, picker, scene, panel); }
  /// Presses the left button at a pixel, moves the pointer by `way`, and releases the button.
  Interaction::Change drag(const Vec2& from, const Vec2& way) {
    Input input;
    input.inside = input.left = input.pressed = true;
    input.pointer = from;
    act(input);
    input.pressed = false;
    input.moved = way;
    input.pointer += way;
    const Interaction::Change change = act(input);
    input.left = false;
    input.moved = Vec2(0);
    input.released = true;
    act(input);
    return change;
  }
};

TEST(Interaction, ClicksSelectAndDragsOrbit) {
  Hand hand;
  hand.drag(hand.pixel_of({1.5f, -0.5f, 0.1f}), Vec2(0));
  EXPECT_EQ(hand.panel.selected_light, 3u);
  hand.drag(hand.pixel_of({-1, -1, 2}), Vec2(0));
  EXPECT_FALSE(hand.panel.selected_light);
  EXPECT_EQ(hand.panel.selected_object, 0u);
  EXPECT_EQ(hand.interaction.pose().camera_to_world,
            description_of(*hand.scene.scene()).view.camera.camera_to_world.start);
  const Interaction::Change change = hand.drag(hand.pixel_of({-3, 1, 0}), {20, 0});
  EXPECT_TRUE(change.camera);
  EXPECT_FALSE(change.scene);
}

// Between two slow frames, the pointer moves far and then a button is pressed.
TEST(Interaction, AClickIsAClickHoweverFarThePointerCame) {
  Hand hand;
  const Vec2 lamp = hand.pixel_of({1.5f, -0.5f, 0.1f});
  Input input;
  input.inside = true;
  input.pointer = lamp;
  input.moved = {70, 20};
  hand.act(input);
  input.left = input.pressed = true;
  input.moved = Vec2(0);
  EXPECT_FALSE(hand.act(input).camera);
  input.left = input.pressed = false;
  input.released = true;
  EXPECT_FALSE(hand.act(input).camera);
  EXPECT_EQ(hand.panel.selected_light, 3u);
}

// The button is pressed over an object, and the pointer moves on before the next frame: the drag starts where the
// button was pressed.
TEST(Interaction, ADragBeginsWhereTheButtonWasPressed) {
  Hand hand;
  const Vec2 at = hand.pixel_of({2, 1, 1}), way(40, -20);
  Input input;
  input.inside = input.left = input.pressed = true;
  input.pointer = at + way;
  input.moved = way;
  EXPECT_TRUE(hand.act(input).scene);
  EXPECT_EQ(hand.panel.selected_light, 0u);
  const Vec2 now = hand.pixel_of(*hand.scene.lights()[0].position);
  EXPECT_NEAR(now.x, at.x + way.x, 0.01f);
  EXPECT_NEAR(now.y, at.y + way.y, 0.01f);
}

TEST(Interaction, DraggedThingsStayUnderThePointer) {
  Hand hand;
  const Vec2 way(17, -9);
  const Vec2 at = hand.pixel_of({2, 1, 1});
  EXPECT_TRUE(hand.drag(at, way).scene);
  const Vec2 now = hand.pixel_of(*hand.scene.lights()[0].position);
  EXPECT_NEAR(now.x, at.x + way.x, 0.01f);
  EXPECT_NEAR(now.y, at.y + way.y, 0.01f);
  EXPECT_NEAR(hand.scene.lights()[0].position->z, 1, 1e-4f) << "at the same depth";
  const Vec2 ball = hand.pixel_of({-1, -1, 2.5f});
  hand.drag(ball, Vec2(0));
  EXPECT_TRUE(hand.drag(ball, way).scene);
  const Point centre = description_of(*hand.scene.scene()).instances[0].object_to_world.start.point({0, 0, 0.5f});
  EXPECT_NEAR(hand.pixel_of(centre).x, ball.x + way.x, 0.2f);
  EXPECT_NEAR(hand.pixel_of(centre).y, ball.y + way.y, 0.2f);
}

}  // namespace
}  // namespace lanthorn::scene_hands_test
