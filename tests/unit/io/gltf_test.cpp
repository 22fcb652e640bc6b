// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Containers, accessors, meshes, nodes, lights and cameras.
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "camera/view.h"
#include "lanthorn/scene.h"
#include "scene/scene.h"
#include "support/gltf_triangle.h"
#include "support/read_gltf.h"
#include "support/temporary_dir.h"

namespace lanthorn::gltf_test {
namespace {

using namespace description;
using nlohmann::json;
using test::corners;
using test::GltfWriter;
using test::mesh_of;
using test::one_mesh;
using test::read_gltf;
using test::warnings;

template <class T>
std::vector<Point> positions_of(const std::vector<T>& values, bool normalized, std::size_t padding) {
  const GltfWriter file = one_mesh([&](GltfWriter& writer, json& primitive) {
    primitive["attributes"]["POSITION"] = writer.padded_accessor(values, 3, normalized, padding);
  });
  return mesh_of(read_gltf(file).shapes.at(0)).positions;
}

TEST(GltfAccessor, ComponentTypesAndNormalisation) {
  EXPECT_EQ(positions_of<float>({1, 2.5f, -3, 4, 5, 6, 7, 8, 9}, false, 0),
            (std::vector<Point>{{1, 2.5f, -3}, {4, 5, 6}, {7, 8, 9}}));
  EXPECT_EQ(positions_of<float>({1, 2.5f, -3, 4, 5, 6, 7, 8, 9}, false, 8),
            (std::vector<Point>{{1, 2.5f, -3}, {4, 5, 6}, {7, 8, 9}}));
  EXPECT_EQ(positions_of<std::int8_t>({1, -2, 3, 4, 5, 6, 127, -128, 0}, false, 1),
            (std::vector<Point>{{1, -2, 3}, {4, 5, 6}, {127, -128, 0}}));
  EXPECT_EQ(positions_of<std::int8_t>({0, -127, 127, -128, 0, 0, 0, 0, 0}, true, 1),
            (std::vector<Point>{{0, -1, 1}, {-1, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(positions_of<std::uint8_t>({0, 255, 51, 1, 2, 3, 4, 5, 6}, false, 1),
            (std::vector<Point>{{0, 255, 51}, {1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(positions_of<std::uint8_t>({0, 255, 51, 0, 0, 0, 0, 0, 0}, true, 1),
            (std::vector<Point>{{0, 1, 0.2f}, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(positions_of<std::int16_t>({300, -300, 1, 0, 0, 0, 0, 0, 0}, false, 2),
            (std::vector<Point>{{300, -300, 1}, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(positions_of<std::int16_t>({32767, -32767, -32768, 0, 0, 0, 0, 0, 0}, true, 2),
            (std::vector<Point>{{1, -1, -1}, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(positions_of<std::uint16_t>({65535, 13107, 0, 0, 0, 0, 0, 0, 0}, true, 2),
            (std::vector<Point>{{1, 0.2f, 0}, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(positions_of<std::uint32_t>({70000, 1, 2, 0, 0, 0, 0, 0, 0}, false, 0),
            (std::vector<Point>{{70000, 1, 2}, {0, 0, 0}, {0, 0, 0}}));
}

TEST(GltfAccessor, IndicesOfEveryType) {
  const auto triangles = [](auto type) {
    using T = decltype(type);
    return mesh_of(read_gltf(one_mesh([](GltfWriter& file, json& primitive) {
                     primitive["indices"] = file.accessor(std::vector<T>{2, 1, 0, 0, 1, 2}, 1);
                   })).shapes.at(0))
        .triangles;
  };
  const std::vector<std::array<std::uint32_t, 3>> expected = {{2, 1, 0}, {0, 1, 2}};
  EXPECT_EQ(triangles(std::uint8_t{}), expected);
  EXPECT_EQ(triangles(std::uint16_t{}), expected);
  EXPECT_EQ(triangles(std::uint32_t{}), expected);
}

TEST(GltfAccessor, SparseReplacesElements) {
  const auto with_base = [](bool base) {
    const GltfWriter file = one_mesh([&](GltfWriter& writer, json& primitive) {
      json accessor = GltfWriter::description<float>(
          base ? std::optional(writer.view(test::bytes_of(GltfWriter::flat(corners)))) : std::nullopt, 3, 3, false);
      accessor["sparse"] = {
          {"count", 2},
          {"indices", {{"bufferView", writer.view(test::bytes_of<std::uint16_t>({0, 2}))}, {"componentType", 5123}}},
          {"values", {{"bufferView", writer.view(test::bytes_of<float>({7, 8, 9, 4, 5, 6}))}}}};
      primitive["attributes"]["POSITION"] = writer.add("accessors", accessor);
    });
    return mesh_of(read_gltf(file).shapes.at(0)).positions;
  };
  EXPECT_EQ(with_base(true), (std::vector<Point>{{7, 8, 9}, {1, 0, 0}, {4, 5, 6}}));
  EXPECT_EQ(with_base(false), (std::vector<Point>{{7, 8, 9}, {0, 0, 0}, {4, 5, 6}}));
}

// Exporters write NaN as the normals of faces without area, and broken modifiers as positions.
TEST(GltfMesh, NumbersThatAreNotFiniteAreLeftOutWithAWarning) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  GltfWriter file;
  file.mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {7, 7, 7}}, {0, 1, 2, 1, 3, 2});
  file.node({{"mesh", 0}});
  json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["POSITION"] = file.accessor<float>({5, 0, 0, 6, 0, 0, 5, 1, 0, 9, infinity, 0}, 3);
  attributes["NORMAL"] = file.accessor<float>({0, 0, 1, 0, nan, 1, 0, 0, 1, 0, 0, 1}, 3);
  attributes["TEXCOORD_0"] = file.accessor<float>({1, 0, -infinity, 0, 0, 0, 0, 0}, 2);
  attributes["COLOR_0"] = file.accessor<float>({nan, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, 3);
  const SceneDescription scene = read_gltf(file);
  const TriangleMesh& mesh = mesh_of(scene.shapes.at(0));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
  EXPECT_EQ(mesh.positions.at(3), Point(5, 0, 0)) << "within the bounds of the others";
  EXPECT_EQ(mesh.normals.at(1), Normal(0));
  EXPECT_EQ(mesh.uvs.at(1).x, 0);
  EXPECT_EQ(mesh.colors.at(0), glm::vec4(1));
  const std::vector<std::string> all = warnings(scene);
  EXPECT_EQ(std::count_if(all.begin(), all.end(),
                          [](const std::string& w) { return w.find("not finite") != std::string::npos; }),
            2);
  const std::string text = fmt::format("{}", fmt::join(all, "|"));
  EXPECT_NE(text.find("1 faces, lines or points with a corner that is not finite: left out"), std::string::npos)
      << text;
  EXPECT_NE(text.find("3 normals, tangents, texture coordinates or colours"), std::string::npos) << text;
}

TEST(GltfMesh, AttributesAndModes) {
  const GltfWriter file = one_mesh([](GltfWriter& writer, json& primitive) {
    primitive["attributes"]["NORMAL"] = writer.accessor<float>({0, 0, 1, 0, 1, 0, 1, 0, 0}, 3);
    primitive["attributes"]["TANGENT"] = writer.accessor<float>({1, 0, 0, 1, 0, 0, 1, 1, 0, 1, 0, -1}, 4);
    primitive["attributes"]["TEXCOORD_0"] = writer.accessor<std::uint8_t>({0, 255, 255, 0, 51, 102}, 2, true);
  });
  const SceneDescription scene = read_gltf(file);
  const TriangleMesh& mesh = mesh_of(scene.shapes.at(0));
  EXPECT_EQ(mesh.normals, (std::vector<Normal>{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}));
  EXPECT_EQ(mesh.tangents, (std::vector<Vec3>{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}));
  EXPECT_EQ(mesh.uvs, (std::vector<Vec2>{{0, 0}, {1, 1}, {0.2f, 0.6f}}));  // flipped: t runs upwards

  using Triangles = std::vector<std::array<std::uint32_t, 3>>;
  const auto triangles = [](int mode, bool indexed) {
    GltfWriter writer;
    writer.mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}}, {4, 3, 2, 1, 0});
    json& primitive = writer.root["meshes"][0]["primitives"][0];
    primitive["mode"] = mode;
    if (!indexed) primitive.erase("indices");
    writer.node({{"mesh", 0}});
    const SceneDescription result = read_gltf(writer);
    return result.shapes.empty() ? Triangles() : mesh_of(result.shapes[0]).triangles;
  };
  EXPECT_EQ(triangles(4, false), (Triangles{{0, 1, 2}}));
  EXPECT_EQ(triangles(5, false), (Triangles{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  EXPECT_EQ(triangles(5, true), (Triangles{{4, 3, 2}, {3, 1, 2}, {2, 1, 0}}));
  EXPECT_EQ(triangles(6, false), (Triangles{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
}

TEST(GltfMesh, OnlyUsedVerticesAreKept) {
  GltfWriter file;
  std::vector<Point> many(100);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = {static_cast<float>(i), static_cast<float>(i * i), 0};
  file.mesh(many, {90, 5, 40});
  file.node({{"mesh", 0}});
  const TriangleMesh mesh = mesh_of(read_gltf(file).shapes.at(0));
  EXPECT_EQ(mesh.positions, (std::vector<Point>{many[5], many[40], many[90]}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{2, 0, 1}}));
}

TEST(GltfContainer, TextBinaryAndFilesBesideAreTheSame) {
  const test::TemporaryDir dir;
  const GltfWriter file = one_mesh();
  dir.write("a b.bin", file.buffer());
  const auto path = [&](const std::string& name, const std::string& bytes) { return dir.write(name, bytes); };
  for (const auto& scene :
       {read_scene(path("data.gltf", file.text())), read_scene(path("binary.glb", file.binary())),
        read_scene(path("binary.gltf", file.binary())), read_scene(path("beside.gltf", file.text("a%20b.bin")))}) {
    ASSERT_EQ(scene.shapes.size(), 1u);
    EXPECT_EQ(mesh_of(scene.shapes[0]).positions, corners);
    EXPECT_NE(scene.hash, 0u);
  }
  EXPECT_EQ(read_scene(dir.path() / "beside.gltf").files.count("a%20b.bin"), 1u);
}

// Downloaded models may have file names that contain the escapes of their URIs.
TEST(GltfContainer, NamesOfFilesMayBeEscapedThemselves) {
  const test::TemporaryDir dir;
  const GltfWriter file = one_mesh();
  dir.write("a%20b.bin", file.buffer());
  const auto scene = dir.write("a.gltf", file.text("a%20b.bin"));
  EXPECT_EQ(mesh_of(read_scene(scene).shapes.at(0)).positions, corners);
  dir.write("a b.bin", "too short");  // the name by the specification has priority
  EXPECT_THROW(read_scene(scene), Error);
}

TEST(GltfNodes, TransformsAndInstances) {
  GltfWriter file;
  file.mesh(corners, {0, 1, 2});
  file.mesh(corners, {0, 1, 2});
  const std::size_t child = file.add("nodes", {{"mesh", 0}, {"scale", {2, 2, 2}}});
  const double h = std::sqrt(0.5);
  file.node({{"translation", {1, 2, 3}}, {"rotation", {0, 0, h, h}}, {"children", {child}}});
  file.node({{"mesh", 1}});
  file.node({{"mesh", 1}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}});
  const SceneDescription scene = read_gltf(file);
  ASSERT_EQ(scene.shapes.size(), 1u);
  // Scaled, rotated by 90 degrees about z, then translated.
  const Point moved = scene.shapes[0].object_to_world.start.point({1, 0, 0});
  EXPECT_NEAR(moved.x, 1, 1e-6f);
  EXPECT_NEAR(moved.y, 4, 1e-6f);
  EXPECT_NEAR(moved.z, 3, 1e-6f);
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].shapes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].object_to_world.start.point({1, 2, 3}), Point(1, 2, 3));
  EXPECT_EQ(scene.instances[1].object_to_world.start.point({1, 0, 0}), Point(5, 7, 7));
}

TEST(GltfNodes, GpuInstancing) {
  GltfWriter file;
  file.mesh(corners, {0, 1, 2});
  const json attributes = {{"TRANSLATION", file.accessor<float>({0, 0, 0, 5, 0, 0, 0, 6, 0}, 3)},
                           {"SCALE", file.accessor<float>({1, 1, 1, 2, 2, 2, 1, 0, 1}, 3)}};
  file.node({{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
  const SceneDescription scene = read_gltf(file);
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_EQ(scene.instances[1].object_to_world.start.point({1, 0, 0}), Point(7, 0, 0));
  const Scene built(scene);
  ASSERT_FALSE(built.warnings().empty());
  EXPECT_EQ(built.warnings().back().message.substr(0, 34), "a shape or instance is left out: t");
  EXPECT_NE(built.warnings().back().location.file.find("#/meshes/0"), std::string::npos);
}

TEST(GltfNodes, EmissiveMeshesAreLampsInEveryNode) {
  GltfWriter file;
  const json strength = {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}};
  file.mesh(corners, {0, 1, 2}, file.add("materials", {{"emissiveFactor", {1, 0.5, 0}}, {"extensions", strength}}));
  file.mesh(corners, {0, 1, 2});
  file.node({{"mesh", 0}});
  file.node({{"mesh", 0}, {"translation", {1, 0, 0}}});
  file.node({{"mesh", 1}});
  const SceneDescription scene = read_gltf(file);
  EXPECT_TRUE(scene.lights.empty());  // no stand-in: the file has a light of its own
  EXPECT_EQ(Scene(scene).lights().size(), 2u);
}

// Candela, lux and nits are on one scale: a lamp of 3 cd at 1 m illuminates as much as one nit over 3 sr.
TEST(GltfLights, UnitsAndDirections) {
  GltfWriter file = one_mesh();
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 3}, {"color", {1, 0.5, 0}}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}},
      {{"type", "directional"}, {"intensity", 2}}};
  for (const int i : {0, 1, 2})
    file.node({{"translation", {1, 2, 3}}, {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  const SceneDescription scene = read_gltf(file);
  ASSERT_EQ(scene.lights.size(), 3u);
  const auto& point = std::get<description::PointLight>(scene.lights[0].node);
  EXPECT_EQ(point.intensity.scale, 3);
  EXPECT_EQ(std::get<RgbSpectrum>(point.intensity.spectrum).rgb, (Rgb{1, 0.5f, 0}));
  EXPECT_EQ(scene.lights[0].light_to_world.point(point.from), Point(1, 2, 3));
  const auto& spot = std::get<description::SpotLight>(scene.lights[1].node);
  EXPECT_EQ(scene.lights[1].light_to_world.vector(spot.to - spot.from), Vec3(0, 0, -1));
  EXPECT_NEAR(spot.cone_angle, 28.6479f, 1e-3f);
  EXPECT_NEAR(spot.cone_delta_angle, 14.3239f, 1e-3f);
  EXPECT_EQ(spot.falloff, SpotFalloff::square);
  EXPECT_EQ(std::get<description::DistantLight>(scene.lights[2].node).radiance.scale, 2);
  EXPECT_TRUE(scene.view.film.measures_exposure);
}

TEST(GltfCamera, PerspectiveAndOrthographic) {
  const auto camera_scene = [](const json& camera) {
    GltfWriter file = one_mesh();
    file.add("cameras", camera);
    file.node({{"camera", 0}, {"translation", {0, 0, 5}}, {"scale", {3, 3, 3}}});
    return read_gltf(file);
  };
  const SceneDescription wide =
      camera_scene({{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"aspectRatio", 2}}}});
  EXPECT_EQ(wide.view.film.width, 1280);
  EXPECT_EQ(wide.view.film.height, 640);
  EXPECT_NEAR(std::get<PerspectiveCamera>(wide.view.camera.node).fov, 57.2958f, 1e-3f);
  EXPECT_EQ(wide.view.camera.camera_to_world.start.point({0, 0, 0}), Point(0, 0, 5));
  EXPECT_EQ(wide.view.camera.camera_to_world.start.point({1, 2, 3}), Point(1, 2, 2));  // right, up, forward
  const SceneDescription tall =
      camera_scene({{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"aspectRatio", 0.5}}}});
  EXPECT_EQ(tall.view.film.width, 640);
  EXPECT_EQ(tall.view.film.height, 1280);
  EXPECT_NEAR(std::tan(std::get<PerspectiveCamera>(tall.view.camera.node).fov / 2 * pi / 180), std::tan(0.5f) / 2,
              1e-5f);
  const SceneDescription flat =
      camera_scene({{"type", "orthographic"}, {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"zfar", 9}, {"znear", 1}}}});
  EXPECT_EQ(flat.view.film.height, 640);
  const View view = make_view(flat.view);
  // The right edge of the film is 4 to the right, the upper edge 2 up.
  EXPECT_NEAR(view.camera.sample_ray({1280, 0}, {0.5f, 0.5f}, 0).ray.origin.x, 4, 1e-5f);
  EXPECT_NEAR(view.camera.sample_ray({1280, 0}, {0.5f, 0.5f}, 0).ray.origin.y, 2, 1e-5f);
}

// A camera that sees nothing would give a black picture, whatever the exporter intended.
TEST(GltfCamera, OneThatSeesNothingIsReplaced) {
  const auto is_replaced = [](const nlohmann::json& camera, const Vec3& at) {
    GltfWriter file = one_mesh();  // in the plane z = 0, from 0 to 1 in x and y
    file.add("cameras", camera);
    file.node({{"camera", 0}, {"translation", {at.x, at.y, at.z}}});
    const SceneDescription scene = read_gltf(file);
    return scene.warnings.back().message.starts_with("the file has no camera that sees anything and no light");
  };
  const auto replaced = [&](float z, float znear) {
    return is_replaced({{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"aspectRatio", 2}, {"znear", znear}}}},
                       {0, 0, z});
  };
  EXPECT_FALSE(replaced(5, 4.9f));
  EXPECT_TRUE(replaced(5, 5.1f)) << "the mesh is nearer than viewers show it";
  EXPECT_TRUE(replaced(-1, 0.1f)) << "the mesh is behind the camera";
  // At a distance of 5, the camera sees 5.46 to the left and right, and 2.73 up and down.
  const nlohmann::json perspective = {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"aspectRatio", 2}}}};
  const nlohmann::json orthographic = {{"type", "orthographic"},
                                       {"orthographic", {{"xmag", 5.46}, {"ymag", 2.73}, {"zfar", 9}, {"znear", 0}}}};
  for (const nlohmann::json& camera : {perspective, orthographic})
    for (const auto& [x, y, outside] :
         {std::tuple(6.3f, 0.0f, false), std::tuple(6.6f, 0.0f, true), std::tuple(-5.3f, 0.0f, false),
          std::tuple(-5.6f, 0.0f, true), std::tuple(0.0f, 3.6f, false), std::tuple(0.0f, 3.9f, true),
          std::tuple(0.0f, -2.6f, false), std::tuple(0.0f, -2.9f, true)})
      EXPECT_EQ(is_replaced(camera, {x, y, 5}), outside) << camera << ' ' << x << ' ' << y;
}

// Meshes have default materials, which are used if no variant is selected.
TEST(Gltf, FilesThatRequireVariantsAreRead) {
  const test::SphereMesh sphere = test::sphere_mesh(1, 8, 8);
  GltfWriter file;
  file.mesh(sphere.positions, sphere.indices);
  file.node({{"mesh", 0}});
  file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"KHR_materials_variants"};
  file.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "blue"}}};
  const SceneDescription scene = read_gltf(file);
  EXPECT_EQ(scene.shapes.size(), 1u);
  for (const Warning& warning : scene.warnings) EXPECT_EQ(warning.message.find("extension"), std::string::npos);
}

// A parser that visited all elements of an array again after each element took 55 seconds.
TEST(Gltf, LongArraysTakeTimeInProportionToTheirLength) {
  constexpr int nodes = 200000;
  std::string text = R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[)";
  for (int i = 1; i < nodes; ++i) text += R"({"children":[)" + std::to_string(i) + R"(],"translation":[0,0,1]},)";
  const std::clock_t start = std::clock();
  const SceneDescription scene = read_gltf(text + "{}]}");
#ifdef __SANITIZE_THREAD__
  constexpr int most_seconds = 50;  // the sanitizer makes it some ten times as slow
#else
  constexpr int most_seconds = 5;
#endif
  EXPECT_LT(std::clock() - start, most_seconds * CLOCKS_PER_SEC);
  EXPECT_TRUE(scene.shapes.empty());
}

}  // namespace
}  // namespace lanthorn::gltf_test
