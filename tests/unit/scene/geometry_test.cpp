// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Ray intersections with shapes, and the geometry of the surface at the hit.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <glm/common.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "math/affine.h"
#include "shape/patch.h"
#include "shape/quadric.h"
#include "support/scene_text.h"

namespace lanthorn::geometry_test {
namespace {

using test::look;
using test::random_ray;
using test::world;

// Converts a grid over a parametric surface to a triangle mesh, as scene text.
std::string tessellated(const std::function<Vec3(float, float)>& surface, int n) {
  std::ostringstream points, indices;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const Vec3 p =
          surface(static_cast<float>(i) / static_cast<float>(n), static_cast<float>(j) / static_cast<float>(n));
      points << p.x << ' ' << p.y << ' ' << p.z << ' ';
      if (i == n || j == n) continue;
      const int a = i * (n + 1) + j, b = a + n + 1;
      indices << a << ' ' << b << ' ' << b + 1 << ' ' << a << ' ' << b + 1 << ' ' << a + 1 << ' ';
    }
  return R"(Shape "trianglemesh" "point3 P" [)" + points.str() + R"(] "integer indices" [)" + indices.str() + "]\n";
}

// A transformation that shears, stretches and mirrors, with no special symmetry.
const char* const odd_transform = "ConcatTransform [0.9 0.3 0 0  0.2 -1.3 0.1 0  0 0.4 0.7 0  0.5 -0.2 0.3 1]\n";

std::string concat_transform(const Transform& t) {
  std::ostringstream text;
  text.precision(9);
  text << "ConcatTransform [";
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) text << t.matrix[c][r] << ' ';
  return text.str() + "]\n";
}

struct ExactShape {
  const char* name;
  const char* exact;
  std::function<Vec3(float, float)> surface;
};

std::vector<ExactShape> exact_shapes() {
  constexpr float degree = pi / 180;
  const auto on_sphere = [](float theta, float phi) {
    return Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  return {
      {"sphere", R"(Shape "sphere" "float radius" 1
)",
       [=](float u, float v) { return on_sphere(pi * v, 2 * pi * u); }},
      {"cut sphere",
       R"(Shape "sphere" "float radius" 1 "float zmin" -0.4 "float zmax" 0.7 "float phimax" 250
)",
       [=](float u, float v) { return on_sphere(lerp(v, std::acos(-0.4f), std::acos(0.7f)), 250 * degree * u); }},
      {"cylinder", R"(Shape "cylinder" "float radius" 0.8 "float zmin" -0.6 "float zmax" 0.9
)",
       [](float u, float v) {
         return Vec3(0.8f * std::cos(2 * pi * u), 0.8f * std::sin(2 * pi * u), lerp(v, -0.6f, 0.9f));
       }},
      {"cut cylinder",
       R"(Shape "cylinder" "float radius" 0.8 "float zmin" -0.6 "float zmax" 0.9 "float phimax" 100
)",
       [](float u, float v) {
         const float phi = 100 * degree * u;
         return Vec3(0.8f * std::cos(phi), 0.8f * std::sin(phi), lerp(v, -0.6f, 0.9f));
       }},
      {"ring",
       R"(Shape "disk" "float radius" 0.9 "float innerradius" 0.3 "float height" 0.2 "float phimax" 300
)",
       [](float u, float v) {
         const float phi = 300 * degree * u;
         const float r = lerp(v, 0.9f, 0.3f);
         return Vec3(r * std::cos(phi), r * std::sin(phi), 0.2f);
       }},
      {"patch", R"(Shape "bilinearmesh" "point3 P" [-1 -1 0.5  1 -1 -0.4  -1 1 -0.6  1 0.8 0.7]
)",
       [](float u, float v) {
         const Vec3 bottom = (1 - u) * Vec3(-1, -1, 0.5f) + u * Vec3(1, -1, -0.4f);
         const Vec3 top = (1 - u) * Vec3(-1, 1, -0.6f) + u * Vec3(1, 0.8f, 0.7f);
         return (1 - v) * bottom + v * top;
       }},
  };
}

