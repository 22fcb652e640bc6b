// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Animations, morph targets and skins of glTF files; points and lines.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "support/gltf_triangle.h"
#include "support/read_gltf.h"

namespace lanthorn::gltf_pose_test {
namespace {

using namespace description;
using nlohmann::json;
using test::corners;
using test::gltf_error;
using test::GltfWriter;
using test::mesh_of;
using test::read_gltf;
using test::warnings;

bool warns(const SceneDescription& scene, const std::string& part) {
  for (const std::string& warning : warnings(scene))
    if (warning.find(part) != std::string::npos) return true;
  return false;
}

void expect_near(const Vec3& a, const Vec3& b, float limit = 1e-5f) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], limit) << k;
}

// A file with a mesh on a node that one channel animates.
GltfWriter animated(const char* path, const char* interpolation, const std::vector<float>& times,
                    const std::vector<float>& values, std::size_t components) {
  GltfWriter file;
  file.mesh(corners, {0, 1, 2});
  file.node({{"mesh", 0}, {"translation", {0, 0, 5}}});
  const json sampler = {{"input", file.accessor(times, 1)},
                        {"output", file.accessor(values, components)},
                        {"interpolation", interpolation}};
  file.add("animations",
           {{"samplers", {sampler}}, {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}});
  return file;
}
Point moved(const GltfWriter& file, std::optional<double> seconds, const Point& p = {0, 0, 0}) {
  return read_gltf(file, seconds).shapes.at(0).object_to_world.start.point(p);
}

TEST(GltfAnimation, RestIsTheDefaultAndTimesBeyondTheKeysHold) {
  const GltfWriter file = animated("translation", "LINEAR", {1, 3}, {0, 0, 0, 4, 2, 0}, 3);
  EXPECT_EQ(moved(file, {}), Point(0, 0, 5));
  EXPECT_TRUE(warns(read_gltf(file), "animations are not played"));
  EXPECT_FALSE(warns(read_gltf(file, 1), "animation"));
  EXPECT_EQ(moved(file, 0), Point(0, 0, 0));
  EXPECT_EQ(moved(file, 1.5), Point(1, 0.5f, 0));
  EXPECT_EQ(moved(file, 99), Point(4, 2, 0));
  EXPECT_EQ(gltf_error(GltfWriter(), 1).substr(0, 8), "t.gltf: ");
}

TEST(GltfAnimation, StepHoldsAndSplinesFollowTheirTangents) {
  const GltfWriter step = animated("translation", "STEP", {0, 1}, {1, 0, 0, 2, 0, 0}, 3);
  EXPECT_EQ(moved(step, 0.999), Point(1, 0, 0));
  EXPECT_EQ(moved(step, 1), Point(2, 0, 0));
  // From 0 to 8 in 2 seconds, with slopes of 3 at the start and -1 per second at the end: Hermite's polynomial.
  const GltfWriter spline =
      animated("translation", "CUBICSPLINE", {1, 3}, {9, 9, 9, 0, 0, 0, 3, 0, 0, -1, 0, 0, 8, 0, 0, 9, 9, 9}, 3);
  const double t = 0.25, h00 = 2 * t * t * t - 3 * t * t + 1, h10 = t * t * t - 2 * t * t + t, h11 = t * t * t - t * t;
  const double expected = (1 - h00) * 8 + 2 * h10 * 3 + 2 * h11 * -1;
  expect_near(moved(spline, 1.5), Point(static_cast<float>(expected), 0, 0));
  expect_near(moved(spline, 3), Point(8, 0, 0));
}

