// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Normal maps and displacements against closed-form normals.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "support/error_text.h"
#include "support/scene_text.h"
#include "support/temporary_dir.h"

namespace lanthorn::relief_test {
namespace {

using test::look;
using test::world;

void expect_near(const Vec3& got, const Vec3& expected, float tolerance = 2e-3f) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], expected[i], tolerance) << "axis " << i;
}

void expect_frame(const SurfacePoint& at) {
  EXPECT_NEAR(length_squared(at.shading.n), 1, 1e-4f);
  EXPECT_NEAR(length_squared(at.shading.s), 1, 1e-4f);
  EXPECT_NEAR(dot(at.shading.s, at.shading.n), 0, 1e-4f);
  expect_near(cross(at.shading.n, at.shading.s), at.shading.t, 1e-4f);
  EXPECT_GT(dot(at.shading.n, at.normal), 0);
}

// The unit square in z = 0, u along x and v along y.
const char* const square =
    R"(Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [0 0 0 1 0 0 1 1 0 0 1 0] "point2 uv" [0 0 1 0 1 1 0 1]
)";
const char* const square_patch = R"(Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0]
)";

std::string ramp(const std::string& slopes) {
  // Displacement h = a x + b y + c z in the space where it is defined.
  return R"(Texture "h" "float" "bilerp" "float v01" 0 "float v10" 1 "float v11" 1 "string mapping" )"
         R"("planar" "vector3 v1" [)" +
         slopes + R"(]
Material "diffuse" "texture displacement" "h"
)";
}

// The normal n of a surface raised by h: n - (grad h - n (n . grad h)).
Vec3 raised(const Vec3& n, const Vec3& gradient) { return normalize(n - (gradient - n * dot(n, gradient))); }

class NormalMaps : public ::testing::Test {
 protected:
  // One texel with the normal (x, y, z), stored as floats.
  std::string map(const Vec3& n, const std::string& name = "n.exr") {
    const std::array<float, 3> texel{0.5f + 0.5f * n.x, 0.5f + 0.5f * n.y, 0.5f + 0.5f * n.z};
    const std::string path = (folder.path() / name).string();
    const auto output = OIIO::ImageOutput::create(path);
    EXPECT_TRUE(output->open(path, OIIO::ImageSpec(1, 1, 3, OIIO::TypeDesc::FLOAT)));
    EXPECT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, texel.data()));
    EXPECT_TRUE(output->close());
    return R"(Material "diffuse" "string normalmap" ")" + path + "\"\n";
  }
  test::TemporaryDir folder;
  const Vec3 tilted = normalize(Vec3(0.3f, 0.2f, 0.9f));
};

TEST_F(NormalMaps, ConstantTiltIsThatOfShadingNormals) {
  const std::string with_normals =
      std::string(square).substr(0, std::string(square).size() - 1) + R"( "normal N" [)" +
      [&] {
        std::string n;
        for (int i = 0; i < 4; ++i)
          n += std::to_string(tilted.x) + " " + std::to_string(tilted.y) + " " + std::to_string(tilted.z) + " ";
        return n;
      }() +
      "]\n";
  const Scene plain = world(with_normals);
  for (const char* shape : {square, square_patch})
    for (const float z : {1.0f, -1.0f}) {
      const Scene mapped = world(map(tilted) + shape);
      const auto a = look(mapped, {0.3f, 0.6f, z}, {0, 0, -z}), b = look(plain, {0.3f, 0.6f, z}, {0, 0, -z});
      ASSERT_TRUE(a && b);
      expect_near(a->shading.n, b->shading.n, 1e-5f);
      expect_near(a->shading.n, tilted, 1e-5f);
      EXPECT_EQ(a->normal, b->normal);
      expect_frame(*a);
    }
}