TEST(SceneShapes, ExactShapesAgreeWithFineMeshesUnderAnyTransform) {
  for (const ExactShape& shape : exact_shapes())
    for (const char* transform : {"", odd_transform}) {
      SCOPED_TRACE(std::string(shape.name) + transform);
      const Scene exact = world(std::string(transform) + shape.exact);
      const Scene mesh = world(std::string(transform) + tessellated(shape.surface, 128));
      HashRng rng(1);
      int hits = 0, disagree = 0;
      for (int i = 0; i < 4000; ++i) {
        const Ray ray = random_ray(rng, {0.3f, -0.1f, 0.2f}, 1.2f);
        const auto a = exact.intersect(ray, test::white), b = mesh.intersect(ray, test::white);
        if (a.has_value() != b.has_value()) {
          ++disagree;  // at rims, since the mesh is inscribed
          continue;
        }
        if (!a) continue;
        ++hits;
        const float grazing = std::fabs(dot(ray.direction, a->normal));
        if (grazing < 0.2f) continue;
        if (length_squared(a->position - b->position) > sqr(0.02f)) {
          ++disagree;
          continue;
        }
        EXPECT_GT(std::fabs(dot(a->normal, b->normal)), 0.995f);
        EXPECT_EQ(exact.visible(ray), false);
      }
      EXPECT_GT(hits, 400);
      EXPECT_LT(disagree, 60);
    }
}

TEST(SceneShapes, HitsLieOnTheQuadricToWithinTheirErrorBound) {
  // A point p of the sphere of radius r about c: | |p - c| - r | is the distance from the surface.
  const Scene scene = world(R"(Translate 100 -50 30
Shape "sphere" "float radius" 3
)");
  HashRng rng(2);
  for (int i = 0; i < 2000; ++i) {
    const auto at = scene.intersect(random_ray(rng, {100, -50, 30}, 3), test::white);
    ASSERT_TRUE(at);
    const double off = std::fabs(glm::length(DVec3(at->position) - DVec3(100, -50, 30)) - 3);
    EXPECT_LE(off, dot(abs(at->normal), at->position_error) * 1.0001 + 1e-12);
    EXPECT_GT(dot(at->normal, at->position - Point(100, -50, 30)), 2.99f);
  }
}

TEST(SceneShapes, FarOriginsDoNotMissSmallSpheres) {
  const Scene scene = world(R"(Shape "sphere" "float radius" 0.001
)");
  HashRng rng(3);
  for (int i = 0; i < 1000; ++i) {
    const Point from = 1000.0f * sample_uniform_sphere(rng.next2());
    const auto at = look(scene, from, -from);
    ASSERT_TRUE(at);
    EXPECT_NEAR(std::sqrt(length_squared(at->position)), 0.001f, 1e-8f);
  }
}

TEST(SceneShapes, ParametersRunAsInPbrt) {
  struct Case {
    const char* shape;
    Point on_surface;
    Vec3 outside;
    Vec2 uv;
  };
  const std::array<Case, 5> cases{{
      {R"(Shape "sphere" "float radius" 2)", {0, 2, 0}, {0, 1, 0}, {0.25f, 0.5f}},
      {R"(Shape "sphere" "float radius" 2 "float zmin" 0)",
       {0, 2 * std::sqrt(0.75f), 1},
       {0, std::sqrt(0.75f), 0.5f},
       {0.25f, 1.0f / 3}},
      {R"(Shape "cylinder" "float radius" 2 "float zmin" -1 "float zmax" 3)", {-2, 0, 2}, {-1, 0, 0}, {0.5f, 0.75f}},
      {R"(Shape "disk" "float radius" 2 "float innerradius" 1)", {0, 1.5f, 0}, {0, 0, 1}, {0.25f, 0.5f}},
      {R"(Shape "bilinearmesh" "point3 P" [0 0 0  2 0 0  0 4 0  2 4 0])", {0.5f, 3, 0}, {0, 0, 1}, {0.25f, 0.75f}},
  }};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.shape);
    const std::string textured =
        R"(Texture "t" "spectrum" "checkerboard" Material "diffuse" "texture reflectance" "t"
)";
    const auto at = look(world(textured + c.shape), c.on_surface + c.outside, -c.outside);
    ASSERT_TRUE(at);
    EXPECT_NEAR(dot(at->normal, c.outside), 1, 1e-5f);
    EXPECT_NEAR(at->uv.x, c.uv.x, 1e-5f);
    EXPECT_NEAR(at->uv.y, c.uv.y, 1e-5f);
  }
}

