// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <draco/compression/expert_encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "lanthorn/file.h"
#include "support/gltf_triangle.h"
#include "support/read_gltf.h"

namespace lanthorn::gltf_compression_test {
namespace {

using namespace description;
using nlohmann::json;
using test::corners;
using test::gltf_error;
using test::GltfWriter;
using test::mesh_of;
using test::one_mesh;
using test::read_gltf;

TEST(GltfCompression, Draco) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(1);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const std::vector<Vec2> uvs = {{0, 0}, {1, 0}, {0, 1}};
  builder.SetAttributeValuesForFace(position, draco::FaceIndex(0), &corners[0], &corners[1], &corners[2]);
  builder.SetAttributeValuesForFace(uv, draco::FaceIndex(0), &uvs[0], &uvs[1], &uvs[2]);
  const auto mesh = builder.Finalize();
  draco::ExpertEncoder encoder(*mesh);
  draco::EncoderBuffer buffer;
  ASSERT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
  const std::string bytes(buffer.data(), buffer.size());
  const auto file_with = [&](const std::string& data) {
    return one_mesh([&](GltfWriter& file, json& primitive) {
      primitive["extensions"]["KHR_draco_mesh_compression"] = {
          {"bufferView", file.view(data)}, {"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}}};
    });
  };
  const TriangleMesh decoded = mesh_of(read_gltf(file_with(bytes)).shapes.at(0));
  ASSERT_EQ(decoded.triangles.size(), 1u);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t i = decoded.triangles[0][k];
    EXPECT_EQ(decoded.uvs.at(i).x, decoded.positions.at(i).x);
    EXPECT_EQ(decoded.uvs.at(i).y, 1 - decoded.positions.at(i).y);
  }
  EXPECT_NE(
      gltf_error(file_with(bytes.substr(0, bytes.size() / 2)).text())
          .find("t.gltf#/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: the compressed mesh cannot be "
                "decoded: "),
      std::string::npos);
  // Found by fuzzing.
  const std::string booleans = read_file(LANTHORN_SOURCE_DIR "/tests/fuzz/corpus/gltf/draco-booleans");
  EXPECT_NE(gltf_error(booleans).find("the attribute consists of booleans"), std::string::npos) << gltf_error(booleans);
}

// Directions of anisotropy in a compressed mesh: a quarter turn about the normal from the tangents of the file, towards
// w times the bitangent; without them, from u.
TEST(GltfCompression, DracoTurnsTangents) {
  for (const float w : {1.0f, -1.0f, 0.0f}) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(1);
    const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int normal = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
    const int other = w == 0 ? builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32)
                             : builder.AddAttribute(draco::GeometryAttribute::GENERIC, 4, draco::DT_FLOAT32);
    const Vec3 up(0, 0, 1);
    const glm::vec4 tangent(1, 0, 0, w);
    const std::vector<Vec2> uvs = {{0, 1}, {1, 1}, {0, 0}};  // u runs along x
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(0), &corners[0], &corners[1], &corners[2]);
    builder.SetAttributeValuesForFace(normal, draco::FaceIndex(0), &up, &up, &up);
    if (w == 0)
      builder.SetAttributeValuesForFace(other, draco::FaceIndex(0), &uvs[0], &uvs[1], &uvs[2]);
    else
      builder.SetAttributeValuesForFace(other, draco::FaceIndex(0), &tangent, &tangent, &tangent);
    const auto mesh = builder.Finalize();
    draco::ExpertEncoder encoder(*mesh);
    draco::EncoderBuffer buffer;
    ASSERT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
    const auto file = one_mesh([&](GltfWriter& f, json& primitive) {
      primitive["extensions"]["KHR_draco_mesh_compression"] = {
          {"bufferView", f.view({buffer.data(), buffer.size()})},
          {"attributes", {{"POSITION", position}, {"NORMAL", normal}, {w == 0 ? "TEXCOORD_0" : "TANGENT", other}}}};
      primitive["material"] = f.add(
          "materials",
          {{"extensions",
            {{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.9}, {"anisotropyRotation", std::acos(0.0)}}}}}});
    });
    const TriangleMesh decoded = mesh_of(read_gltf(file).shapes.at(0));
    ASSERT_EQ(decoded.tangents.size(), 3u);
    for (const Vec3& t : decoded.tangents) {
      EXPECT_NEAR(t.x, 0, 1e-5f);
      EXPECT_NEAR(t.y, w < 0 ? -1 : 1, 1e-5f);
      EXPECT_NEAR(t.z, 0, 1e-5f);
    }
  }
}

