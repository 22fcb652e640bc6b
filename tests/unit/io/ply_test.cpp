// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/ply.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "io/gzip.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "support/error_text.h"
#include "support/gzip.h"
#include "support/temporary_dir.h"

namespace lanthorn::ply_test {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Quad = std::array<std::uint32_t, 4>;

// Writes numbers in one of the three encodings.
class PlyWriter {
 public:
  explicit PlyWriter(std::string format) : format_(std::move(format)) {
    text_ = "ply\nformat " + format_ + " 1.0\ncomment made by a test\n";
  }
  PlyWriter& header(const std::string& line) {
    text_ += line + "\n";
    return *this;
  }
  template <class T>
  PlyWriter& put(T value) {
    if (format_ == "ascii") {
      std::ostringstream out;
      out.precision(9);
      out << +value << ' ';
      text_ += out.str();
      return *this;
    }
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (format_ == "binary_big_endian") std::reverse(bytes.begin(), bytes.end());
    text_.append(bytes.data(), bytes.size());
    return *this;
  }
  PlyWriter& end_row() {
    if (format_ == "ascii") text_ += "\n";
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string format_;
  std::string text_;
};

class PlyEncodings : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, PlyEncodings, testing::Values("ascii", "binary_little_endian", "binary_big_endian"));

// All features together: unknown elements before and between, unusual types and orders, lists in vertices, triangles, a
// quad and a pentagon.
std::string strange_file(const std::string& format) {
  PlyWriter w(format);
  w.header("obj_info nothing")
      .header("element camera 2")
      .header("property list uchar short view")
      .header("property char mode");
  w.header("element vertex 6");
  w.header("property double nz").header("property float y").header("property uchar red").header("property double x");
  w.header("property list ushort int neighbours")
      .header("property short z")
      .header("property float nx")
      .header("property float ny");
  w.header("property float texture_v").header("property float texture_u");
  w.header("element edge 1").header("property int a");
  w.header("element face 4")
      .header("property uchar flags")
      .header("property list ushort uint vertex_indices")
      .header("property float area");
  w.header("end_header");
  for (int i = 0; i < 2; ++i) {
    w.put(std::uint8_t(3));
    for (int k = 0; k < 3; ++k) w.put(std::int16_t(-k));
    w.put(std::int8_t(-1)).end_row();
  }
  for (int i = 0; i < 6; ++i) {
    const auto f = static_cast<float>(i);
    w.put(0.25 + i).put(f + 0.5f).put(std::uint8_t(200)).put(double(i) - 0.125).put(std::uint16_t(i));
    for (int k = 0; k < i; ++k) w.put(std::int32_t(-k));
    w.put(std::int16_t(-i)).put(2 * f).put(3 * f).put(0.5f * f).put(0.25f * f).end_row();
  }
  w.put(std::int32_t(7)).end_row();
  const std::vector<std::vector<std::uint32_t>> faces = {{0, 1, 2}, {1, 2, 4, 3}, {0, 1, 2, 3, 5}, {5, 4, 3}};
  for (const auto& face : faces) {
    w.put(std::uint8_t(9)).put(static_cast<std::uint16_t>(face.size()));
    for (const std::uint32_t i : face) w.put(i);
    w.put(1.5f).end_row();
  }
  return w.text();
}

void expect_strange_mesh(const PlyMesh& mesh) {
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {5, 4, 3}};
  EXPECT_EQ(mesh.triangles.triangles, triangles);
  EXPECT_EQ(mesh.quads.patches, (std::vector<Quad>{{1, 2, 3, 4}}));
  ASSERT_EQ(mesh.triangles.positions.size(), 6u);
  ASSERT_EQ(mesh.triangles.normals.size(), 6u);
  ASSERT_EQ(mesh.triangles.uvs.size(), 6u);
  for (int i = 0; i < 6; ++i) {
    const auto f = static_cast<float>(i);
    const auto k = static_cast<std::size_t>(i);
    EXPECT_EQ(mesh.triangles.positions[k], Point(f - 0.125f, f + 0.5f, -f));
    EXPECT_EQ(mesh.triangles.normals[k], Vec3(2 * f, 3 * f, 0.25f + f));
    EXPECT_EQ(mesh.triangles.uvs[k], Vec2(0.25f * f, 0.5f * f));
  }
  EXPECT_EQ(mesh.quads.positions, mesh.triangles.positions);
  EXPECT_EQ(mesh.quads.normals, mesh.triangles.normals);
  EXPECT_EQ(mesh.quads.uvs, mesh.triangles.uvs);
  EXPECT_EQ(mesh.warnings, std::vector<std::string>{"1 faces of more than four corners: fanned into triangles"});
}

