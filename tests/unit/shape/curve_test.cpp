// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Hair: ray hits agree with the Bézier formula, and no hair intersects itself.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "shape/curves.h"
#include "support/error_text.h"
#include "support/scene_text.h"

namespace lanthorn::curve_test {
namespace {

using test::look;
using test::world;

const std::array<DVec3, 4> bent{{{-1, 0, 0}, {-0.4, 0.5, 0.2}, {0.3, 0.6, -0.1}, {1, 0, 0.3}}};
constexpr double width0 = 0.1, width1 = 0.04;
const char* const bent_points = R"("point3 P" [-1 0 0 -0.4 0.5 0.2 0.3 0.6 -0.1 1 0 0.3])";

std::string bent_curve(const std::string& type, const std::string& more = "") {
  return R"(Shape "curve" "string type" ")" + type + "\" " + bent_points +
         R"( "float width0" 0.1 "float width1" 0.04 )" + more + "\n";
}

struct OnCurve {
  DVec3 centre, tangent;
  double radius = 0;
};
OnCurve on_bent(double u) {
  // De Casteljau's algorithm, because the renderer uses another formula.
  const auto mix = [&](const DVec3& a, const DVec3& b) { return a + u * (b - a); };
  const DVec3 a = mix(bent[0], bent[1]), b = mix(bent[1], bent[2]), c = mix(bent[2], bent[3]);
  const DVec3 d = mix(a, b), e = mix(b, c);
  return {mix(d, e), glm::normalize(e - d), 0.5 * (width0 + u * (width1 - width0))};
}

DVec3 random_across(HashRng& rng, const DVec3& tangent) {
  const DVec3 r(sample_uniform_sphere(rng.next2()));
  return glm::normalize(r - tangent * glm::dot(r, tangent));
}

TEST(Curves, TubesAreWhereTheFormulaSays) {
  const Scene scene = world(bent_curve("cylinder"));
  EXPECT_EQ(scene.statistics().curves, 1u);
  HashRng rng(1);
  for (int i = 0; i < 2000; ++i) {
    const double u = 0.02 + 0.96 * rng.next();
    const OnCurve c = on_bent(u);
    const DVec3 out = random_across(rng, c.tangent);
    const DVec3 target = c.centre + c.radius * out;
    const DVec3 towards = -glm::normalize(out + 0.5 * DVec3(sample_uniform_sphere(rng.next2())));
    const auto at = look(scene, Point(target - 0.5 * towards), Vec3(towards));
    ASSERT_TRUE(at);
    EXPECT_LT(glm::length(DVec3(at->position) - target), 2e-5) << u;
    EXPECT_GT(glm::dot(DVec3(at->normal), out), 0.99);
    EXPECT_NEAR(at->uv.x, u, 1e-4);
    // v: distance of the surface point from the axis, as seen along the ray.
    const DVec3 across = glm::normalize(glm::cross(towards, c.tangent));
    EXPECT_NEAR(at->uv.y, 0.5 + 0.5 * glm::dot(out, across), 2e-3);
    EXPECT_FALSE(scene.visible({Point(target - 0.5 * towards), Direction(towards), infinity, 0}));
  }
}

// Normals are perpendicular to the surface even where the radius changes. Expected values are differences of positions.
TEST(Curves, TubesNormalsArePerpendicularToTheSurface) {
  description::Curves curves;
  curves.kind = description::CurveKind::cylinder;
  append_curve(curves, bent, 0.6f, 0.1f, {});
  const auto surface = [&](double u, const DVec3& out) {
    const OnCurve c = on_bent(u);
    const double radius = 0.3 + u * (0.05 - 0.3);
    const DVec3 across = glm::normalize(out - c.tangent * glm::dot(out, c.tangent));
    return evaluate(curves, 0, static_cast<float>(u), c.centre + radius * across, {1, 0, 0});
  };
  HashRng rng(2);
  for (int i = 0; i < 200; ++i) {
    const double u = 0.1 + 0.8 * rng.next(), h = 1e-3;
    const DVec3 out = random_across(rng, on_bent(u).tangent);
    const CurvePoint at = surface(u, out);
    const DVec3 along = surface(u + h, out).position - surface(u - h, out).position;
    EXPECT_NEAR(glm::dot(glm::normalize(along), at.normal), 0, 1e-3);
    EXPECT_NEAR(glm::length(at.normal), 1, 1e-12);
  }
}

TEST(Curves, FlatOnesFaceEveryRay) {
  const Scene scene = world(bent_curve("flat"));
  HashRng rng(3);
  for (int i = 0; i < 2000; ++i) {
    const double u = 0.02 + 0.96 * rng.next();
    const OnCurve c = on_bent(u);
    const DVec3 towards = glm::normalize(random_across(rng, c.tangent) + 0.3 * c.tangent);
    const DVec3 across = glm::normalize(glm::cross(towards, c.tangent));
    const double y = 1.7 * (rng.next() - 0.5);
    const DVec3 target = c.centre + y * c.radius * across;
    const auto at = look(scene, Point(target - 0.5 * towards), Vec3(towards));
    ASSERT_TRUE(at) << u << ' ' << y;
    EXPECT_LT(glm::length(DVec3(at->position) - target), 0.15 * c.radius);  // the curve is drawn as 16 quads
    EXPECT_NEAR(at->uv.x, u, 0.01);
    EXPECT_NEAR(at->uv.y, 0.5 + 0.5 * y, 0.03);
    EXPECT_NEAR(glm::dot(DVec3(at->normal), c.tangent), 0, 0.01);
    EXPECT_LT(glm::dot(DVec3(at->normal), towards), 0);
    // Just beyond its edge there is nothing.
    EXPECT_FALSE(look(scene, Point(c.centre + 1.1 * c.radius * across - 0.5 * towards), Vec3(towards)));
  }
}

TEST(Curves, RibbonsTurnWithTheirNormals) {
  const Scene scene = world(bent_curve("ribbon", R"("normal N" [0 0 1 0 -0.70710678 0.70710678])"));
  HashRng rng(4);
  for (int i = 0; i < 2000; ++i) {
    const double u = 0.02 + 0.96 * rng.next();
    const OnCurve c = on_bent(u);
    const DVec3 given(0, -std::sin(u * std::numbers::pi / 4), std::cos(u * std::numbers::pi / 4));  // even turn
    const DVec3 across = glm::normalize(glm::cross(given, c.tangent));
    const DVec3 normal = glm::cross(c.tangent, across);
    const double y = 1.9 * (rng.next() - 0.5);
    const DVec3 target = c.centre + y * c.radius * across;
    const auto at = look(scene, Point(target + 0.5 * normal), Vec3(-normal));
    ASSERT_TRUE(at) << u << ' ' << y;
    EXPECT_LT(glm::length(DVec3(at->position) - target), 0.15 * c.radius);
    EXPECT_GT(glm::dot(DVec3(at->normal), normal), 0.99);
    EXPECT_NEAR(at->uv.x, u, 0.01);
    EXPECT_NEAR(at->uv.y, 0.5 + 0.5 * y, 0.03);
    // From behind, the normal still points to the side that the file's normals choose.
    const auto behind = look(scene, Point(target - 0.5 * normal), Vec3(normal));
    ASSERT_TRUE(behind);
    EXPECT_GT(glm::dot(DVec3(behind->normal), normal), 0.99);
  }
}

// A straight hair is convex: a ray that leaves it outwards never hits it again, at any scale and position. A ray that
// enters a tube hits its other side.
TEST(Curves, NothingMeetsItself) {
  const std::string straight = R"("point3 P" [-1 0 0 -0.3 0.21 0 0.4 0.42 0 1.1 0.63 0] "float width" 0.02
)";
  for (const char* place : {"", "Scale 0.001 0.001 0.001\n", "Translate 30 -20 50\n", "Scale 100 100 100\n",
                            "ConcatTransform [0.9 0.3 0 0  0.2 1.3 0.1 0  0 0.4 0.7 0  3 -2 1 1]\n"})
    for (const std::string type : {"flat", "cylinder", "ribbon"}) {
      SCOPED_TRACE(place + type);
      const std::string normals = type == "ribbon" ? R"("normal N" [0 0.3 1 0 0.3 1] )" : "";
      const Scene scene = world(place + (R"(Shape "curve" "string type" ")" + type + "\" ") + normals + straight);
      const Bounds& box = scene.bounds();
      HashRng rng(5);
      int hits = 0, again = 0, through = 0;
      for (int i = 0; i < 4000; ++i) {
        const float x = 0.05f + 0.9f * rng.next();
        const Point middle = box.centre() + (x - 0.5f) * box.extent() * Vec3(1, 1, 0) * (place[0] == 'C' ? 0.0f : 1.0f);
        const Point from = middle + std::sqrt(length_squared(box.extent())) * sample_uniform_sphere(rng.next2());
        const auto at = look(scene, from, middle - from);
        if (!at || (type == "cylinder" && dot(at->normal, middle - from) > 0)) continue;  // through an open end
        ++hits;
        const Vec3 facing = dot(at->normal, middle - from) < 0 ? at->normal : -at->normal;
        Direction out = sample_uniform_sphere(rng.next2());
        if (dot(out, facing) < 0) out = -out;
        again += scene.visible(spawn_ray(*at, out)) ? 0 : 1;
        through += scene.visible(spawn_ray(*at, -out)) ? 0 : 1;
      }
      EXPECT_GT(hits, 500);
      EXPECT_EQ(again, 0) << "of " << hits;
      // Rays along the axis may leave through the open ends. Flat hairs have no inside.
      if (type == "cylinder")
        EXPECT_GT(through, hits * 97 / 100);
      else
        EXPECT_EQ(through, 0);
    }
}