TEST_F(NormalMaps, EightBitTexelsAreLinear) {
  const std::string path = (folder.path() / "n.png").string();
  const std::array<std::uint8_t, 3> texel{192, 128, 230};
  const auto output = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(output->open(path, OIIO::ImageSpec(1, 1, 3, OIIO::TypeDesc::UINT8)));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, texel.data()));
  ASSERT_TRUE(output->close());
  const Scene scene = world(R"(Material "conductor" "string normalmap" ")" + path + "\"\n" + square);
  const auto at = look(scene, {0.3f, 0.6f, 1}, {0, 0, -1});
  expect_near(at->shading.n, normalize(Vec3(2 * 192 / 255.0f - 1, 2 * 128 / 255.0f - 1, 2 * 230 / 255.0f - 1)), 1e-5f);
}

// Mirroring the surface mirrors the relief. Turning the surface inside out keeps the relief relative to u and v.
TEST_F(NormalMaps, FollowTransforms) {
  const auto normal = [&](const std::string& transform, const std::string& shape, const Point& target) {
    const Scene scene = world(map(tilted) + transform + shape);
    const auto at = look(scene, target + Vec3(0, 0, 1), {0, 0, -1});
    EXPECT_TRUE(at);
    expect_frame(*at);
    return at->shading.n;
  };
  for (const std::string shape : {square, square_patch}) {
    expect_near(normal("Scale -1 1 1\n", shape, {-0.3f, 0.6f, 0}), Vec3(-tilted.x, tilted.y, tilted.z), 1e-5f);
    expect_near(normal("Scale 1 -3 1\n", shape, {0.3f, -0.6f, 0}), Vec3(tilted.x, -tilted.y, tilted.z), 1e-5f);
    expect_near(normal("Rotate 90 0 0 1\n", shape, {-0.6f, 0.3f, 0}), Vec3(-tilted.y, tilted.x, tilted.z), 1e-5f);
    expect_near(normal("ReverseOrientation\n", shape, {0.3f, 0.6f, 0}), Vec3(tilted.x, tilted.y, -tilted.z), 1e-5f);
    const std::string object = R"(ObjectBegin "o"
)" + shape + R"(ObjectEnd
Scale -1 1 1
ObjectInstance "o"
)";
    expect_near(normal("", object, {-0.3f, 0.6f, 0}), Vec3(-tilted.x, tilted.y, tilted.z), 1e-5f);
  }
}

// x is along the mesh's own tangents if it has them.
TEST_F(NormalMaps, FollowTangents) {
  const std::string shape = std::string(square).substr(0, std::string(square).size() - 1);
  const Scene scene = world(map(tilted) + shape + R"( "vector3 S" [3 3 0 3 3 0 3 3 0 3 3 0]
)");
  const auto at = look(scene, {0.3f, 0.6f, 1}, {0, 0, -1});
  const float half = std::sqrt(0.5f);
  expect_near(at->shading.n, {half * (tilted.x - tilted.y), half * (tilted.x + tilted.y), tilted.z}, 1e-5f);
}

TEST_F(NormalMaps, StayAboveTheHorizon) {
  for (const Vec3& n : {Vec3(1, 0, 0), normalize(Vec3(0.8f, 0, -0.6f)), Vec3(0, 0, -1)}) {
    const Scene scene = world(map(n) + square);
    const auto at = look(scene, {0.3f, 0.6f, 1}, {0, 0, -1});
    expect_frame(*at);
    EXPECT_LT(at->shading.n.z, n.z < -0.99f ? 1.01f : 0.05f);
  }
}

TEST_F(NormalMaps, BelongToThePartOfAMixThatIsSeen) {
  const auto normal = [&](const char* amount) {
    std::string named = map(tilted);
    named.replace(0, std::string(R"(Material "diffuse")").size(), R"(MakeNamedMaterial "b" "string type" "diffuse")");
    const Scene scene = world(R"(MakeNamedMaterial "a" "string type" "diffuse"
)" + named + R"(Material "mix" "string materials" ["a" "b"] "float amount" )" +
                              amount + "\n" + square);
    return look(scene, {0.3f, 0.6f, 1}, {0, 0, -1})->shading.n;
  };
  expect_near(normal("0"), {0, 0, 1}, 1e-6f);
  expect_near(normal("1"), tilted, 1e-5f);
}