TEST_P(PlyEncodings, ReadsAnyOrderAndTypeOfProperties) {
  expect_strange_mesh(parse_ply(strange_file(GetParam()), "t.ply"));
}

TEST_P(PlyEncodings, ReadsGzip) {
  expect_strange_mesh(parse_ply(test::gzip(strange_file(GetParam())), "t.ply.gz"));
  const test::TemporaryDir dir;
  const auto path = dir.write("t.ply.gz", test::gzip(strange_file(GetParam())));
  expect_strange_mesh(parse_ply(decompressed(read_file(path), path.string()), "t.ply.gz"));
}

// Every truncation must be an error, never a crash and never a shorter mesh.
TEST_P(PlyEncodings, TruncatedFilesAreErrors) {
  const std::string whole = strange_file(GetParam());
  const bool ascii = std::string(GetParam()) == "ascii";
  // An ascii file without its last digits can still be valid.
  const std::size_t least = ascii ? whole.find_last_of('1') : whole.size() - 1;
  for (std::size_t size = 0; size <= least; ++size)
    EXPECT_THROW(parse_ply(std::string_view(whole).substr(0, size), "t.ply"), Error) << size;
}

std::string small_file(const std::string& body, const std::string& vertices = "3", const std::string& faces = "1") {
  return "ply\nformat ascii 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_index\nend_header\n" + body;
}

// The corners of a strip zigzag across it, so every other triangle has the opposite winding. -1 begins a new strip;
// triangles with two equal corners are left out.
TEST_P(PlyEncodings, ReadsTriangleStrips) {
  PlyWriter w(GetParam());
  w.header("element vertex 6").header("property float x").header("property float y").header("property float z");
  w.header("element tristrips 2").header("property list int int vertex_indices").header("end_header");
  for (int i = 0; i < 6; ++i) w.put(static_cast<float>(i / 2)).put(static_cast<float>(i % 2)).put(0.0f).end_row();
  w.put(std::int32_t{9});
  for (const std::int32_t i : {0, 1, 2, 3, 3, 4, -1, 2, 3}) w.put(i);
  w.end_row().put(std::int32_t{4});
  for (const std::int32_t i : {5, 3, 4, 2}) w.put(i);
  w.end_row();
  const PlyMesh mesh = parse_ply(w.text(), "t.ply");
  EXPECT_EQ(mesh.triangles.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {5, 3, 4}, {4, 3, 2}}));
  EXPECT_TRUE(mesh.quads.patches.empty());
  EXPECT_TRUE(mesh.warnings.empty());
}

TEST(Ply, QuadsAloneGiveNoTriangles) {
  const PlyMesh mesh = parse_ply(small_file("0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n", "4"), "q.ply");
  EXPECT_TRUE(mesh.triangles.triangles.empty());
  EXPECT_TRUE(mesh.triangles.positions.empty());
  EXPECT_EQ(mesh.quads.patches, (std::vector<Quad>{{0, 1, 3, 2}}));
  EXPECT_EQ(mesh.quads.positions[2], Point(1, 1, 0));
}

TEST(Ply, WindowsLineEndsAndNoFinalNewline) {
  std::string text = small_file("0 0 0\n1 0 0\n1 1 -.5e1\n3 0 1 2");
  for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 2)) text.insert(at, 1, '\r');
  const PlyMesh mesh = parse_ply(text, "w.ply");
  EXPECT_EQ(mesh.triangles.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(mesh.triangles.positions[2], Point(1, 1, -5));
}

TEST(Ply, OddFacesAreLeftOutWithWarnings) {
  const PlyMesh mesh =
      parse_ply(small_file("0 0 0\n1 0 0\n1 1 0\nnan 0 0\n2 0 1\n3 0 1 2\n3 0 1 3\n", "4", "3"), "o.ply");
  EXPECT_EQ(mesh.triangles.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  ASSERT_EQ(mesh.warnings.size(), 2u);
  EXPECT_EQ(mesh.warnings[0], "1 faces of fewer than three corners: left out");
  EXPECT_EQ(mesh.warnings[1], "1 faces with a corner that is not finite: left out");
  EXPECT_EQ(mesh.triangles.positions.at(3), Point(0)) << "a mesh with such a position could not be built";
  const PlyMesh empty = parse_ply(small_file("0 0 0\n1 0 0\n1 1 0\n2 0 1\n"), "e.ply");
  EXPECT_TRUE(empty.triangles.positions.empty());
  EXPECT_EQ(empty.warnings.back(), "the mesh has no faces: left out");
}

TEST(Ply, AttributesThatAreNotFiniteAreZeroWithAWarning) {
  const PlyMesh mesh = parse_ply(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float "
      "nx\nproperty float ny\nproperty float nz\nproperty float u\nproperty float v\nelement face 1\nproperty list "
      "uchar int vertex_indices\nend_header\n0 0 0 0 nan 1 0 0\n1 0 0 0 0 1 inf 0\n1 1 0 0 0 1 1 1\n3 0 1 2\n",
      "n.ply");
  EXPECT_EQ(mesh.warnings,
            (std::vector<std::string>{"2 normals or texture coordinates that are not finite: read as 0"}));
  EXPECT_EQ(mesh.triangles.normals, (std::vector<Normal>{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}}));
  EXPECT_EQ(mesh.triangles.uvs[1], Vec2(0));
}