TEST(Curves, StretchedTubesAreElliptic) {
  const Scene scene = world(
      R"(Scale 1 3 1
Shape "curve" "string type" "cylinder" "point3 P" [0 0 -1 0 0 -0.3 0 0 0.3 0 0 1] "float width" 0.2
)");
  HashRng rng(6);
  for (int i = 0; i < 500; ++i) {
    const float phi = 2 * pi * rng.next();
    const Point on(0.1f * std::cos(phi), 0.3f * std::sin(phi), rng.next() - 0.5f);
    const auto at = look(scene, {10 * on.x, 10 * on.y, on.z}, {-on.x, -on.y, 0});
    ASSERT_TRUE(at);
    EXPECT_LT(distance_squared(at->position, on), 1e-10f);
    EXPECT_GT(dot(at->normal, normalize(Vec3(on.x / 0.01f, on.y / 0.09f, 0))), 0.9999f);
  }
}

TEST(Curves, AlphaHoldsOnEveryKind) {
  const std::string texture =
      R"(Texture "t" "float" "checkerboard" "float uscale" 2 "float vscale" 0 "float tex1" 1 "float tex2" 0
)";
  for (const std::string type : {"flat", "cylinder", "ribbon"}) {
    SCOPED_TRACE(type);
    const std::string normals = type == "ribbon" ? R"("normal N" [0 -1 0 0 -1 0] )" : "";
    const Scene half = world(bent_curve(type, normals + R"("float alpha" 0.5)"));
    const Scene checked = world(texture + bent_curve(type, normals + R"("texture alpha" "t")"));
    HashRng rng(7);
    int seen = 0;
    constexpr int rays = 4000;
    for (int i = 0; i < rays; ++i) {
      const double u = 0.02 + 0.96 * rng.next();
      const Point target(on_bent(u).centre);
      const Vec3 towards = normalize(Vec3(rng.next() - 0.5f, rng.next() - 0.5f, 0) * 0.2f + Vec3(0, 1, 0));
      const Ray ray{target - towards, towards, infinity, 0};
      const auto at = half.intersect(ray, test::white);
      EXPECT_EQ(at.has_value(), !half.visible(ray));
      seen += at ? 1 : 0;
      if (std::fabs(u - 0.5) > 0.02) {
        EXPECT_EQ(look(checked, target - towards, towards).has_value(), u < 0.5) << u;
      }
    }
    // A tube has two walls. Tolerance of 5 standard deviations: false-alarm rate below 1e-6.
    const double expected = type == "cylinder" ? 0.75 : 0.5;
    EXPECT_NEAR(seen / static_cast<double>(rays), expected, 5 * 0.5 / std::sqrt(static_cast<double>(rays)));
  }
}