TEST(SceneShapes, PatchHitsLieOnRayAndPatch) {
  HashRng rng(4);
  const auto random = [&] { return DVec3(rng.next() - 0.5, rng.next() - 0.5, rng.next() - 0.5); };
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const Patch patch{random(), random() + DVec3(1, 0, 0), random() + DVec3(0, 1, 0), random() + DVec3(1, 1, 0)};
    // A ray through a known point of the patch must hit it.
    const double u = rng.next(), v = rng.next();
    const Point origin(rng.next() * 4 - 2, rng.next() * 4 - 2, rng.next() + 1);
    const Vec3 direction(patch.position(u, v) - DVec3(origin));
    const PatchHits hits = intersect(patch, origin, direction, 0, infinity);
    bool known = false;
    for (int k = 0; k < hits.count; ++k) {
      const auto& hit = hits.hits[static_cast<unsigned>(k)];
      const DVec3 on_ray = DVec3(origin) + hit.t * DVec3(direction);
      EXPECT_LT(glm::length(on_ray - patch.position(hit.u, hit.v)), 1e-9);
      known = known || glm::length(on_ray - patch.position(u, v)) < 1e-5;
    }
    found += known ? 1 : 0;
  }
  EXPECT_GE(found, 1995);  // rays tangent to the patch may hit or miss
}

// The outside of surfaces is as in pbrt-v4, for each shape, with ReverseOrientation and mirroring. pbrt flips triangles
// and patches in world space, so that mirroring alone changes nothing, and quadrics in object space.
TEST(SceneOrientation, FollowsPbrt) {
  const char* const triangle =
      R"(Shape "trianglemesh" "point3 P" [-9 -9 0 9 -9 0 0 9 0] "integer indices" [0 1 2]
)";
  const char* const with_normals =
      R"(Shape "trianglemesh" "point3 P" [-9 -9 0 9 -9 0 0 9 0] "normal N" [0 0 -1 0 0 -1 0 0 -1] "integer indices" [0 1 2]
)";
  const char* const patch = R"(Shape "bilinearmesh" "point3 P" [-9 -9 0 9 -9 0 -9 9 0 9 9 0]
)";
  const char* const bent = R"(Shape "bilinearmesh" "point3 P" [-9 -9 0 9 -9 0 -9 9 0 9 9 0.5]
)";
  const char* const disk = R"(Shape "disk" "float radius" 9
)";
  const char* const sphere = R"(Translate 0 0 -9 Shape "sphere" "float radius" 9
)";
  struct Case {
    const char* shape;
    float plain, reversed, mirrored, both;  // sign of the normal's z
  };
  const char* const cylinder =
      R"(Translate 0 0 -9 Rotate 90 0 1 0 Shape "cylinder" "float radius" 9 "float zmin" -9 "float zmax" 9
)";
  const char* const half_sphere =
      R"(Translate 0 0 -9 Shape "sphere" "float radius" 9 "float zmin" 0 "float phimax" 180
)";
  const char* const subdivided =
      R"(Shape "loopsubdiv" "point3 P" [-9 -9 0 9 -9 0 0 9 0] "integer indices" [0 1 2]
)";
  const char* const tube =
      R"(Shape "curve" "string type" "cylinder" "point3 P" [-9 0 -4 -3 0 -4 3 0 -4 9 0 -4] "float width" 8
)";
  const char* const flat = R"(Shape "curve" "point3 P" [-9 0 0 -3 0 0 3 0 0 9 0 0] "float width" 2
)";
  const char* const ribbon =
      R"(Shape "curve" "string type" "ribbon" "point3 P" [-9 0 0 -3 0 0 3 0 0 9 0 0] "float width" 8 "normal N" [0 0 -1 0 0 -1]
)";
  // Curves follow pbrt-v4 only in that flat ones face the viewer: in pbrt-v4 tubes are flat, and mirroring turns them.
  const std::array<Case, 12> cases{{{triangle, 1, -1, 1, -1},
                                    {cylinder, 1, -1, -1, 1},
                                    {half_sphere, 1, -1, -1, 1},
                                    {subdivided, -1, 1, -1, 1},
                                    {tube, 1, -1, 1, -1},
                                    {flat, 1, -1, 1, -1},
                                    {ribbon, -1, 1, -1, 1},
                                    {with_normals, -1, 1, -1, 1},
                                    {patch, 1, -1, 1, -1},
                                    {bent, 1, -1, 1, -1},
                                    {disk, 1, -1, -1, 1},
                                    {sphere, 1, -1, -1, 1}}};
  const auto z = [](const std::string& directives) {
    const auto at = look(world(directives), {0.1f, 0.2f, 5}, {0, 0, -1});
    EXPECT_TRUE(at);
    if (!at) return 0.0f;
    EXPECT_GT(dot(at->normal, at->shading.n), 0.99f);
    return at->normal.z;
  };
  const std::string reverse = "ReverseOrientation\n", mirror = "Scale -1 1 1\n";
  for (const Case& c : cases) {
    SCOPED_TRACE(c.shape);
    EXPECT_NEAR(z(c.shape), c.plain, 0.02f);
    EXPECT_NEAR(z(reverse + c.shape), c.reversed, 0.02f);
    EXPECT_NEAR(z(mirror + c.shape), c.mirrored, 0.02f);
    EXPECT_NEAR(z(mirror + reverse + c.shape), c.both, 0.02f);
  }
}