struct BadFile {
  std::string text;
  std::string message;
};

TEST(Ply, ErrorsNameFileAndLine) {
  const std::string good = "0 0 0\n1 0 0\n1 1 0\n";
  const std::vector<BadFile> files = {
      {"", "bad.ply:1:1: the file ends inside its header"},
      {"obj\n", R"(bad.ply:1:1: is not a PLY file: its first line is not "ply")"},
      {"ply\nend_header\n", "bad.ply:2:1: the header has no format line"},
      {"ply\nformat ebcdic 1.0\n", R"(bad.ply:2:1: unknown encoding "ebcdic")"},
      {"ply\nformat ascii 2.0\n", R"(bad.ply:2:1: expected "format ENCODING 1.0")"},
      {"ply\nproperty float x\n", "bad.ply:2:1: a property before the first element"},
      {"ply\nelement vertex -1\n", "bad.ply:2:1: expected a count after the element's name"},
      {"ply\nelement vertex 1\nproperty half x\n", R"(bad.ply:3:1: unknown type "half")"},
      {"ply\nelement face 1\nproperty list float int x\n", "bad.ply:3:1: a list's count must be an integer"},
      {"ply\nfrob\n", R"(bad.ply:2:1: unknown header line "frob")"},
      {small_file("0 0 0\n1 0 zero\n1 1 0\n3 0 1 2\n"), "bad.ply:11: expected a number"},
      {small_file(good + "3 0 1 3\n"), "bad.ply:13: a face uses vertex 3, but there are 3"},
      {small_file(good + "3 0 1 -1\n"), "bad.ply:13: a face has an invalid vertex index"},
      {small_file(good + "3 0 1 0.5\n"), "bad.ply:13: a face has an invalid vertex index"},
      {small_file(good + "9999999 0 1 2\n"), "bad.ply:13: a list has an invalid length"},
      {small_file(good + "-3 0 1 2\n"), "bad.ply:13: a list has an invalid length"},
      {small_file(good, "4000000000"), R"(bad.ply:10: the file is too short for 4000000000 times element "vertex")"},
      {small_file(good, "18446744073709551615"),
       R"(bad.ply:10: the file is too short for 18446744073709551615 times element "vertex")"},
      {"ply\nformat ascii 1.0\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n",
       "bad.ply:6: the file has no vertices"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 "
       "0\n",
       "bad.ply:8: the file has no faces"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0 0 0\n",
       "bad.ply:6: the vertices have no x, y and z"},
      {"ply\nformat binary_little_endian 1.0\nelement junk 1000000000000\nend_header\n",
       R"(bad.ply: element "junk" has no properties)"}};
  for (const BadFile& file : files) EXPECT_EQ(test::error_text([&] { parse_ply(file.text, "bad.ply"); }), file.message);
}

TEST(Gzip, DamageIsAnError) {
  const std::string whole = test::gzip(std::string(100000, 'a') + "b");
  EXPECT_EQ(gunzip(whole, "z"), std::string(100000, 'a') + "b");
  EXPECT_EQ(gunzip(whole + test::gzip("more"), "z"), std::string(100000, 'a') + "bmore");
  EXPECT_THROW(gunzip(whole.substr(0, whole.size() - 1), "z"), Error);
  EXPECT_THROW(gunzip(whole.substr(0, 12), "z"), Error);
  std::string damaged = whole;
  damaged[whole.size() - 5] = static_cast<char>(damaged[whole.size() - 5] ^ 1);
  EXPECT_THROW(gunzip(damaged, "z"), Error);
  EXPECT_THROW(gunzip(whole, "z", 1000), Error);
}

// A gzip file can contain itself.
TEST(Gzip, IsOpenedOnce) { EXPECT_THROW(parse_ply(test::gzip(test::gzip(strange_file("ascii"))), "t.ply"), Error); }

TEST(File, OnlyRegularFilesAreRead) {
  EXPECT_THROW(read_file("/dev/zero"), Error);
  EXPECT_THROW(read_file("/"), Error);
  EXPECT_THROW(read_file("/no/such/file"), Error);
}

}  // namespace
}  // namespace lanthorn::ply_test