TEST(GltfAnimation, RotationsTakeTheShortArc) {
  const auto h = static_cast<float>(std::sqrt(0.5));
  // The rotation takes the shorter way: the second key has the opposite sign.
  const GltfWriter file = animated("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, -h, -h}, 4);
  const float sixteenth = pi / 8;
  expect_near(moved(file, 0.25, {1, 0, 0}), Point(std::cos(sixteenth), std::sin(sixteenth), 5));
  const GltfWriter scaled = animated("scale", "LINEAR", {0, 1}, {1, 1, 1, 3, 1, 1}, 3);
  expect_near(moved(scaled, 0.5, {1, 1, 0}), Point(2, 1, 5));
}

TEST(GltfAnimation, ErrorsNameThePlace) {
  EXPECT_EQ(gltf_error(animated("translation", "LINEAR", {0, 1, 2}, {0, 0, 0, 1, 1, 1}, 3), 0),
            "t.gltf#/animations/0/samplers/0/output: has 2 elements, but 3 keys need 1 each");
  EXPECT_EQ(gltf_error(animated("translation", "SMOOTH", {0}, {0, 0, 0}, 3), 0),
            R"(t.gltf#/animations/0/samplers/0/interpolation: must be STEP, LINEAR or CUBICSPLINE, not "SMOOTH")");
  EXPECT_EQ(gltf_error(animated("weights", "LINEAR", {0}, {0}, 1), 0),
            "t.gltf#/animations/0/channels/0/target: animates weights, but the node's mesh has no morph targets");
  for (const auto& [times, values, place] :
       std::vector<std::tuple<std::vector<float>, std::vector<float>, const char*>>{{{NAN}, {0, 0, 0}, "input"},
                                                                                    {{0}, {0, INFINITY, 0}, "output"}})
    EXPECT_EQ(gltf_error(animated("translation", "LINEAR", times, values, 3), 0),
              std::string("t.gltf#/animations/0/samplers/0/") + place +
                  ": element 0 of the accessor has a number that is not finite");
  GltfWriter file = animated("translation", "LINEAR", {0}, {0, 0, 0}, 3);
  file.root["animations"][0]["channels"][0]["sampler"] = 7;
  EXPECT_EQ(gltf_error(file, 0), "t.gltf#/animations/0/channels/0/sampler: is 7, but there are 1 samplers");
  file = animated("translation", "LINEAR", {0}, {0, 0, 0}, 3);
  file.root["animations"][0]["channels"][0]["target"]["node"] = 7;
  EXPECT_EQ(gltf_error(file, 0), "t.gltf#/animations/0/channels/0/target/node: is 7, but there are 1 nodes");
  EXPECT_TRUE(warns(read_gltf(animated("pointer", "LINEAR", {0}, {0}, 1), 0), R"(animations of "pointer")"));
}

// Two targets: one raises all corners, the other moves the second corner to the right.
GltfWriter morphing() {
  GltfWriter file;
  file.mesh(corners, {0, 1, 2});
  json& primitive = file.root["meshes"][0]["primitives"][0];
  primitive["attributes"]["NORMAL"] = file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
  primitive["targets"] = {{{"POSITION", file.accessor<float>({0, 0, 2, 0, 0, 2, 0, 0, 2}, 3)},
                           {"NORMAL", file.accessor<float>({1, 0, 0, 0, 0, 0, 0, 0, 0}, 3)}},
                          {{"POSITION", file.accessor<float>({0, 0, 0, 4, 0, 0, 0, 0, 0}, 3)}}};
  file.node({{"mesh", 0}});
  return file;
}

TEST(GltfMorph, WeightsOfMeshNodeAndAnimation) {
  GltfWriter file = morphing();
  EXPECT_EQ(mesh_of(read_gltf(file).shapes.at(0)).positions, corners);
  file.root["meshes"][0]["weights"] = {0.5, 0};
  EXPECT_EQ(mesh_of(read_gltf(file).shapes.at(0)).positions, (std::vector<Point>{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}));
  EXPECT_EQ(mesh_of(read_gltf(file).shapes.at(0)).normals[0], Normal(0.5f, 0, 1));
  file.root["nodes"][0]["weights"] = {0, 0.25};
  EXPECT_EQ(mesh_of(read_gltf(file).shapes.at(0)).positions, (std::vector<Point>{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}}));
  const json sampler = {{"input", file.accessor<float>({0, 1}, 1)}, {"output", file.accessor<float>({0, 0, 1, 1}, 1)}};
  file.add("animations",
           {{"samplers", {sampler}}, {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
  EXPECT_EQ(mesh_of(read_gltf(file, 0.5).shapes.at(0)).positions,
            (std::vector<Point>{{0, 0, 1}, {3, 0, 1}, {0, 1, 1}}));
}

TEST(GltfMorph, TwoNodesOfAMeshMayDiffer) {
  GltfWriter file = morphing();
  file.root["nodes"][0]["weights"] = {1, 0};
  file.node({{"mesh", 0}, {"translation", {9, 0, 0}}});
  const SceneDescription scene = read_gltf(file);
  ASSERT_EQ(scene.shapes.size(), 2u);
  std::set<float> heights;
  for (std::size_t i = 0; i < 2; ++i) heights.insert(mesh_of(scene.shapes.at(i)).positions[0].z);
  EXPECT_EQ(heights, (std::set<float>{0, 2}));
}

TEST(GltfMorph, TargetsAreAsLongAsTheMesh) {
  GltfWriter file = morphing();
  file.root["meshes"][0]["weights"] = {1, 1};
  file.root["meshes"][0]["primitives"][0]["targets"][1]["POSITION"] = file.accessor<float>({0, 0, 0}, 3);
  EXPECT_EQ(gltf_error(file),
            "t.gltf#/meshes/0/primitives/0/targets/1/POSITION: has 1 elements, but there are 3 positions");
}

// A triangle with two joints: the first corner is bound to the first joint, the second to the second, and the third
// half to each. The second joint is bound at (0, 1, 0) and is at (3, 1, 0), rotated by 90 degrees about z.
GltfWriter skinned() {
  GltfWriter file;
  file.mesh(corners, {0, 1, 2});
  json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["NORMAL"] = file.accessor<float>({1, 0, 0, 1, 0, 0, 1, 0, 0}, 3);
  attributes["JOINTS_0"] = file.accessor<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 9, 9}, 4);
  attributes["WEIGHTS_0"] = file.accessor<float>({1, 0, 0, 0, 2, 0, 0, 0, 0.5f, 0.5f, 0, 0}, 4);
  const double h = std::sqrt(0.5);
  const std::size_t first = file.node({{"name", "still"}});
  const std::size_t second = file.node({{"translation", {3, 1, 0}}, {"rotation", {0, 0, h, h}}});
  const std::size_t matrices = file.add(
      "accessors", {{"componentType", 5126},
                    {"count", 2},
                    {"type", "MAT4"},
                    {"bufferView", file.view(test::bytes_of<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1, 1,
                                                                    0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1}))}});
  file.add("skins", {{"joints", {first, second}}, {"inverseBindMatrices", matrices}});
  file.node({{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}});  // a skinned node's own place has no effect
  return file;
}