TEST(SceneOrientation, InstancesKeepTheSideOfTheirShapes) {
  for (const char* shape : {R"(Shape "disk" "float radius" 9
)",
                            R"(Shape "bilinearmesh" "point3 P" [-9 -9 0 9 -9 0 -9 9 0 9 9 0]
)"})
    for (const char* scale : {"Scale 1 1 1\n", "Scale -1 1 1\n", "Scale 2 -3 1\n"}) {
      const Scene scene = world(std::string(R"(ObjectBegin "o"
)") + shape + "ObjectEnd\n" + scale +
                                R"(ObjectInstance "o"
)");
      const auto at = look(scene, {0.1f, 0.2f, 5}, {0, 0, -1});
      ASSERT_TRUE(at);
      EXPECT_NEAR(at->normal.z, 1, 1e-5f);
    }
}

TEST(SceneOrientation, ShadingNormalsAreInterpolatedAndDecideTheSide) {
  const Scene scene = world(
      R"(Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "normal N" [0 0 -1  0.6 0 -0.8  0 0.6 -0.8] "integer indices" [0 1 2]
)");
  const auto at = look(scene, {0.25f, 0.25f, 3}, {0, 0, -1});
  ASSERT_TRUE(at);
  const Vec3 expected = normalize(Vec3(0.15f, 0.15f, -0.9f));
  EXPECT_NEAR(at->normal.z, -1, 1e-6f);
  EXPECT_NEAR(dot(at->shading.n, expected), 1, 1e-6f);
}

TEST(SceneInstances, AreTheSameAsBakedShapes) {
  const std::string shapes =
      R"(Material "conductor" "float uroughness" 0.1 "float vroughness" 0.3
Shape "trianglemesh" "point3 P" [-1 -1 0.2 1 -1 0 -0.3 1 0.5] "normal N" [0.1 0 1 0 0.2 1 0 0 1] "point2 uv" [0 0 2 0 1 3] "integer indices" [0 1 2]
Shape "bilinearmesh" "point3 P" [-1 -1 0.5  1 -1 1.4  -1 1 1.6  1 0.8 0.7]
Shape "cylinder" "float radius" 0.4 "float zmin" -1 "float zmax" 0
Shape "curve" "string type" "cylinder" "point3 P" [-1 -1 -1 -0.3 0 -1 0.3 0 -1 1 1 -1] "float width" 0.5
Shape "curve" "point3 P" [1 -1 -1 0.3 0 -0.5 -0.3 0 -0.5 -1 1 -0.5] "float width" 0.5
Shape "curve" "string type" "ribbon" "point3 P" [1 -1 0 0.3 0 0.5 -0.3 0 0.5 -1 1 0.5] "normal N" [0 0 1 0.5 0 1] "float width" 0.5
)";
  // No mirroring: pbrt's rule would flip quadrics.
  const std::string transform = "ConcatTransform [0.9 0.3 0 0  0.2 1.3 0.1 0  0 0.4 0.7 0  3 -2 1 1]\n";
  const Scene baked = world(transform + shapes);
  const Scene placed = world(R"(ObjectBegin "o"
)" + shapes + "ObjectEnd\n" + transform +
                             R"(ObjectInstance "o"
)");
  HashRng rng(5);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray = random_ray(rng, {3, -2, 1}, 1.5f);
    const auto a = baked.intersect(ray, test::white), b = placed.intersect(ray, test::white);
    EXPECT_EQ(placed.visible(ray), !b);
    if (a.has_value() != b.has_value()) continue;  // a ray that grazes a rim
    if (!a || length_squared(a->position - b->position) > 1e-6f) continue;
    ++hits;
    EXPECT_GT(dot(a->normal, b->normal), 0.99999f);
    EXPECT_GT(dot(a->shading.n, b->shading.n), 0.99999f);
    EXPECT_GT(dot(a->shading.s, b->shading.s), 0.9999f);
    EXPECT_LT(length_squared(Vec3(a->uv - b->uv, 0)), 1e-6f);
  }
  EXPECT_GT(hits, 800);
}