description::Curves read_curve(const std::string& parameters) {
  const SceneDescription scene = read_pbrt_string(R"(WorldBegin
Shape "curve" )" + parameters,
                                                  ".", "t.pbrt");
  EXPECT_TRUE(scene.warnings.empty());
  return std::get<description::Curves>(scene.shapes.at(0).geometry);
}

// Curves of every basis and degree equal the Bézier curve computed from that basis' own formula.
TEST(PbrtCurves, BasesAreConverted) {
  const std::string points = R"("point3 P" [0 0 0  1 2 0  2 -1 1  4 0 2  5 5 3])";
  const std::array<DVec3, 5> p{{{0, 0, 0}, {1, 2, 0}, {2, -1, 1}, {4, 0, 2}, {5, 5, 3}}};
  const auto check = [&](const std::string& parameters, std::size_t segments, auto formula) {
    SCOPED_TRACE(parameters);
    const description::Curves curves = read_curve(points + parameters);
    ASSERT_EQ(curves.segments.size(), segments);
    ASSERT_EQ(curves.points.size(), 3 * segments + 1);
    for (std::size_t i = 0; i < segments; ++i)
      for (const double u : {0.0, 0.3, 1.0}) {
        const double v = 1 - u;
        DVec3 at(0.0);
        const std::array<double, 4> basis{v * v * v, 3 * v * v * u, 3 * v * u * u, u * u * u};
        for (std::size_t k = 0; k < 4; ++k) at += basis[k] * DVec3(Vec3(curves.points[curves.segments[i] + k]));
        EXPECT_LT(glm::length(at - formula(i, u)), 1e-5) << i << ' ' << u;
      }
  };
  check(R"("integer degree" 2)", 2, [&](std::size_t i, double u) {
    const double v = 1 - u;
    return v * v * p[2 * i] + 2 * v * u * p[2 * i + 1] + u * u * p[2 * i + 2];
  });
  check(R"("integer degree" 2 "string basis" "bspline")", 3, [&](std::size_t i, double u) {
    return 0.5 * (1 - u) * (1 - u) * p[i] + (0.5 + u - u * u) * p[i + 1] + 0.5 * u * u * p[i + 2];
  });
  check(R"("string basis" "bspline")", 2, [&](std::size_t i, double u) {
    const double v = 1 - u;
    return (v * v * v * p[i] + (3 * u * u * u - 6 * u * u + 4) * p[i + 1] +
            (-3 * u * u * u + 3 * u * u + 3 * u + 1) * p[i + 2] + u * u * u * p[i + 3]) /
           6.0;
  });
}