TEST(GltfSkin, VerticesFollowTheirJoints) {
  const SceneDescription scene = read_gltf(skinned());
  const TriangleMesh& mesh = mesh_of(scene.shapes.at(0));
  EXPECT_TRUE(scene.shapes[0].object_to_world.start.is_identity());
  expect_near(mesh.positions[0], {0, 0, 0});
  expect_near(mesh.positions[1], {4, 2, 0});     // (1, -1, 0) from the joint, rotated: (1, 1, 0)
  expect_near(mesh.positions[2], {1.5f, 1, 0});  // between (0, 1, 0) and (3, 1, 0)
  expect_near(normalize(mesh.normals[1]), {0, 1, 0});
  expect_near(normalize(mesh.normals[2]), {std::sqrt(0.5f), std::sqrt(0.5f), 0});
}

TEST(GltfSkin, ErrorsNameThePlace) {
  GltfWriter file = skinned();
  file.root["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] =
      file.accessor<std::uint8_t>({0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 9, 9}, 4);
  EXPECT_EQ(gltf_error(file),
            "t.gltf#/meshes/0/primitives/0/attributes/JOINTS_0: vertex 1 is bound to joint 2, but the skin has 2");
  file = skinned();
  file.root["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0");
  EXPECT_EQ(gltf_error(file), R"(t.gltf#/meshes/0/primitives/0/attributes: needs the member "WEIGHTS_0")");
  file = skinned();
  file.root["skins"][0]["joints"] = {0, 1, 0};
  EXPECT_EQ(gltf_error(file), "t.gltf#/skins/0/inverseBindMatrices: has 2 matrices, but the skin has 3 joints");
  file = skinned();
  const std::size_t lost = file.add("nodes", json::object());
  file.root["skins"][0]["joints"] = {0, lost};
  EXPECT_TRUE(warns(read_gltf(file), "t.gltf#/skins/0/joints/1: the joint is not in the scene"));
}

TEST(GltfStrokes, PointsAndLinesAreThinSurfaces) {
  const auto drawn = [](int mode) {
    GltfWriter file;
    file.mesh({{0, 0, 0}, {300, 0, 0}, {300, 400, 0}, {0, 400, 0}}, {0, 1, 2, 3});
    file.root["meshes"][0]["primitives"][0]["mode"] = mode;
    file.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        file.accessor<std::uint8_t>({255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}, 3, true);
    file.node({{"mesh", 0}, {"scale", {2, 2, 2}}});
    return read_gltf(file);
  };
  const std::vector<std::pair<int, std::size_t>> triangles{{0, 4 * 8}, {1, 2 * 12}, {2, 4 * 12}, {3, 3 * 12}};
  for (const auto& [mode, count] : triangles) {
    const SceneDescription scene = drawn(mode);
    const TriangleMesh& mesh = mesh_of(scene.shapes.at(0));
    EXPECT_EQ(mesh.triangles.size(), count) << mode;
    EXPECT_TRUE(warns(scene, "points and lines have no size"));
    Bounds bounds;
    for (const Point& p : mesh.positions) bounds.extend(scene.shapes[0].object_to_world.start.point(p));
    // The radius is a thousandth of the diagonal, which is 1000.
    EXPECT_NEAR(bounds.max.z, 1, mode == 0 ? 1e-4f : 0.14f) << mode;
    EXPECT_NEAR(bounds.max.y, 801, 1.1f);
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    EXPECT_EQ(mesh.colors[0], glm::vec4(1, 0, 0, 1));
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 n = cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
      EXPECT_GT(dot(n, mesh.normals[a]), 0) << mode;
    }
  }
}

}  // namespace
}  // namespace lanthorn::gltf_pose_test