// A ray at a given time sees the same as in a static scene of that time.
TEST(SceneMotion, EqualsStillScenesAtEveryTime) {
  const AnimatedTransform path(rotate(20, {0, 1, 0}) * scale({1, 1.2f, 0.8f}),
                               translate({0.5f, 0.3f, -0.2f}) * rotate(130, {1, 1, 0}) * scale({0.7f, 1, 1.1f}), 0, 1);
  const std::string moving = "ActiveTransform StartTime\n" + concat_transform(path.start) +
                             "ActiveTransform EndTime\n" + concat_transform(path.end) + "ActiveTransform All\n";
  const std::string mesh = R"(Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]
)";
  const std::string sphere = R"(Shape "sphere" "float radius" 0.6
)";
  const std::string head =
      R"(TransformTimes 0 1
Camera "perspective" "float shutteropen" 0 "float shutterclose" 1
)";
  const std::string tube =
      R"(Shape "curve" "string type" "cylinder" "point3 P" [-1 -1 0 -0.3 0 0.4 0.3 0 -0.5 1 1 0] "float width" 0.6
)";
  const std::array<std::pair<std::string, std::string>, 5> cases{{
      {moving + tube, tube},
      {moving + mesh, mesh},
      {moving + sphere, sphere},
      {R"(ObjectBegin "o"
)" + mesh + sphere +
           "ObjectEnd\n" + moving + R"(ObjectInstance "o"
)",
       mesh + sphere},
      {R"(ObjectBegin "o"
AttributeBegin
)" + moving +
           sphere + R"(AttributeEnd
ObjectEnd
ObjectInstance "o"
)",
       sphere},
  }};
  for (const auto& [animated, shape] : cases) {
    SCOPED_TRACE(animated);
    const Scene scene = world(animated, head);
    EXPECT_TRUE(scene.has_motion());
    for (const float time : {0.0f, 0.13f, 0.5f, 0.87f, 1.0f}) {
      const Scene still = world(concat_transform(path.at(time)) + shape);
      EXPECT_FALSE(still.has_motion());
      HashRng rng(6);
      int hits = 0, disagree = 0;
      for (int i = 0; i < 500; ++i) {
        const Ray ray = random_ray(rng, {0.2f, 0.1f, 0}, 1.5f, time);
        const auto a = scene.intersect(ray, test::white), b = still.intersect(ray, test::white);
        EXPECT_EQ(scene.visible(ray), !a);
        if (a.has_value() != b.has_value() || (a && length_squared(a->position - b->position) > 1e-8f)) {
          ++disagree;
          continue;
        }
        if (!a) continue;
        ++hits;
        EXPECT_GT(dot(a->normal, b->normal), 0.9999f);
        EXPECT_EQ(a->time, time);
      }
      EXPECT_GT(hits, 40);
      EXPECT_LE(disagree, 3);
    }
  }
}

TEST(SceneMotion, MotionAgreesWithAnimatedTransform) {
  const AnimatedTransform path(translate({1, 2, 3}) * rotate(250, {1, 2, -1}) * scale({-1, 1, 2}),
                               rotate(10, {0, 0, 1}) * scale({-2, 1, 1}), 0.25f, 2);
  const Motion motion(path);
  for (const float time : {-1.0f, 0.25f, 0.3f, 1.0f, 1.7f, 2.0f, 5.0f}) {
    const Transform expected = path.at(time);
    std::optional<Affine> moved;
    const Affine& got = motion.at(time, moved);
    for (const Point& p : {Point(0, 0, 0), Point(1, -2, 0.5f)})
      EXPECT_LT(length_squared(expected.point(p) - Point(got.point(DVec3(p)))), 1e-9f) << time;
  }
}

