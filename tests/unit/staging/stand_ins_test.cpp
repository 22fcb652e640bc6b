// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "staging/stand_ins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "camera/view.h"
#include "lanthorn/scene.h"
#include "scene/scene.h"
#include "support/gltf_writer.h"

namespace lanthorn::stand_ins_test {
namespace {

using namespace description;

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Shape mesh_shape(std::vector<Point> positions, const std::vector<std::uint32_t>& indices) {
  TriangleMesh mesh;
  mesh.positions = std::move(positions);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  Shape shape;
  shape.geometry = std::move(mesh);
  return shape;
}
Shape sphere(const Point& centre, float radius) {
  test::SphereMesh mesh = test::sphere_mesh(radius, 16, 24);
  for (Point& p : mesh.positions) p += centre;
  return mesh_shape(std::move(mesh.positions), mesh.indices);
}
// A square with this side length, centred at `centre`, whose outside faces cross(right, up).
Shape square(const Point& centre, const Vec3& right, const Vec3& up) {
  return mesh_shape({centre - right - up, centre + right - up, centre + right + up, centre - right + up},
                    {0, 1, 2, 0, 2, 3});
}

SceneDescription scene_of(std::vector<Shape> shapes) {
  SceneDescription scene;
  scene.filename = "model";
  scene.materials.emplace_back();
  scene.shapes = std::move(shapes);
  return scene;
}
SceneDescription seen(std::vector<Shape> shapes, const OneSided& one_sided = {{0}}) {
  SceneDescription scene = scene_of(std::move(shapes));
  add_stand_ins(scene, {true, true, one_sided});
  return scene;
}
Point eye_of(const SceneDescription& scene) {
  return make_view(scene.view).camera.sample_ray({640, 360}, {0.5f, 0.5f}, 0.5f).ray.origin;
}

TEST(StandIns, TheCameraFramesTheModelWhateverThePicture) {
  const std::vector<Point> ends = {{-30, 5, -1}, {30, 5, 1}, {0, 9, 0}};
  const SceneDescription scene = seen({mesh_shape(ends, {0, 1, 2})});
  for (const auto& [width, height] :
       std::vector<std::array<int, 2>>{{1280, 720}, {720, 1280}, {500, 500}, {2000, 100}}) {
    const View view = make_view(scene.view, {.resolution = std::array{width, height}});
    float left = 1, right = 0, top = 1, bottom = 0;
    for (const Point& p : ends) {
      const auto connection = view.camera.connect(p, {0.5f, 0.5f}, 0.5f);
      ASSERT_TRUE(connection) << width << " x " << height;
      const Vec2 at = connection->raster / Vec2(width, height);
      left = std::fmin(left, at.x);
      right = std::fmax(right, at.x);
      top = std::fmin(top, at.y);
      bottom = std::fmax(bottom, at.y);
    }
    // The object nearly touches one pair of opposite edges.
    EXPECT_GT(std::fmax(right - left, bottom - top), 0.75f) << width << " x " << height;
  }
}

TEST(StandIns, RoundThingsAreSeenFromTheFrontAndBoxesThroughTheirOpening) {
  const Point ball = eye_of(seen({sphere({5, 0, 0}, 2)}));
  EXPECT_NEAR(ball.x, 5, 1e-3f);
  EXPECT_GT(ball.z, 4);
  EXPECT_GT(ball.y, 0.5f);
  // A box without the wall at -z, and one without the wall at +x. The walls' outsides face inwards, or outwards with
  // two-sided materials.
  const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  for (const float side : {1.0f, -1.0f}) {
    const auto walls = [&](int missing) {
      const std::vector<Shape> all = {square(x, side * z, y),   square(-x, -side * z, y), square(y, side * x, z),
                                      square(-y, -side * x, z), square(z, -side * x, y),  square(-z, side * x, y)};
      std::vector<Shape> some;
      for (std::size_t i = 0; i < all.size(); ++i)
        if (static_cast<int>(i) != missing) some.push_back(all[i]);
      return some;
    };
    const OneSided one_sided{side > 0 ? std::set<Index>{0} : std::set<Index>{}, true};
    EXPECT_LT(eye_of(seen(walls(5), one_sided)).z, -2) << side;
    EXPECT_GT(eye_of(seen(walls(0), one_sided)).x, 2) << side;
    EXPECT_GT(eye_of(seen(walls(4), one_sided)).z, 2) << side;
  }
}

TEST(StandIns, TheBackCountsWhereItIsShown) {
  const Vec3 x(1, 0, 0), y(0, 1, 0);
  SceneDescription sheet = scene_of({square({0, 0, 0}, -x, y)});  // its outside is at -z
  add_stand_ins(sheet, {true, false, {{0}}});
  EXPECT_LT(eye_of(sheet).z, -1);
  sheet = scene_of({square({0, 0, 0}, -x, y)});
  add_stand_ins(sheet, {true, false, {}});
  EXPECT_GT(eye_of(sheet).z, 1);
}

TEST(StandIns, PlainsAreSeenFromHigherUp) {
  const Point eye = eye_of(seen({square({0, 0, 0}, {10, 0, 0}, {0, 0, -10})}));
  EXPECT_GT(eye.y, 0.7f * std::hypot(eye.x, eye.z));
}

// A room with this half extent, or some of its walls, and its contents. Walls face outwards and are two-sided.
std::vector<Shape> room(const Vec3& half, std::vector<Shape> things, int walls = 6) {
  const Vec3 x(half.x, 0, 0), y(0, half.y, 0), z(0, 0, half.z);
  const std::vector<Shape> all = {square(-x, z, y), square(x, -z, y),  square(y, x, -z),
                                  square(-y, x, z), square(-z, -x, y), square(z, x, y)};
  things.insert(things.end(), all.begin(), all.begin() + walls);
  return things;
}
// These shapes as a single mesh, moved.
Shape joined(const std::vector<Shape>& shapes, const Transform& place = {}) {
  TriangleMesh all;
  for (const Shape& shape : shapes) {
    const auto& mesh = std::get<TriangleMesh>(shape.geometry);
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    for (const Point& p : mesh.positions) all.positions.push_back(place.point(p));
    for (const auto& [a, b, c] : mesh.triangles) all.triangles.push_back({first + a, first + b, first + c});
  }
  Shape shape;
  shape.geometry = std::move(all);
  return shape;
}
// Positions, from 0 to 1, of the corners of a box in a square picture. The box has this half extent and is centred at
// `centre`.
Bounds seen_box(const SceneDescription& scene, const Point& centre, float half) {
  const View view = make_view(scene.view, {.resolution = std::array{100, 100}});
  Bounds box;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner((i & 1) * 2 - 1, (i & 2) - 1, (i & 4) / 2 - 1);
    if (const auto at = view.camera.connect(centre + half * corner, {0.5f, 0.5f}, 0.5f))
      box.extend(Point(at->raster / 100.0f, 0));
  }
  return box;
}

// A ball on a much larger plane is framed as if the plane did not exist; on a slightly larger one, both are framed. The
// plane is an instance, or a backdrop behind or in front of the ball.
TEST(StandIns, ThingsOnALargePlainAreFramed) {
  const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const auto width = [](const SceneDescription& scene) { return seen_box(scene, Point(0), 1).extent().x; };
  const float alone = width(seen({sphere(Point(0), 1)}));
  EXPECT_GT(alone, 0.5f);
  const auto on = [&](const Point& at, const Vec3& right, const Vec3& up) {
    return seen({square(at, right, up), sphere(Point(0), 1)}, {{}, false});
  };
  EXPECT_LT(width(on({0, -1, 0}, 4.0f * x, -4.0f * z)), 0.5f * alone);
  EXPECT_NEAR(width(on({0, -1, 0}, 6.0f * x, -6.0f * z)), alone, 0.1f * alone);
  EXPECT_NEAR(width(on({0, -1, 0}, 50.0f * x, -50.0f * z)), alone, 0.1f * alone);
  EXPECT_GT(eye_of(on({0, 0, -1}, 50.0f * x, 50.0f * y)).z, 1);
  const SceneDescription before = on({0, 0, 1}, 50.0f * x, 50.0f * y);
  EXPECT_LT(eye_of(before).z, -1);
  EXPECT_EQ(before.shapes.size(), 2u);
  EXPECT_EQ(std::get<TriangleMesh>(before.shapes[0].geometry).positions.size(), 4u) << "in its place";
  SceneDescription instanced = scene_of({sphere(Point(0), 1)});
  instanced.objects.resize(1);
  instanced.objects[0].shapes.push_back(square(Point(0), x, y));
  Instance ground;
  ground.object_to_world = AnimatedTransform(translate({0, -1, 0}) * rotate(90, {1, 0, 0}) * scale({50, 50, 50}));
  instanced.instances.push_back(ground);
  add_stand_ins(instanced, {true, true, {}});
  EXPECT_NEAR(width(instanced), alone, 0.1f * alone);
  EXPECT_EQ(instanced.instances.size(), 1u);
  EXPECT_NE(instanced.warnings.back().message.find("a view of all but the ground "), std::string::npos);
  // Walls of a room are not grounds, however small the objects in it.
  const SceneDescription in_room = seen(room({9, 9, 9}, {sphere({0, -8.8f, 0}, 0.2f)}, 3), {{}, false});
  EXPECT_EQ(in_room.warnings.back().message.find("ground"), std::string::npos);
  const SceneDescription layers =
      seen({square({0, 1, 0}, 50.0f * x, 50.0f * z), square({0, -1, 0}, 50.0f * x, 50.0f * z), sphere(Point(0), 0.5f)},
           {{}, false});
  EXPECT_EQ(layers.warnings.back().message.find("ground"), std::string::npos);
  // A plane alone, and one with thin poles of its own size, are not grounds.
  EXPECT_LT(seen_box(seen({square(Point(0), 50.0f * x, -50.0f * z)}), Point(0), 1).extent().x, 0.1f);
  EXPECT_LT(width(seen({square(Point(0), 50.0f * x, -50.0f * z), sphere(Point(0), 1),
                        square({0, 40, 0}, 0.1f * x, 40.0f * y)})),
            0.1f);
}

bool is_inside(const SceneDescription& scene, const Vec3& half) {
  const Vec3 eye = glm::abs(eye_of(scene));
  return eye.x < half.x && eye.y < half.y && eye.z < half.z;
}

TEST(StandIns, RoomsAreSeenFromInsideByALampInThem) {
  const Vec3 half(4, 1.5f, 3);
  const SceneDescription scene = seen(room(half, {sphere({1, -0.5f, 0}, 1)}), {});
  EXPECT_TRUE(is_inside(scene, half));
  EXPECT_TRUE(scene.view.film.measures_exposure);
  EXPECT_EQ(scene.warnings.back().message,
            "the file has no camera and no light: a view from inside, lit by a lamp in the room, stands in");
  EXPECT_TRUE(scene.lights.empty());
  ASSERT_EQ(scene.area_lights.size(), 1u);
  // The ball is in the picture, nearer than the walls behind it, and lit.
  const View view = make_view(scene.view);
  EXPECT_TRUE(view.camera.connect({1, -0.5f, 0}, {0.5f, 0.5f}, 0.5f));
  const Shape& lamp = scene.shapes.back();
  EXPECT_EQ(lamp.area_light, Index{0});
  EXPECT_EQ(lamp.alpha.value, 0) << "invisible";
  const Vec3 at = lamp.object_to_world.start.point(Point(0));
  const float radius = std::get<Sphere>(lamp.geometry).radius;
  EXPECT_GT(radius, 0.01f);
  EXPECT_GT(length(at - Vec3(1, -0.5f, 0)), 1 + 2 * radius);
  for (int i = 0; i < 3; ++i) EXPECT_LT(std::fabs(at[i]) + 2 * radius, half[i]);

  SceneDescription lit = scene_of(room(half, {sphere({1, -0.5f, 0}, 1)}));
  add_stand_ins(lit, {true, false, {}});
  EXPECT_TRUE(is_inside(lit, half));
  EXPECT_TRUE(lit.area_lights.empty());
}

// The user's environment replaces only the studio; camera and lamp stay the same.
TEST(StandIns, TheUsersEnvironmentMovesNoCamera) {
  const Vec3 half(4, 1.5f, 3);
  for (const bool is_room : {true, false}) {
    const auto scene_with = [&](bool gets_environment) {
      SceneDescription scene = scene_of(is_room ? room(half, {sphere({1, -0.5f, 0}, 1)}) : std::vector{sphere({}, 1)});
      add_stand_ins(scene, {.camera = true, .light = true, .gets_environment = gets_environment});
      return scene;
    };
    const SceneDescription own = scene_with(false), lit = scene_with(true);
    EXPECT_EQ(lit.view.camera.camera_to_world.start, own.view.camera.camera_to_world.start);
    EXPECT_EQ(lit.shapes.size(), own.shapes.size());
    EXPECT_EQ(lit.area_lights.size(), is_room ? 1u : 0u);
    EXPECT_TRUE(lit.view.film.measures_exposure);
    EXPECT_EQ(
        lit.warnings.back().message,
        is_room ? own.warnings.back().message : "the file has no camera: a view of all of it from the front stands in");
  }
}

TEST(StandIns, ChestsEmptyRoomsAndOpenBoxesAreSeenFromOutside) {
  const Vec3 half(4, 1.5f, 3), chest(2, 2, 2);
  const Shape ball = sphere({1, -0.5f, 0}, 1);
  EXPECT_FALSE(is_inside(seen({joined(room(half, {}))}, {}), half));
  EXPECT_FALSE(is_inside(seen(room(chest, {ball}), {}), chest));
  EXPECT_FALSE(is_inside(seen(room(half, {ball}, 5), {}), half));
  EXPECT_FALSE(is_inside(seen({joined(room(half, {})), sphere({1, -0.5f, 0}, 0.3f)}, {}), half));
  // Not a box: a flattened ball with another one inside.
  Shape flat = sphere({0, 0, 0}, 3);
  for (Point& p : std::get<TriangleMesh>(flat.geometry).positions) p.y *= 0.5f;
  EXPECT_FALSE(is_inside(seen({flat, ball}, {}), Vec3(3, 1.5f, 3)));
}

TEST(StandIns, RoomsWithoutAFloorOrWithARoofThatShowsAreSeenFromOutside) {
  const Vec3 half(4, 1.5f, 3);
  const auto balls_at = [](std::vector<float> xs, std::vector<float> ys, std::vector<float> zs) {
    std::vector<Shape> balls;
    for (const float x : xs)
      for (const float y : ys)
        for (const float z : zs) balls.push_back(sphere({x, y, z}, 0.65f));
    return balls;
  };
  const std::vector<Shape> few = balls_at({-2.5f, 2.5f}, {0.8f}, {-1.8f, 1.8f});
  EXPECT_TRUE(is_inside(seen(room(half, few), {}), half));
  std::vector<Shape> without_floor = room(half, few);
  without_floor.erase(without_floor.end() - 3);
  EXPECT_FALSE(is_inside(seen(without_floor, {}), half));
  std::vector<Shape> many = balls_at({-2.5f, -0.8f, 0.8f, 2.5f}, {-0.8f, 0.8f}, {-1.8f, -0.6f, 0.6f, 1.8f});
  EXPECT_TRUE(is_inside(seen(room(half, many), {}), half));
  // Corrugated iron covers two fifths of the ceiling.
  TriangleMesh iron;
  for (std::uint32_t i = 0; i <= 32; ++i)
    for (const float z : {-3.0f, 3.0f})
      iron.positions.emplace_back(-4 + 0.1f * static_cast<float>(i), i % 2 == 0 ? 1.51f : 1.6f, z);
  for (std::uint32_t i = 0; i < 64; i += 2) {
    iron.triangles.push_back({i, i + 1, i + 2});
    iron.triangles.push_back({i + 1, i + 3, i + 2});
  }
  Shape roof;
  roof.geometry = std::move(iron);
  many.push_back(roof);
  EXPECT_FALSE(is_inside(seen(room(half, many), {}), half));
}

TEST(StandIns, WhatFacesInwardsIsSeenFromInside) {
  const Vec3 half(4, 1.5f, 3);
  const auto inwards = [](std::vector<Shape> shapes) {
    for (Shape& shape : shapes)
      for (auto& t : std::get<TriangleMesh>(shape.geometry).triangles) std::swap(t[1], t[2]);
    return shapes;
  };
  const OneSided certain{{0}, true};
  const std::vector<Shape> empty = inwards({joined(room(half, {}))});
  EXPECT_TRUE(is_inside(seen(empty, certain), half));
  EXPECT_FALSE(is_inside(seen(empty, {{0}, false}), half)) << "may be wound the wrong way";
  EXPECT_FALSE(is_inside(seen(empty, {{}, true}), half)) << "has outsides";
  EXPECT_FALSE(is_inside(seen(room(half, {}), certain), half));
  EXPECT_FALSE(is_inside(seen(inwards(room(half, {}, 5)), certain), half));
  // A sphere as a sky around a ball counts as a room, although it is high.
  EXPECT_TRUE(is_inside(seen(inwards({sphere({0, 0, 0}, 9)}), certain), Vec3(9)));
  std::vector<Shape> sky = inwards({sphere({0, 0, 0}, 9)});
  sky.push_back(sphere({0, -2, 0}, 2));
  EXPECT_TRUE(is_inside(seen(sky, certain), Vec3(9)));
  // A hull that hides a ball: from between the two, mostly the ball's front is visible; inside the ball, its back.
  std::vector<Shape> hull = inwards({sphere({0, 0, 0}, 2.1f)});
  hull.push_back(sphere({0, 0, 0}, 2));
  EXPECT_FALSE(is_inside(seen(hull, certain), Vec3(2.1f)));
  // A room with a quarter of its floor, which is hidden from outside.
  std::vector<Shape> open = room(half, {});
  open[3] = square({-3, -1.5f, 0}, {1, 0, 0}, {0, 0, 3});
  EXPECT_FALSE(is_inside(seen(inwards(open), certain), half));
}

// Six separate walls are a room, even an empty one, with y up or with z up.
TEST(StandIns, RoomsOfSeparateWallsAreSeenFromInside) {
  const auto inside = [](const std::vector<Shape>& shapes, const Vec3& half) {
    const SceneDescription scene = seen(shapes, {});
    if (is_inside(scene, half)) {
      EXPECT_EQ(scene.area_lights.size(), 1u) << "lit";
    }
    return is_inside(scene, half);
  };
  const Vec3 half(3, 1.3f, 2.5f), upright(3, 2.5f, 1.3f);
  EXPECT_TRUE(inside(room(half, {}), half));
  EXPECT_TRUE(inside(room(upright, {}), upright)) << "z up";
  EXPECT_TRUE(inside(room({1.6f, 1.25f, 1.6f}, {}), {1.6f, 1.25f, 1.6f})) << "small";
  for (int wall = 0; wall < 6; ++wall) {
    std::vector<Shape> open = room(half, {});
    open.erase(open.begin() + wall);
    EXPECT_FALSE(inside(open, half)) << "without wall " << wall;
  }
  // Walls of some thickness, of which one has a window; and in one piece each.
  std::vector<Shape> thick;
  const auto slab = [](const Point& centre, const Vec3& size) { return joined(room(size, {}), translate(centre)); };
  for (const float side : {-1.0f, 1.0f}) {
    thick.push_back(slab({3.1f * side, 0, 0}, {0.1f, 1.3f, 2.5f}));
    thick.push_back(slab({0, 1.4f * side, 0}, {3.2f, 0.1f, 2.7f}));
    thick.push_back(slab({2.2f * side, 0, 2.6f}, {0.9f, 1.3f, 0.1f}));
    thick.push_back(slab({0, 0.95f * side, 2.6f}, {1.3f, 0.35f, 0.1f}));
  }
  thick.push_back(slab({0, 0, -2.6f}, {3.2f, 1.3f, 0.1f}));
  EXPECT_TRUE(inside(thick, {3, 1.3f, 2.5f}));
  // A sideboard, a wardrobe and a cube.
  for (const Vec3& furniture : {Vec3(0.8f, 0.4f, 0.22f), Vec3(0.5f, 1, 0.3f), Vec3(1)})
    EXPECT_FALSE(inside(room(furniture, {}), furniture)) << furniture.x;
  // Walls of glTF whose backs viewers do not draw.
  EXPECT_FALSE(is_inside(seen(room(half, {}), {{0}, true}), half));
}

// A room of one mesh with things on the floor of z.
TEST(StandIns, FurnishedRoomsMayHaveZUp) {
  const Vec3 half(4, 3, 1.5f);
  const auto furnished = [&](float height) {
    return seen({joined(room(half, {})), sphere({-2, 1, height}, 0.6f), sphere({1, -1.5f, height}, 0.6f),
                 sphere({2, 1, height}, 0.6f)},
                {});
  };
  const SceneDescription scene = furnished(-0.8f);
  ASSERT_TRUE(is_inside(scene, half));
  EXPECT_GT(scene.view.camera.camera_to_world.start.vector({0, 1, 0}).z, 0.9f) << "up in the picture";
  EXPECT_FALSE(is_inside(furnished(0), half)) << "nothing stands on this floor";
}

SceneDescription seen_in_own_light(SceneDescription scene) {
  add_stand_ins(scene, {true, false, {}});
  return scene;
}
// A lamp of this radiance that shines down, and up at the ceiling.
void add_lamp(SceneDescription& scene, const Point& centre, float radiance = 20) {
  Shape lamp = square(centre, {0.3f, 0, 0}, {0, 0, 0.3f});
  lamp.area_light = static_cast<Index>(scene.area_lights.size());
  description::AreaLight& light = scene.area_lights.emplace_back();
  light.radiance.value = RgbSpectrum{{radiance, radiance, radiance}};
  light.two_sided = true;
  scene.shapes.push_back(std::move(lamp));
}
description::PointLight point_light(const Point& from, float intensity = 1) {
  description::PointLight light;
  light.intensity.scale = intensity;
  light.from = from;
  return light;
}
// The view from a position to the origin.
description::DistantLight distant_light(const Point& from, float radiance = 1) {
  description::DistantLight light;
  light.radiance.scale = radiance;
  light.from = from;
  light.to = Point(0);
  return light;
}
void add_light(SceneDescription& scene, decltype(description::Light::node) node) {
  scene.lights.emplace_back().node = std::move(node);
}

// The walls of a tall box that is open at +z.
TEST(StandIns, WhatTheScenesOwnLightsReachIsShown) {
  const auto open_box = [] { return scene_of(room({2, 2, 2}, {}, 5)); };
  const auto box_with = [&](decltype(description::Light::node) node) {
    SceneDescription scene = open_box();
    add_light(scene, std::move(node));
    return eye_of(seen_in_own_light(std::move(scene)));
  };
  SceneDescription box = open_box();
  add_lamp(box, {0, 1.99f, 0});
  EXPECT_GT(eye_of(seen_in_own_light(box)).z, 3) << "open there";
  for (Shape& shape : box.shapes) shape.object_to_world = AnimatedTransform(rotate(180, {0, 1, 0}));
  EXPECT_LT(eye_of(seen_in_own_light(box)).z, -3) << "open at the back";
  // A view from the right, into a box whose left wall is visible from the front as well as from the right.
  SceneDescription open_at_right = scene_of(room({2, 2, 2}, {}));
  open_at_right.shapes.edit().erase(open_at_right.shapes.begin() + 1);
  add_lamp(open_at_right, {0, 1.99f, 0});
  const Point eye = eye_of(seen_in_own_light(open_at_right));
  EXPECT_GT(eye.x, 3);
  EXPECT_LT(std::fabs(eye.z), 1);
  // Lights that are not in the room.
  EXPECT_GT(box_with(distant_light({0, 1, 3})).z, 3);
  EXPECT_LT(box_with(distant_light({0, 1, -3})).z, -3);
  EXPECT_LT(box_with(point_light({-5, 0, -9})).z, -3);
  description::SpotLight spot;
  spot.from = {9, 0, -1};
  spot.to = {0, 0, 0};
  EXPECT_GT(box_with(spot).x, 3);
  spot.to = {9, 9, 0};
  EXPECT_GT(box_with(spot).z, 3) << "reaches nothing";
  EXPECT_GT(box_with(description::InfiniteLight{}).z, 3);
  // Lights at positions that overflow, or without a direction, illuminate nothing.
  EXPECT_GT(box_with(point_light({1e30f, 0, -1e30f})).z, 3);
  EXPECT_GT(box_with(point_light({0, 0, -9}, infinity)).z, 3);
  EXPECT_GT(box_with(distant_light({0, 0, 0})).z, 3);
}

TEST(StandIns, ClosedBoxesWithALampInsideAreSeenFromInside) {
  const Vec3 half(2, 2, 2);
  const auto cube = [&](std::vector<Shape> things) { return scene_of(room(half, std::move(things))); };
  SceneDescription lit = cube({});
  add_lamp(lit, {0, 1.99f, 0});
  EXPECT_TRUE(is_inside(seen_in_own_light(lit), half)) << "empty, and as high as wide";
  lit.area_lights[0].radiance.value = RgbSpectrum{{1, 1, 1}};
  EXPECT_FALSE(is_inside(seen_in_own_light(lit), half)) << "too dim";
  // A bulb, and one in a ball that is not clear.
  for (const bool is_clear : {true, false}) {
    SceneDescription bulb = cube({sphere({0, 1, 0}, 0.4f)});
    bulb.materials.emplace_back();
    if (is_clear) bulb.materials.back().node = DielectricMaterial{};
    bulb.shapes[0].material = 1;
    add_light(bulb, point_light({0, 1, 0}));
    add_light(bulb, point_light({0, 1, 9}, 1e-3f));
    EXPECT_EQ(is_inside(seen_in_own_light(bulb), half), is_clear);
  }
  SceneDescription sunny = cube({});
  add_lamp(sunny, {0, 1.99f, 0});
  add_light(sunny, distant_light({0, 1, 3}, 10));
  EXPECT_FALSE(is_inside(seen_in_own_light(sunny), half));
}

const std::string models = LANTHORN_SOURCE_DIR "/tests/scenes/models/";

// The scene, scaled by this factor.
SceneDescription scaled(SceneDescription scene, float factor) {
  for (Shape& shape : scene.shapes)
    for (Point& p : std::get<TriangleMesh>(shape.geometry).positions) p *= factor;
  return scene;
}
// The number of these points that are visible to the stand-in camera.
int count_seen(const SceneDescription& description, const std::vector<Point>& places) {
  const View view = make_view(description.view);
  const Point eye = eye_of(description);
  const Scene scene(description);
  return static_cast<int>(std::count_if(places.begin(), places.end(), [&](const Point& p) {
    Ray ray(eye, normalize(p - eye));
    ray.t_max = 0.999f * std::sqrt(distance_squared(p, eye));
    return view.camera.connect(p, {0.5f, 0.5f}, 0.5f) && scene.visible(ray);
  }));
}

// In a room with three cards, open towards -x, all cards are visible; in a box with z up, open towards -y, the block,
// the back wall and the floor, and the picture is upright.
TEST(StandInRooms, AreSeenThroughTheirOpenSide) {
  const SceneDescription room = read_scene(models + "room-open-x.obj");
  EXPECT_LT(eye_of(room).x, -3);
  EXPECT_EQ(count_seen(room, {{-1, 0.7f, -1.5f}, {0.5f, 1.2f, 0}, {-0.5f, 0.5f, 1.6f}}), 3);
  const SceneDescription box = read_scene(models + "zup-cornell.obj");
  EXPECT_LT(eye_of(box).y, -2);
  EXPECT_EQ(count_seen(box, {{0.1f, -0.2f, 0.4f}, {0.9f, 1, 1}, {-0.8f, -0.5f, 0}}), 3);
  const lanthorn::Camera camera = make_view(box.view).camera;
  const auto low = camera.connect({0, 1, 0.1f}, {0.5f, 0.5f}, 0.5f);
  const auto high = camera.connect({0, 1, 1.9f}, {0.5f, 0.5f}, 0.5f);
  ASSERT_TRUE(low && high);
  EXPECT_LT(high->raster.y, low->raster.y - 100);
}

// Boxes that contain three objects: open on any side, of any size, with either winding, with and without a lamp.
TEST(StandInRooms, AreSeenThroughAnyOpenSideAtAnySize) {
  const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const std::vector<Vec3> outwards{x, -x, y, -y, z, -z};
  for (std::size_t open = 0; open < 6; ++open)
    for (const float side : {1.0f, -1.0f}) {
      const float size = side > 0 ? 1e-4f : 1e4f;
      const std::vector<Shape> walls = {square(x, side * z, y),   square(-x, -side * z, y), square(y, side * x, z),
                                        square(-y, -side * x, z), square(z, -side * x, y),  square(-z, side * x, y)};
      std::vector<Shape> shapes{sphere({0.5f, -0.4f, 0.3f}, 0.2f), sphere({-0.5f, 0.4f, 0.1f}, 0.2f),
                                sphere({0, 0, -0.5f}, 0.2f)};
      for (std::size_t i = 0; i < 6; ++i)
        if (i != open) shapes.push_back(walls[i]);
      for (const bool is_lit : {false, true}) {
        SceneDescription scene = scaled(scene_of(shapes), size);
        if (is_lit) add_light(scene, point_light(Point(0, 0.7f, 0) * size));
        add_stand_ins(scene, {true, !is_lit, {{0}, false}});
        EXPECT_GT(dot(eye_of(scene) / size, outwards[open]), 1.5f)
            << open << " side " << side << " lit " << is_lit << ": " << scene.warnings.back().message;
      }
    }
}

TEST(StandInRooms, AreFramedAlikeAtAnySize) {
  const SceneDescription tiny = read_scene(models + "tiny-cornell.obj");
  SceneDescription model = tiny;
  model.view = {};
  for (const float factor : {1.0f, 100.0f, 1e4f, 1e6f, 1e8f}) {
    SceneDescription larger = scaled(model, factor);
    add_stand_ins(larger, {true, false, {{0, 1, 2}, false}});
    EXPECT_LT(length(eye_of(larger) / factor - eye_of(tiny)), 1e-3f * length(eye_of(tiny))) << factor;
  }
  // It is seen through its open side, as large as the picture allows.
  EXPECT_GT(eye_of(tiny).z, 6e-5f);
  EXPECT_LT(eye_of(tiny).z, 3e-4f);
}

// If the view treats z as up, the studio's lamps do so as well.
TEST(StandInRooms, WithZUpAreLitFromThere) {
  std::vector<Shape> shapes = room(
      {1, 1, 1}, {sphere({0.5f, -0.4f, 0.3f}, 0.2f), sphere({-0.5f, 0.4f, 0.1f}, 0.2f), sphere({0, 0, -0.5f}, 0.2f)});
  for (const auto& [wall, up] : {std::pair<std::size_t, Vec3>{6, {0, 0, 1}}, {8, {0, 1, 0}}}) {
    std::vector<Shape> open = shapes;
    open.erase(open.begin() + static_cast<std::ptrdiff_t>(wall));
    const SceneDescription scene = seen(open, {{0}, false});
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_LT(length(scene.lights[0].light_to_world.vector({0, 0, 1}) - up), 1e-6f) << scene.warnings.back().message;
  }
}

// A house without a floor, as many models are, is viewed from outside: from below nothing more is visible.
TEST(StandInRooms, HousesWithoutAFloorAreNotSeenFromBelow) {
  std::vector<Shape> house = room({2, 1, 1.5f}, {});
  house.erase(house.begin() + 3);
  EXPECT_GT(eye_of(seen(house, {{0}, false})).y, 0);
}

// A spot light inside a closed figure on a stage. The file is lit as if it had no light, and seen from outside.
TEST(StandInLight, LightsThatMeshesEncloseGetTheHelpOfTheStudio) {
  const SceneDescription scene = read_scene(models + "lamp-in-figure-spot.gltf");
  const Point eye = eye_of(scene);
  EXPECT_GT(std::sqrt(length_squared(eye)), 4);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<description::InfiniteLight>(scene.lights[1].node));
  EXPECT_TRUE(scene.view.film.measures_exposure) << "if the lamp does shine through";
  const std::string& said = scene.warnings.back().message;
  EXPECT_TRUE(said.starts_with("the file has no camera, and its lights are inside closed meshes")) << said;
  EXPECT_TRUE(said.ends_with("in a studio of three soft lamps, stands in")) << said;
}