TEST_F(NormalMaps, NeedColours) {
  const std::string path = (folder.path() / "grey.exr").string();
  const float texel = 0.5f;
  const auto output = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(output->open(path, OIIO::ImageSpec(1, 1, 1, OIIO::TypeDesc::FLOAT)));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, &texel));
  ASSERT_TRUE(output->close());
  const std::string error =
      test::error_text([&] { world(R"(Material "diffuse" "string normalmap" ")" + path + "\"\n" + square); });
  EXPECT_NE(error.find("test scene:4:1: the normal map"), std::string::npos) << error;
  EXPECT_NE(error.find("must have three channels"), std::string::npos) << error;
}

// If a material has both, as in MTL files, the image decides: here bluish, grey and brown.
TEST_F(NormalMaps, GiveWayToDisplacementsUnlessTheyHaveColoursOfNormals) {
  const auto normal = [&](const Vec3& texel) {
    SceneDescription scene = read_pbrt_string(
        R"(Camera "perspective"
WorldBegin
LightSource "infinite"
)" + ramp("0.3 -0.2 0") +
            square,
        ".", "test");
    map(texel);
    description::NormalMap& normals = scene.materials.back().normal_map.emplace();
    normals.image.filename = (folder.path() / "n.exr").string();
    normals.image.encoding = description::Encoding::linear;
    return look(Scene(scene), {0.3f, 0.6f, 1}, {0, 0, -1})->shading.n;
  };
  const Vec3 raised = normalize(Vec3(-0.3f, 0.2f, 1));
  expect_near(normal(tilted * Vec3(0.9f)), tilted);
  for (const float grey : {-1.0f, 0.0f, 0.58f, 1.0f}) expect_near(normal(Vec3(grey)), raised);
  expect_near(normal({0.2f, -0.1f, -0.5f}), raised);
  expect_near(normal({-0.6f, -0.4f, 0.8f}), raised);
}

TEST(Displacement, OfALinearRampOnAPlane) {
  const Vec3 expected = normalize(Vec3(-0.3f, 0.2f, 1));
  for (const char* shape : {square, square_patch, R"(Translate 0.5 0.5 0 Shape "disk" "float radius" 2
)"})
    for (const float z : {1.0f, -1.0f}) {
      const Scene scene = world(ramp("0.3 -0.2 0") + shape);
      const auto at = look(scene, {0.3f, 0.6f, z}, {0, 0, -z});
      expect_near(at->shading.n, expected);
      expect_frame(*at);
    }
  // Relative to u and v, on a square of 2 x 4 m.
  const Scene by_uv = world(
      R"(Texture "h" "float" "bilerp" "float v00" 0 "float v10" 0.5 "float v01" 2 "float v11" 2.5
Material "diffuse" "texture displacement" "h"
Scale 2 4 1
)" + std::string(square));
  expect_near(look(by_uv, {1.3f, 1.7f, 1}, {0, 0, -1})->shading.n, normalize(Vec3(-0.25f, -0.5f, 1)));
  // Inside out, the surface is raised towards its other side.
  const Scene reversed = world(ramp("0.3 -0.2 0") + "ReverseOrientation\n" + square);
  expect_near(look(reversed, {0.3f, 0.6f, 1}, {0, 0, -1})->shading.n, normalize(Vec3(-0.3f, 0.2f, -1)));
}

TEST(Displacement, OfSolidRampsOnCurvedShapesWhereverTheyArePlaced) {
  const Vec3 gradient(0.2f, -0.1f, 0.3f);
  const std::vector<std::string> shapes = {
      R"(Shape "sphere"
)",
      R"(Shape "sphere" "float zmin" -0.5 "float zmax" 0.9 "float phimax" 300
)",
      R"(Shape "cylinder"
)",
      R"(Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0.5  -1 1 0.4  1 1 -0.3]
)",
      R"(Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0.5  -1 1 0.4  1 1 -0.3] "point2 uv" [0 0 3 1 1 2 5 4]
)",
      R"(Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [-2 -1 0.1  2 -1 0.5  0 2 -0.4] "point2 uv" [0 0 5 1 -1 3]
)",
      // A surface without a parametrisation.
      R"(Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [-2 -1 0.1  2 -1 0.5  0 2 -0.4] "point2 uv" [1 1 1 1 1 1]
)"};
  const std::vector<std::string> places = {"%", "Rotate 40 1 2 3 Scale 1 0.5 2\n%", "Scale -1 1 1 Rotate 20 0 1 0\n%",
                                           R"(ObjectBegin "o"
Rotate 15 1 0 0
%ObjectEnd
Rotate 50 3 1 2 Scale 1 -2 1
ObjectInstance "o"
)",
                                           "ActiveTransform EndTime Rotate 5 0 1 0\nActiveTransform All\n%"};
  HashRng rng(3);
  for (const std::string& shape : shapes)
    for (const std::string& place : places) {
      std::string placed = place;
      placed.replace(placed.find('%'), 1, shape);
      const Scene plain = world(placed), bumped = world(ramp("0.2 -0.1 0.3") + placed);
      int hits = 0;
      for (int i = 0; i < 60; ++i) {
        const Ray ray = test::random_ray(rng, Point(0), 1.0f, 0.5f);
        const auto a = plain.intersect(ray, test::white), b = bumped.intersect(ray, test::white);
        ASSERT_EQ(a.has_value(), b.has_value());
        if (!a) continue;
        ++hits;
        EXPECT_EQ(a->normal, b->normal);
        expect_near(b->shading.n, raised(a->shading.n, gradient), 4e-3f);
        expect_frame(*b);
      }
      EXPECT_GT(hits, 10) << placed;
    }
}