// A closed torus: no ray from inside gets out, even if aimed at an edge. If a ray is aimed exactly at a vertex,
// Embree's test can miss all triangles around it. A few in a thousand are tolerated; random rays are never that exact.
TEST(SceneRobustness, ClosedMeshesAreWatertight) {
  constexpr int n = 48;
  const auto torus = [](int i, int j) {
    const float a = 2 * pi * static_cast<float>(i % n) / n, b = 2 * pi * static_cast<float>(j % n) / n;
    return Vec3((1 + 0.4f * std::cos(b)) * std::cos(a), (1 + 0.4f * std::cos(b)) * std::sin(a), 0.4f * std::sin(b));
  };
  std::ostringstream points, indices;
  points.precision(9);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vec3 p = torus(i, j);
      points << p.x << ' ' << p.y << ' ' << p.z << ' ';
      const int a = i * n + j, b = (i + 1) % n * n + j, c = (i + 1) % n * n + (j + 1) % n, d = i * n + (j + 1) % n;
      indices << a << ' ' << b << ' ' << c << ' ' << a << ' ' << c << ' ' << d << ' ';
    }
  const std::string mesh =
      R"(Shape "trianglemesh" "point3 P" [)" + points.str() + R"(] "integer indices" [)" + indices.str() + "]\n";
  for (const char* place : {"", "Rotate 33 1 2 3\n"}) {
    const Scene scene = world(place + mesh);
    const Transform to_world = *place == 0 ? Transform() : rotate(33, {1, 2, 3});
    HashRng rng(7);
    int through_edges = 0, through_vertices = 0, anywhere = 0;
    for (int i = 0; i < 50000; ++i) {
      const float a = 2 * pi * rng.next();
      const Point inside = to_world.point({std::cos(a), std::sin(a), 0.1f * rng.next()});
      const int column = static_cast<int>(rng.next() * n), row = static_cast<int>(rng.next() * n);
      const Point p = to_world.point(torus(column, row)), q = to_world.point(torus(column + 1, row + (i & 1)));
      const float along = 0.001f + 0.998f * rng.next();
      through_edges += look(scene, inside, glm::mix(p, q, along) - inside) ? 0 : 1;
      through_vertices += look(scene, inside, p - inside) ? 0 : 1;
      anywhere += look(scene, inside, sample_uniform_sphere(rng.next2())) ? 0 : 1;
    }
    EXPECT_EQ(anywhere, 0);
    EXPECT_EQ(through_edges, 0);
    EXPECT_LE(through_vertices, 250);
  }
}

// Rays that leave the surface of a convex body outwards must not hit it again, and rays into it must, at all scales and
// far from the origin.
struct Body {
  const char* name;
  std::string directives;
};
std::vector<Body> convex_bodies() {
  std::ostringstream cube;
  for (const char* rotation :
       {"", "Rotate 90 1 0 0 ", "Rotate 180 1 0 0 ", "Rotate 270 1 0 0 ", "Rotate 90 0 1 0 ", "Rotate 270 0 1 0 "})
    cube << "AttributeBegin " << rotation
         << R"(Shape "bilinearmesh" "point3 P" [-1 -1 1  1 -1 1  -1 1 1  1 1 1] AttributeEnd
)";
  const std::string sphere = R"(Shape "sphere"
)";
  const auto placed = [](const std::string& shape) {
    return R"(ObjectBegin "o"
)" + shape +
           R"(ObjectEnd
ObjectInstance "o"
)";
  };
  return {{"cube", cube.str()},
          {"sphere", sphere},
          {"instanced cube", placed(cube.str())},
          {"instanced sphere", placed(sphere)},
          {"mesh sphere", tessellated(
                              [](float u, float v) {
                                return Vec3(std::sin(pi * v) * std::cos(2 * pi * u),
                                            std::sin(pi * v) * std::sin(2 * pi * u), std::cos(pi * v));
                              },
                              24)}};
}