TEST(GltfCompression, Meshopt) {
  const test::SphereMesh sphere = test::sphere_mesh(1, 8, 8);
  std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(sphere.positions.size(), sizeof(Point)));
  vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), sphere.positions.data(),
                                             sphere.positions.size(), sizeof(Point)));
  std::vector<unsigned char> indices(meshopt_encodeIndexBufferBound(sphere.indices.size(), sphere.positions.size()));
  indices.resize(
      meshopt_encodeIndexBuffer(indices.data(), indices.size(), sphere.indices.data(), sphere.indices.size()));
  std::string extension = "EXT_meshopt_compression";
  const auto file_with = [&](const std::vector<unsigned char>& vertex_bytes, std::size_t count) {
    GltfWriter file;
    file.mesh(sphere.positions, sphere.indices);
    file.node({{"mesh", 0}});
    const auto compress = [&](std::size_t accessor, const std::vector<unsigned char>& data, const char* mode,
                              std::size_t stride, std::size_t elements) {
      const std::size_t source = file.view({reinterpret_cast<const char*>(data.data()), data.size()});
      const json from = file.root["bufferViews"][source];
      json& view = file.root["bufferViews"][file.root["accessors"][accessor]["bufferView"].get<std::size_t>()];
      view["extensions"][extension] = {{"buffer", 0},
                                       {"byteOffset", from["byteOffset"]},
                                       {"byteLength", from["byteLength"]},
                                       {"byteStride", stride},
                                       {"count", elements},
                                       {"mode", mode}};
    };
    compress(0, vertex_bytes, "ATTRIBUTES", sizeof(Point), count);
    compress(1, indices, "TRIANGLES", 4, sphere.indices.size());
    return file;
  };
  const SceneDescription decoded_scene = read_gltf(file_with(vertices, sphere.positions.size()));
  const TriangleMesh& decoded = mesh_of(decoded_scene.shapes.at(0));
  EXPECT_EQ(decoded.positions, sphere.positions);
  ASSERT_EQ(decoded.triangles.size() * 3, sphere.indices.size());
  // The codec may rotate the corners of triangles, since it does not store which is the first.
  for (std::size_t i = 0; i < decoded.triangles.size(); ++i) {
    const auto& t = decoded.triangles[i];
    const std::array<std::uint32_t, 3> s = {sphere.indices[3 * i], sphere.indices[3 * i + 1],
                                            sphere.indices[3 * i + 2]};
    EXPECT_TRUE(t == s || (t[0] == s[1] && t[1] == s[2] && t[2] == s[0]) ||
                (t[0] == s[2] && t[1] == s[0] && t[2] == s[1]));
  }
  const std::string at = "t.gltf#/bufferViews/0/extensions/EXT_meshopt_compression: ";
  std::vector<unsigned char> damaged = vertices;
  damaged.resize(damaged.size() / 2);
  EXPECT_EQ(gltf_error(file_with(damaged, sphere.positions.size()).text()), at + "the compressed data is damaged");
  EXPECT_EQ(gltf_error(file_with(vertices, 4000000000u).text()),
            at + "the compressed data is too short for 4000000000 elements of 12 bytes");
  extension = "KHR_meshopt_compression";
  GltfWriter of_khronos = file_with(vertices, sphere.positions.size());
  of_khronos.root["extensionsRequired"] = {extension};
  EXPECT_EQ(mesh_of(read_gltf(of_khronos).shapes.at(0)).positions, sphere.positions);
  vertices[0] |= 1;
  EXPECT_NE(gltf_error(file_with(vertices, sphere.positions.size()).text()).find("version 1 of the format"),
            std::string::npos);
}

}  // namespace
}  // namespace lanthorn::gltf_compression_test