// Bilinear interpolation of an image of a parabola: the difference over one texel is the slope at its middle.
TEST(Displacement, OfAnImage) {
  const test::TemporaryDir folder;
  constexpr int size = 32;
  std::vector<float> texels(size * size);
  for (int i = 0; i < size * size; ++i) {
    const float s = (static_cast<float>(i % size) + 0.5f) / size;
    texels[static_cast<std::size_t>(i)] = 0.4f * s * s;
  }
  const std::string path = (folder.path() / "h.exr").string();
  const auto output = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(output->open(path, OIIO::ImageSpec(size, size, 1, OIIO::TypeDesc::FLOAT)));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, texels.data()));
  ASSERT_TRUE(output->close());
  const Scene scene = world(R"(Texture "h" "float" "imagemap" "string filename" ")" + path +
                            R"(" "float uscale" 400 "float vscale" 0.5
Material "diffuse" "texture displacement" "h"
Scale 400 2 1
)" + square);
  for (float s = 3.1f; s < 3.9f; s += 0.013f) {
    const auto at = look(scene, {s, 0.9f, 1}, {0, 0, -1});
    expect_near(at->shading.n, normalize(Vec3(-0.8f * (s - 3), 0, 1)), 0.01f);
  }
}

TEST(Displacement, OfAConstantChangesNothing) {
  const Scene plain = world(R"(Shape "sphere"
)");
  const Scene raised_evenly = world(R"(Material "diffuse" "float displacement" 0.3
Shape "sphere"
)");
  const auto a = look(plain, {0.3f, 0.2f, 4}, {0, 0, -1}), b = look(raised_evenly, {0.3f, 0.2f, 4}, {0, 0, -1});
  EXPECT_EQ(a->shading.n, b->shading.n);
  EXPECT_EQ(a->shading.s, b->shading.s);
}

// At the poles of a sphere, u has no direction.
TEST(Displacement, IsFiniteAtPoles) {
  for (const char* texture : {R"(Texture "h" "float" "fbm"
)",
                              R"(Texture "h" "float" "bilerp"
)",
                              R"(Texture "h" "float" "dots" "float uscale" 9 "float vscale" 9
)"}) {
    const Scene scene = world(std::string(texture) + R"(Material "diffuse" "texture displacement" "h"
)" + R"(Shape "sphere"
)");
    for (const float x : {0.0f, 1e-20f, 1e-7f, 1e-3f}) {
      const auto at = look(scene, {x, 0, 4}, {0, 0, -1});
      ASSERT_TRUE(at);
      expect_frame(*at);
    }
  }
}

}  // namespace
}  // namespace lanthorn::relief_test