TEST(SceneRobustness, RaysDoNotFindTheSurfaceTheyLeave) {
  for (const Body& body : convex_bodies())
    for (const float size : {1e-3f, 1.0f, 30.0f, 1e6f})
      for (const float far : {0.0f, 10.0f, 1e3f}) {
        SCOPED_TRACE(std::string(body.name) + " of size " + std::to_string(size) + " at " + std::to_string(far));
        const Vec3 centre = far * size * Vec3(0.7f, -0.55f, 0.31f);
        std::ostringstream place;
        place.precision(9);
        place << "Translate " << centre.x << ' ' << centre.y << ' ' << centre.z << "\nScale " << size << ' ' << size
              << ' ' << size << "\nRotate 29 1 2 3\n";
        // The transformation is the instance's; for other shapes it is applied to their vertices.
        std::string text = body.directives;
        const std::size_t instance = text.find("ObjectInstance");
        text.insert(instance == std::string::npos ? 0 : instance, place.str());
        const Scene scene = world(text);
        HashRng rng(8);
        int again = 0, lost = 0, hits = 0;
        for (int i = 0; i < 2000; ++i) {
          const Ray ray = random_ray(rng, centre, size);
          const auto at = scene.intersect(ray, test::white);
          if (!at) continue;
          ++hits;
          Vec3 local = sample_cosine_hemisphere(rng.next2());
          if (i % 2 == 0) local = normalize(Vec3(local.x, local.y, 0.01f * local.z));  // grazing
          const Frame frame(at->normal);
          const Vec3 outwards = frame.to_world(dot(ray.direction, at->normal) < 0 ? local : -local);
          if (scene.intersect(spawn_ray(*at, outwards), test::white)) ++again;
          if (i % 2 == 1 && !scene.intersect(spawn_ray(*at, -outwards), test::white)) ++lost;
        }
        EXPECT_GT(hits, 500);
        EXPECT_EQ(again, 0);
        EXPECT_LE(lost, far > 100 ? 8 : 2);  // rays within the error bound of an edge
      }
}

// Sends `rays` rays to points of `scene` given by `target`. Returns how many hit the surface again after leaving it.
template <class Target>
int found_again(const Scene& scene, HashRng& rng, int rays, float distance, Target&& target) {
  int again = 0;
  for (int i = 0; i < rays; ++i) {
    const Point at_target = target();
    const Point from = at_target + distance * sample_uniform_sphere(rng.next2());
    const auto at = look(scene, from, at_target - from);
    if (!at) continue;
    Vec3 local = sample_cosine_hemisphere(rng.next2());
    if (i % 2 == 0) local = normalize(Vec3(local.x, local.y, 0.01f * local.z));
    const Normal n = dot(from - at->position, at->normal) > 0 ? at->normal : -at->normal;
    again += scene.intersect(spawn_ray(*at, Frame(n).to_world(local)), test::white) ? 1 : 0;
  }
  return again;
}

Transform random_rotation(HashRng& rng) { return rotate(360 * rng.next(), sample_uniform_sphere(rng.next2())); }

TEST(SceneRobustness, RaysLeaveFlattenedInstancesFarAway) {
  HashRng rng(9);
  for (const float far : {0.0f, 10.0f, 1e3f})
    for (int i = 0; i < 30; ++i) {
      const Transform t = translate(far * sample_uniform_sphere(rng.next2())) * random_rotation(rng) *
                          scale({1, 0.01f, 0.7f}) * random_rotation(rng);
      for (const char* shape : {R"(Shape "sphere"
)",
                                R"(Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]
)"}) {
        const Scene scene = world(std::string(R"(ObjectBegin "o"
)") + shape + "ObjectEnd\n" + concat_transform(t) +
                                  R"(ObjectInstance "o"
)");
        EXPECT_EQ(found_again(scene, rng, 200, 2,
                              [&] {
                                const Vec2 u = 2.0f * rng.next2() - Vec2(1);
                                return t.point({u, 0});
                              }),
                  0)
            << far;
      }
    }
}

// Near a corner at the origin, the position is exact, but the plane through the other corners is not.
TEST(SceneRobustness, RaysLeaveLargeThinTrianglesNearACorner) {
  HashRng rng(10);
  for (const float thin : {1.0f, 0.01f, 1e-4f})
    for (unsigned first = 0; first < 3; ++first)
      for (int i = 0; i < 40; ++i) {
        const Transform t = random_rotation(rng);
        const std::array<Point, 3> corners{Point(0), Point(1000, 0, 0), Point(700, 1000 * thin, 0)};
        std::ostringstream text;
        text.precision(9);
        text << R"(Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [)";
        for (unsigned k = 0; k < 3; ++k) {
          const Point p = t.point(corners[(k + first) % 3]);
          text << p.x << ' ' << p.y << ' ' << p.z << ' ';
        }
        const Scene scene = world(text.str() + "]\n");
        EXPECT_EQ(found_again(scene, rng, 100, 10,
                              [&] {
                                const float a = rng.next(), b = rng.next() * (1 - a);
                                return t.point(std::pow(10.0f, -4 * rng.next()) * (a * corners[1] + b * corners[2]));
                              }),
                  0)
            << thin;
      }
}