TEST(PbrtCurves, WidthsRunOverTheWholeCurve) {
  const std::string points = R"("point3 P" [0 0 0 1 0 0 2 0 0 3 0 0 4 0 0 5 0 0 6 0 0])";
  const description::Curves curves =
      read_curve(points + R"( "float width0" 2 "float width1" 8 "integer splitdepth" 5)");
  for (std::size_t i = 0; i < 7; ++i) EXPECT_FLOAT_EQ(curves.points[i].w, 1 + static_cast<float>(i) / 2);
  EXPECT_FLOAT_EQ(read_curve(points).points[3].w, 0.5f);
  EXPECT_FLOAT_EQ(read_curve(points + R"("float width" 3 "float width1" 0)").points[0].w, 1.5f);
  EXPECT_FLOAT_EQ(read_curve(points + R"("float width" 3 "float width1" 0)").points[6].w, 0);
}

TEST(PbrtCurves, HairsThatBelongTogetherBecomeOneShape) {
  const std::string hair = R"(Shape "curve" "point3 P" [0 0 0 1 0 0 2 0 0 3 0 0]
)";
  const auto counts = [&](const std::string& world) {
    const SceneDescription scene = read_pbrt_string("WorldBegin\n" + world, ".", "t.pbrt");
    std::vector<std::size_t> result;
    for (const description::Shape& shape : scene.shapes)
      result.push_back(std::get<description::Curves>(shape.geometry).segments.size());
    return result;
  };
  using Counts = std::vector<std::size_t>;
  const std::string fur = R"(MakeNamedMaterial "m" "string type" "diffuse"
)";
  std::string placed;
  for (int i = 0; i < 100; ++i)
    placed += R"(AttributeBegin NamedMaterial "m" Translate 0 1 0 )" + hair + "AttributeEnd\n";
  EXPECT_EQ(counts(fur + placed), Counts{100});
  EXPECT_EQ(counts(hair + R"(Material "diffuse"
)" + hair + hair),
            (Counts{1, 2}));
  EXPECT_EQ(counts(hair + "ReverseOrientation " + hair), (Counts{1, 1}));
  EXPECT_EQ(counts(hair + "Scale 2 2 2 " + hair), Counts{2});
  EXPECT_EQ(counts(hair + "Scale 2 1 1 " + hair + hair), (Counts{1, 2}));
  EXPECT_EQ(counts(hair + R"(Attribute "shape" "float alpha" 0.5 )" + hair), (Counts{1, 1}));
  EXPECT_EQ(counts(R"(Shape "curve" "string type" "cylinder" "point3 P" [0 0 0 1 0 0 2 0 0 3 0 0]
)" + hair),
            (Counts{1, 1}));
  const SceneDescription scaled = read_pbrt_string("WorldBegin\nTranslate 1 0 0 Scale -2 2 2 " + hair, ".", "t.pbrt");
  const auto& curves = std::get<description::Curves>(scaled.shapes.at(0).geometry);
  EXPECT_EQ(curves.points[3], glm::vec4(-5, 0, 0, 1));
}

