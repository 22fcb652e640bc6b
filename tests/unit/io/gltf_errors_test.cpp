// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "support/gltf_triangle.h"
#include "support/read_gltf.h"

namespace lanthorn::gltf_errors_test {
namespace {

using namespace description;
using nlohmann::json;
using test::gltf_error;
using test::GltfWriter;
using test::one_mesh;

TEST(GltfErrors, SyntaxHasLineAndColumn) {
  EXPECT_EQ(gltf_error(R"({
  "asset": {"version": }
})")
                .substr(0, 12),
            "t.gltf:2:24:");
  EXPECT_EQ(gltf_error("").substr(0, 11), "t.gltf:1:1:");
  EXPECT_EQ(gltf_error("[]"), "t.gltf: the file's JSON must be an object");
  EXPECT_EQ(gltf_error(std::string(100000, '[')), "t.gltf:1:201: the JSON is nested more than 200 levels deep");
  EXPECT_EQ(gltf_error(R"(["[[\"[[", )" + std::string(300, '[')).substr(0, 13), "t.gltf:1:211:");
}

TEST(GltfErrors, Container) {
  const std::string file = one_mesh().binary();
  EXPECT_EQ(gltf_error(file.substr(0, 10)), "t.gltf: the file ends inside its header");
  EXPECT_EQ(gltf_error(file.substr(0, 40)),
            "t.gltf: the file has 40 bytes, but its header says " + std::to_string(file.size()));
  std::string other = file;
  other[4] = 1;
  EXPECT_EQ(gltf_error(other), "t.gltf: is version 1 of glTF's binary container: only version 2 is supported");
  other = file;
  other[15] = '\x7f';
  EXPECT_EQ(gltf_error(other), "t.gltf: the file ends inside a chunk");
  other = file;
  other[16] = 'X';
  EXPECT_EQ(gltf_error(other), "t.gltf: the file has no JSON chunk");
}

// Returns the error if the value at `pointer` is replaced.
std::string broken(const char* pointer, const json& value, GltfWriter file = one_mesh()) {
  json root = json::parse(file.text());
  root[json::json_pointer(pointer)] = value;
  return gltf_error(root.dump());
}

TEST(GltfErrors, NameThePlace) {
  EXPECT_EQ(broken("/asset/version", "1.0"), R"(t.gltf#/asset/version: only glTF 2 is supported, not "1.0")");
  EXPECT_EQ(broken("/asset", json::object()), R"(t.gltf#/asset: needs the member "version")");
  EXPECT_EQ(
      broken("/extensionsRequired", {"EXT_x"}),
      R"(t.gltf#/extensionsRequired/0: the file cannot be read without extension "EXT_x", which is not supported)");
  EXPECT_EQ(broken("/scene", 3), "t.gltf#/scene: is 3, but there are 1 scenes");
  EXPECT_EQ(broken("/scenes/0/nodes/0", -1), "t.gltf#/scenes/0/nodes/0: must be a non-negative whole number");
  EXPECT_EQ(broken("/nodes/0/mesh", 9), "t.gltf#/nodes/0/mesh: is 9, but there are 1 meshes");
  EXPECT_EQ(broken("/nodes/0/matrix", {1, 2}), "t.gltf#/nodes/0/matrix: needs 16 numbers, has 2");
  EXPECT_EQ(broken("/nodes/0/translation", "up"), "t.gltf#/nodes/0/translation: must be an array");
  EXPECT_EQ(broken("/nodes/0/scale", {1, 1, 1e300}), "t.gltf#/nodes/0/scale/2: is too large a number");
  EXPECT_EQ(broken("/nodes/0/children", {0}),
            "t.gltf#/nodes/0: the node is reached twice: it has two parents, or is its own ancestor");
  EXPECT_EQ(broken("/meshes/0/primitives/0/mode", 7), "t.gltf#/meshes/0/primitives/0/mode: there is no mode 7");
  EXPECT_EQ(broken("/meshes/0/primitives/0/material", 0),
            "t.gltf#/meshes/0/primitives/0/material: is 0, but there are 0 materials");
  EXPECT_EQ(broken("/meshes/0/primitives/0/indices", 0),
            "t.gltf#/meshes/0/primitives/0/indices: accessor 0 is a VEC3, but elements of 1 numbers are needed");
  EXPECT_EQ(broken("/accessors/0/componentType", 5124),
            "t.gltf#/accessors/0/componentType: there is no component type 5124");
  EXPECT_EQ(broken("/accessors/0/type", "VEC9"), R"(t.gltf#/accessors/0/type: there is no accessor type "VEC9")");
  EXPECT_EQ(broken("/accessors/1/componentType", 5126),
            "t.gltf#/meshes/0/primitives/0/indices: indices must be unsigned integers");
}

TEST(GltfErrors, NothingLiesOutsideOfItsBuffer) {
  EXPECT_EQ(broken("/accessors/0/count", 4),
            "t.gltf#/accessors/0: 4 elements do not fit into the buffer view: only 3 do");
  EXPECT_EQ(broken("/accessors/0/count", 9007199254740991),
            "t.gltf#/accessors/0: 9007199254740991 elements do not fit into the buffer view: only 3 do");
  EXPECT_EQ(broken("/accessors/0/byteOffset", 12),
            "t.gltf#/accessors/0: 3 elements do not fit into the buffer view: only 2 do");
  EXPECT_EQ(broken("/accessors/0/byteOffset", 1000000),
            "t.gltf#/accessors/0: 3 elements do not fit into the buffer view: only 0 do");
  EXPECT_EQ(broken("/bufferViews/0/byteStride", 4),
            "t.gltf#/accessors/0: an element has 12 bytes, but the byteStride is only 4");
  EXPECT_EQ(broken("/bufferViews/0/byteStride", 100000),
            "t.gltf#/bufferViews/0/byteStride: is too large: the maximum is 256");
  EXPECT_EQ(broken("/bufferViews/0/byteOffset", 20),
            "t.gltf#/bufferViews/0: bytes 20 to 56 lie outside the buffer, which has 48");
  EXPECT_EQ(broken("/bufferViews/0/byteOffset", 9223372036854775807),
            "t.gltf#/bufferViews/0: bytes 9223372036854775807 to 9223372036854775843 lie outside the buffer, which "
            "has 48");
  EXPECT_EQ(broken("/buffers/0/byteLength", 49), "t.gltf#/buffers/0: byteLength is 49, but there are only 48 bytes");
  EXPECT_EQ(broken("/buffers/0/uri", "none.bin"), "t.gltf#/buffers/0/uri: none.bin: no such file");
  EXPECT_EQ(broken("/buffers/0/uri", "https://example.org/a.bin"),
            "t.gltf#/buffers/0/uri: only data URIs and relative URIs that stay in the file's folder are supported, not "
            R"("https://example.org/a.bin")");
  EXPECT_EQ(broken("/buffers/0/uri", "data:;base64,@@"), "t.gltf#/buffers/0/uri: the data URI is not valid base64");
  EXPECT_EQ(broken("/buffers/0/uri", "data:text/plain,abc"), "t.gltf#/buffers/0/uri: a data URI must be in base64");
  EXPECT_EQ(broken("/accessors/0/count", 2),
            "t.gltf#/meshes/0/primitives/0/indices: index number 2 is 2, but there are 2 vertices");
  const auto zeros = one_mesh([](GltfWriter& file, json& primitive) {
    primitive["attributes"]["POSITION"] =
        file.add("accessors", GltfWriter::description<float>(std::nullopt, 4000000000u, 3, false));
    primitive.erase("indices");
  });
  EXPECT_EQ(gltf_error(zeros.text()),
            "t.gltf#/accessors/2: 4000000000 elements without a bufferView are too many: 1048576 are the most");
  const auto sparse = one_mesh([](GltfWriter& file, json& primitive) {
    json accessor = GltfWriter::description<float>(std::nullopt, 3, 3, false);
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", file.view({"\2\1", 2})}, {"componentType", 5121}}},
                          {"values", {{"bufferView", file.view(std::string(24, '\0'))}}}};
    primitive["attributes"]["POSITION"] = file.add("accessors", accessor);
  });
  EXPECT_EQ(gltf_error(sparse.text()),
            "t.gltf#/accessors/2/sparse/indices: the indices must increase and be below 3; number 1 is 1");
}

}  // namespace
}  // namespace lanthorn::gltf_errors_test