TEST(StandIns, TheStudioIsTurnedToTheCamera) {
  SceneDescription scene = scene_of({sphere({0, 0, 0}, 1)});
  add_stand_ins(scene, {true, true, {}});
  const auto brightness = [](const SceneDescription& s, const Direction& towards) {
    const Scene built(s);
    const Wavelengths w = Wavelengths::rgb(0.5f);
    return emitted_infinite(built.lights().at(0), Point(0), towards, w)[0];
  };
  const Direction key = normalize(Vec3(-1, std::sqrt(2.0f), 1));  // left of a camera at +z, and above
  EXPECT_GT(brightness(scene, key), 2);
  EXPECT_LT(brightness(scene, {0, 0, 1}), 1);
  EXPECT_GT(brightness(scene, {0, -1, 0}), 0.05f);
  scene = scene_of({sphere({0, 0, 0}, 1)});
  scene.view.camera.camera_to_world = AnimatedTransform(look_at({9, 0, 0}, {0, 0, 0}, {0, 1, 0}).inverted());
  add_stand_ins(scene, {false, true, {}});
  EXPECT_GT(brightness(scene, normalize(Vec3(1, std::sqrt(2.0f), 1))), 2);
  EXPECT_LT(brightness(scene, key), 1);
}

TEST(StandIns, OneLineSaysWhatStandsIn) {
  const auto said = [](bool camera, bool light) {
    SceneDescription scene = scene_of({sphere({0, 0, 0}, 1)});
    add_stand_ins(scene, {camera, light, {}});
    EXPECT_EQ(scene.view.film.measures_exposure, !light);
    std::string text;
    for (const Warning& w : scene.warnings) text += w.location.file + ": " + w.message + "\n";
    return text;
  };
  EXPECT_EQ(said(true, true),
            "model: the file has no camera and no light: a view of all of it from the front, in a studio of three soft "
            "lamps, stands in\n");
  EXPECT_EQ(said(true, false), "model: the file has no camera: a view of all of it from the front stands in\n");
  EXPECT_EQ(said(false, true), "model: the file has no light: a studio of three soft lamps stands in\n");
  EXPECT_EQ(said(false, false), "");
}