TEST(SceneRobustness, OffsetsAreRoundingErrorsNotScales) {
  for (const float size : {1e-3f, 1.0f, 1e6f}) {
    std::ostringstream text;
    text << "Scale " << size << ' ' << size << ' ' << size << R"(
Rotate 29 1 2 3
Shape "bilinearmesh" "point3 P" )"
         << "[-1 -1 1  1 -1 1  -1 1 1  1 1 1]\n";
    const Scene scene = world(text.str());
    const Point target = rotate(29, {1, 2, 3}).point({0.3f, -0.4f, 1});
    const auto at = look(scene, size * 3 * target, -target);
    ASSERT_TRUE(at);
    EXPECT_LT(std::sqrt(length_squared(offset_origin(*at, at->normal) - at->position)), 1e-5f * size);
  }
  // Points on a large axis-aligned floor are exact.
  const Scene floor = world(R"(Shape "bilinearmesh" "point3 P" [-1e4 0 1e4  1e4 0 1e4  -1e4 0 -1e4  1e4 0 -1e4]
)");
  const auto at = look(floor, {123.4f, 5, -77}, {0.3f, -1, 0.2f});
  ASSERT_TRUE(at);
  EXPECT_EQ(offset_origin(*at, {0, 1, 0}).y, 0.0f);
  EXPECT_FALSE(floor.intersect(spawn_ray(*at, normalize(Vec3(1, 1e-4f, 0))), test::white));
}

// Rays hit shapes of all kinds, with and without an instance, at all distances up to the one at which a warning starts.
TEST(SceneRobustness, WhatIsTooFarIsWarnedOf) {
  const std::vector<std::string> shapes{R"(Shape "sphere")", R"(Shape "disk")",
                                        R"(Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0  -1 1 0  1 1 0])",
                                        R"(Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0.1  -1 1 0  1 1 0])",
                                        R"(Shape "curve" "point3 P" [-1 0 0  0 0 0  0 0 0  1 0 0] "float width" 0.1)"};
  struct Placed {
    std::string before, after;  // scene text before and after the scale
  };
  for (const std::string& shape : shapes)
    for (const auto& [before, after] :
         {Placed{"", "\n" + shape}, Placed{R"(ObjectBegin "o" )" + shape + " ObjectEnd ", R"(
ObjectInstance "o")"},
          Placed{"", "ActiveTransform EndTime Translate 0.1 0 0 ActiveTransform All\n" + shape}}) {
      const Scene near = world(before + "Scale 0.8e12 0.8e12 0.8e12 " + after);
      EXPECT_TRUE(near.warnings().empty()) << after;
      EXPECT_TRUE(look(near, {1e11f, 0, -0.9e12f}, {0, 0, 1})) << after;
      const Scene far = world(before + "Scale 1.2e12 1.2e12 1.2e12 " + after);
      ASSERT_EQ(far.warnings().size(), 1u) << after;
      EXPECT_EQ(far.warnings()[0].message, "the shape reaches farther than 1e12 from the origin: rays may miss it");
      EXPECT_EQ(far.warnings()[0].location.line, 5) << after;
    }
}

TEST(SceneRobustness, ShadowRaysStopShortOfTheLight) {
  const Scene scene = world(
      R"(Shape "bilinearmesh" "point3 P" [-1 0 1  1 0 1  -1 0 -1  1 0 -1]
Translate 0 1 0 Shape "bilinearmesh" "point3 P" [-1 0 1  1 0 1  -1 0 -1  1 0 -1]
)");
  const auto at = look(scene, {0.1f, 0.5f, 0}, {0, -1, 0});
  ASSERT_TRUE(at);
  const Point on_light(0.3f, 1, 0.2f), beyond(0.3f, 1.01f, 0.2f);
  const auto ray_to = [&](const Point& p) {
    return spawn_ray_to(*at, normalize(p - at->position), {p, {0, 1, 0}, 1e-6f});
  };
  EXPECT_TRUE(scene.visible(ray_to(on_light)));
  EXPECT_FALSE(scene.visible(ray_to(beyond)));
  EXPECT_FALSE(scene.visible(spawn_ray(*at, {0, 1, 0})));
}

}  // namespace
}  // namespace lanthorn::geometry_test