// The example scenes are read without a warning, into the expected shapes.
TEST(PbrtCurves, ScenesOfShapesAreRead) {
  const std::string folder = LANTHORN_SOURCE_DIR "/tests/scenes/";
  const Scene curves(read_scene(folder + "curves.pbrt"));
  EXPECT_TRUE(curves.warnings().empty());
  EXPECT_EQ(curves.statistics().curves, 110u + 8 + 2);
  const Scene subdivision(read_scene(folder + "subdivision.pbrt"));
  EXPECT_TRUE(subdivision.warnings().empty());
  EXPECT_EQ(subdivision.statistics().triangles, 12u * 256 + 7 * 64 + 8 * 256);
}

TEST(PbrtCurves, Errors) {
  const auto error = [](const std::string& parameters) {
    return test::error_text([&] {
      read_pbrt_string(R"(WorldBegin
Shape "curve" )" + parameters,
                       ".", "t.pbrt");
    });
  };
  const std::string points = R"("point3 P" [0 0 0 1 0 0 2 0 0 3 0 0] )";
  const std::string start = "t.pbrt:2:15: parameter ", later = "t.pbrt:2:52: parameter ";
  EXPECT_EQ(error(""), R"(t.pbrt:2:1: parameter "P" of Shape "curve" is missing)");
  EXPECT_EQ(error(R"("point3 P" [0 0 0 1 1 1])"),
            start + R"("P" of Shape "curve" has 2 points; a bezier curve of degree 3 needs 4 plus a multiple of 3)");
  EXPECT_EQ(error(R"("point3 P" [0 0 0 1 1 1] "string basis" "bspline")"),
            start + R"("P" of Shape "curve" has 2 points; a bspline curve of degree 3 needs 4 or more)");
  EXPECT_EQ(error(points + R"("integer degree" 4)"), later + R"("degree" of Shape "curve" must be 2 or 3)");
  EXPECT_EQ(error(points + R"("string basis" "b")"),
            later + R"("basis" of Shape "curve" must be bezier or bspline, not "b")");
  EXPECT_EQ(error(points + R"("string type" "b")"),
            later + R"("type" of Shape "curve" must be flat, cylinder or ribbon, not "b")");
  EXPECT_EQ(error(points + R"("float width" -1)"), later + R"("width" of Shape "curve" must not be negative)");
  EXPECT_EQ(error(points + R"("string type" "ribbon" "normal N" [0 0 1])"),
            R"(t.pbrt:2:75: parameter "N" of Shape "curve" needs 2 normals, one for each end of a segment; has 1)");
  EXPECT_EQ(error(points + R"("string type" "ribbon" "normal N" [0 0 1 0 0 0])"),
            R"(t.pbrt:2:75: parameter "N" of Shape "curve" has a normal of length 0)");
}

}  // namespace
}  // namespace lanthorn::curve_test