// A wall that a distant light of irradiance 3 meets at right angles, from the camera's side. A third of that light, as
// the radiance of a white wall, is 3 / 3 / pi.
TEST(StandInLight, MetalUnderPointLightsGetsADimStudio) {
  SceneDescription scene = scene_of({square({0, 0, 0}, {1, 0, 0}, {0, 1, 0})});
  add_light(scene, distant_light({0, 0, 1}, 3));
  scene.view.camera.camera_to_world = AnimatedTransform(look_at({0, 0, 9}, {0, 0, 0}, {0, 1, 0}).inverted());
  const auto lit = [](SceneDescription s, const StandIns& lacking) {
    add_stand_ins(s, lacking);
    return s;
  };
  const SceneDescription helped = lit(scene, {.reflects_darkness = true});
  ASSERT_EQ(helped.lights.size(), 2u);
  EXPECT_NEAR(std::get<InfiniteLight>(helped.lights[1].node).radiance.scale, 1 / pi, 1e-3f);
  EXPECT_TRUE(helped.view.film.measures_exposure);
  ASSERT_EQ(helped.warnings.size(), 1u);
  EXPECT_NE(helped.warnings[0].message.find("a dim studio is added"), std::string::npos);
  EXPECT_EQ(lit(scene, {}).lights.size(), 1u);
  EXPECT_EQ(lit(scene, {.gets_environment = true, .reflects_darkness = true}).lights.size(), 1u);
  SceneDescription ball = scene_of({sphere({0, 0, 0}, 1)});
  add_light(ball, distant_light({0, 0, 1}, 3));
  EXPECT_EQ(lit(ball, {.camera = true, .reflects_darkness = true}).lights.size(), 2u);
  // No light comes into a closed room.
  SceneDescription inside = scene_of(room({2, 1, 2}, {}));
  add_light(inside, point_light({0, 0, 0}));
  inside.view.camera.camera_to_world = AnimatedTransform(look_at({1, 0, 1}, {0, 0, 0}, {0, 1, 0}).inverted());
  EXPECT_EQ(lit(inside, {.reflects_darkness = true}).lights.size(), 1u);
  inside.view.camera.camera_to_world = AnimatedTransform(look_at({9, 3, 9}, {0, 0, 0}, {0, 1, 0}).inverted());
  EXPECT_EQ(lit(inside, {.reflects_darkness = true}).lights.size(), 2u);
}

TEST(StandIns, ASceneIsLitByLampsThatSendEnoughLight) {
  const auto is_lit = [](float radiance, float radius, bool has_others) {
    SceneDescription scene = scene_of({sphere({0, 0, 0}, radius)});
    scene.area_lights.emplace_back().radiance.value = RgbSpectrum{{radiance, radiance, radiance}};
    scene.shapes[0].area_light = 0;
    if (has_others) scene.shapes.push_back(sphere({9, 0, 0}, 1));
    const std::vector<Index> lamps{0};
    EXPECT_FALSE(is_lit_by(scene, {}));
    return is_lit_by(scene, lamps);
  };
  EXPECT_TRUE(is_lit(2, 0.3f, true));   // 18 % of the light of a sky
  EXPECT_FALSE(is_lit(2, 0.1f, true));  // 2 %
  EXPECT_FALSE(is_lit(1, 0.9f, true));  // too dim
  EXPECT_TRUE(is_lit(100, 0.03f, true));
  EXPECT_FALSE(is_lit(100, 1, false));  // nothing to illuminate
}

}  // namespace
}  // namespace lanthorn::stand_ins_test
