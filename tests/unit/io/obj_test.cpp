// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "io/obj/faces.h"
#include "io/obj/reader.h"
#include "lanthorn/image_file.h"
#include "lanthorn/scene.h"
#include "math/vec.h"
#include "scene/scene.h"
#include "support/error_text.h"
#include "support/temporary_dir.h"

namespace lanthorn::obj_test {
namespace {

using namespace description;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

SceneDescription read(const std::string& text, const std::map<std::string, std::string>& files = {}) {
  return with_stand_ins(obj::read(text, "dir", "t.obj", [&](const std::filesystem::path& path) {
    const auto found = files.find(path.string());
    if (found == files.end()) throw Error({path.string()}, "no such file");
    return found->second;
  }));
}

std::string error_of(const std::string& text, const std::string& mtl = "") {
  return test::error_text([&] { read(text, {{"dir/m.mtl", mtl}}); });
}

// Warnings, without those that every file without camera and light gives.
std::vector<std::string> warnings(const SceneDescription& scene) {
  std::vector<std::string> result;
  for (const Warning& w : scene.warnings)
    if (w.location.line > 0) result.push_back(Error(w.location, w.message).what());
  return result;
}

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const TriangleMesh& mesh(const SceneDescription& scene, std::size_t i = 0) {
  return std::get<TriangleMesh>(scene.shapes.at(i).geometry);
}

TEST(Obj, CornersOfEveryForm) {
  const std::string data = triangle + "vt 0.25 0.5\nvt 1 +1e0 0\nvn 0 0 1\nvn 0 0 -1\n";
  const SceneDescription plain = read(data + "f 1 2 3\n");
  EXPECT_EQ(mesh(plain).positions, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh(plain).triangles, (Triangles{{0, 1, 2}}));
  EXPECT_TRUE(mesh(plain).normals.empty() && mesh(plain).uvs.empty());
  const SceneDescription uv = read(data + "f 1/1 2/2 3/1\n");
  EXPECT_EQ(mesh(uv).uvs, (std::vector<Vec2>{{0.25f, 0.5f}, {1, 1}, {0.25f, 0.5f}}));
  EXPECT_TRUE(mesh(uv).normals.empty());
  const SceneDescription normal = read(data + "f 1//2 2//2 3//1\n");
  EXPECT_EQ(mesh(normal).normals, (std::vector<Normal>{{0, 0, -1}, {0, 0, -1}, {0, 0, 1}}));
  const SceneDescription all = read(data + "f -3/-1/-2 -2/-2/-1 -1/-1/-1\n");
  EXPECT_EQ(mesh(all).positions.size(), 3u);
  EXPECT_EQ(mesh(all).uvs[1], Vec2(0.25f, 0.5f));
  EXPECT_EQ(mesh(all).normals[0], Normal(0, 0, 1));
}

TEST(Obj, CornersAreSharedAndFacesSortedByMaterialAndAttributes) {
  const SceneDescription scene =
      read(triangle +
               "v 1 1 0\nvn 0 0 1\nmtllib m.mtl\nf 1 2 3\nusemtl red\nf 2 4 3\nf 1 2 3\nf 1//1 2//1 3//1\n"
               "usemtl blue paint\nf 1 2 3\n",
           {{"dir/m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue paint\nKd 0 0 1\n"}});
  ASSERT_EQ(scene.shapes.size(), 4u);
  std::map<std::string, std::size_t> triangles;
  for (const Shape& shape : scene.shapes)
    triangles[scene.materials.at(shape.material).name +
              (mesh(scene, static_cast<std::size_t>(&shape - &scene.shapes.front())).normals.empty() ? "" : " n")] =
        std::get<TriangleMesh>(shape.geometry).triangles.size();
  EXPECT_EQ(triangles, (std::map<std::string, std::size_t>{{"", 1}, {"red", 2}, {"red n", 1}, {"blue paint", 1}}));
  for (const Shape& shape : scene.shapes)
    if (scene.materials.at(shape.material).name == "red" && std::get<TriangleMesh>(shape.geometry).normals.empty()) {
      EXPECT_EQ(std::get<TriangleMesh>(shape.geometry).positions.size(), 4u);
    }
  EXPECT_EQ(scene.files.count("m.mtl"), 1u);
}

TEST(Obj, LinesMayBeContinuedAndCommented) {
  const SceneDescription scene =
      read("# a comment\r\nv 0 0 \\\r\n0 # origin\r\n\r\n  v 1 0 0\r\nv 0 1 0\r\n\tf 1 \\\n2 3\r\n#end");
  EXPECT_EQ(mesh(scene).triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(mesh(scene).positions[1], Point(1, 0, 0));
}

TEST(Obj, ErrorsHaveLineAndColumn) {
  EXPECT_EQ(error_of("v 0 0\n"), "t.obj:1:6: z is missing");
  EXPECT_EQ(error_of("v 0 0 x\n"), R"(t.obj:1:7: expected a number, found "x")");
  EXPECT_EQ(error_of("v 0 0 1e99\n"), R"(t.obj:1:7: the number "1e99" is too large)");
  EXPECT_EQ(error_of("v 0 0 nan\n"), R"(t.obj:1:7: expected a number, found "nan")");
  EXPECT_EQ(error_of("v 0 0 1e-99\n"), "no error");
  EXPECT_EQ(error_of(triangle + "f 1 2 4\n"), "t.obj:4:7: there is no vertex 4 here: only 3 precede this line");
  EXPECT_EQ(error_of(triangle + "f 1 2 0\n"), "t.obj:4:7: there is no vertex 0 here: only 3 precede this line");
  EXPECT_EQ(error_of(triangle + "f 1 2 -4\n"), "t.obj:4:7: there is no vertex -4 here: only 3 precede this line");
  EXPECT_EQ(error_of(triangle + "vt 0 0\nf 1/2 2 3\n"),
            "t.obj:5:3: there is no texture coordinate 2 here: only 1 precede this line");
  EXPECT_EQ(error_of(triangle + "vn 0 0 1\nf 1//2 2 3\n"),
            "t.obj:5:3: there is no normal 2 here: only 1 precede this line");
  EXPECT_EQ(error_of(triangle + "f 1 2 3.5\n"),
            R"(t.obj:4:7: expected a corner such as 1, 1/2, 1//3 or 1/2/3, found "3.5")");
  EXPECT_EQ(error_of(triangle + "f 1 2 99999999999999999999\n"),
            R"(t.obj:4:7: expected a corner such as 1, 1/2, 1//3 or 1/2/3, found "99999999999999999999")");
  EXPECT_EQ(error_of("mtllib m.mtl\n", "Kd 1 1 1\n"), R"(dir/m.mtl:1:1: "Kd" appears before the first newmtl)");
  EXPECT_EQ(error_of("mtllib m.mtl\n", "newmtl a\nKd 1 -1 0\n"), R"(dir/m.mtl:2:6: must not be negative, but is "-1")");
  EXPECT_EQ(error_of("mtllib m.mtl\n", "newmtl a\nmap_Kd -clamp on\n"), "dir/m.mtl:2:17: a file name is missing");
}

// Line endings of Windows and of old Macintosh programs.
TEST(Obj, ByteOrderMarksAndCarriageReturns) {
  const std::string lines = "v 0 0 0\nv 1 0 0 # x\nv 0 \\\n1 0\nusemtl a b\nf 1 2 3\nnonsense\n";
  for (const std::string end : {"\n", "\r", "\r\n"}) {
    std::string text = "\xEF\xBB\xBF";
    for (const char c : lines) text += c == '\n' ? end : std::string(1, c);
    const SceneDescription scene = read(text);
    ASSERT_EQ(scene.shapes.size(), 1u) << testing::PrintToString(end);
    EXPECT_EQ(std::get<TriangleMesh>(scene.shapes[0].geometry).positions.at(2), Point(0, 1, 0));
    EXPECT_EQ(warnings(scene), (std::vector<std::string>{R"(t.obj:7:1: "nonsense" is not supported: ignored)",
                                                         R"(t.obj:6:1: there is no material "a b": grey is used)"}))
        << testing::PrintToString(end);
  }
}

// Some files refer to texture coordinates and normals that do not exist.
TEST(Obj, CornersOfFilesWithoutNormals) {
  const SceneDescription scene = read(triangle + "f 1/1/1 2/2/1 3/3/1\nf 1//1 2//1 3//1\n");
  const auto& mesh = std::get<TriangleMesh>(scene.shapes.at(0).geometry);
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_TRUE(mesh.normals.empty() && mesh.uvs.empty());
  const std::vector<std::string> all = warnings(scene);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0],
            "t.obj:4:3: faces refer to a texture coordinate, but none precedes them: ignored (and 2 more like it)");
  EXPECT_EQ(all[1], "t.obj:4:3: faces refer to a normal, but none precedes them: ignored (and 5 more like it)");
}

TEST(Mtl, SeveralLibrariesInALine) {
  const SceneDescription scene = read("mtllib none.mtl  a b.mtl m.mtl\n" + triangle + "usemtl red\nf 1 2 3\n",
                                      {{"dir/m.mtl", "newmtl red\nKd 1 0 0\n"}});
  EXPECT_EQ(scene.materials.at(scene.shapes.at(0).material).name, "red");
  EXPECT_EQ(warnings(scene),
            (std::vector<std::string>{"t.obj:1:8: dir/none.mtl: no such file, dir/a: no such file, dir/b.mtl: no such "
                                      "file: their materials are left out"}));
  const SceneDescription blank =
      read("mtllib a b.mtl\n" + triangle + "usemtl red\nf 1 2 3\n", {{"dir/a b.mtl", "newmtl red\nKd 1 0 0\n"}});
  EXPECT_TRUE(warnings(blank).empty());
}

// The faces of this open box are wound for a viewer inside. The view shows the inside of the box, here from behind.
TEST(Obj, OpenBoxesAreSeenFromInside) {
  const SceneDescription scene = read(
      "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
      "f 8 7 6 5\nf 1 5 6 2\nf 4 3 7 8\nf 1 4 8 5\nf 2 6 7 3\n");
  EXPECT_TRUE(scene.warnings.back().message.find(" a view of all of it from behind, in") != std::string::npos)
      << scene.warnings.back().message;
}

// Six walls with the same material: separate objects make a room, a single one a box.
TEST(Obj, ObjectsAreWalls) {
  const std::string corners = "v 0 0 0\nv 5 0 0\nv 5 2.6 0\nv 0 2.6 0\nv 0 0 4\nv 5 0 4\nv 5 2.6 4\nv 0 2.6 4\n";
  const std::vector<std::string> walls{"4 3 2 1", "5 6 7 8", "1 2 6 5", "4 8 7 3", "1 5 8 4", "2 3 7 6"};
  for (const std::string word : {"o", "g", ""}) {
    std::string text = corners;
    for (const std::string& wall : walls)
      text += (word.empty() ? "" : word + " wall of " + wall) + "\nf " + wall + "\n";
    const std::string said = read(text).warnings.back().message;
    EXPECT_EQ(said.find("from inside, lit by a lamp") != said.npos, !word.empty()) << said;
  }
}

TEST(Obj, WhatIsNotReadIsListedInALine) {
  const SceneDescription scene = read("mtllib m.mtl\n" + triangle +
                                          "p 1\ncurv 0 1\nl 1 2\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 "
                                          "3\nusemtl a\nf 3 2 1\n",
                                      {{"dir/m.mtl", "newmtl d\nrefl x.png\ndisp y.png\nmap_Kd -a -b z.png\n"}});
  EXPECT_EQ(warnings(scene), (std::vector<std::string>{
                                 R"(dir/m.mtl:2:1: "refl", "disp" in materials are not supported: ignored)",
                                 R"(dir/m.mtl:4:8: the options "-a", "-b" of texture maps are not supported: ignored)",
                                 R"(t.obj:5:1: "p", "curv", "l" are not supported: ignored)",
                                 R"(t.obj:9:1: there are no materials "a", "b", "c": grey is used)"}));
}

TEST(Obj, WhatIsNotReadIsSaidOnce) {
  const SceneDescription scene = read("mtllib none.mtl\nv 0 0 0 1 0 nan\n" + triangle +
                                      "s 1\nl 1 2\nl 2 3\nf 1 2\nusemtl gold\nf 1 2 3\no x\ng y\n");
  EXPECT_EQ(warnings(scene),
            (std::vector<std::string>{"t.obj:1:8: dir/none.mtl: no such file: its materials are left out",
                                      "t.obj:2:1: vertex colours that are not numbers are read as white",
                                      R"(t.obj:7:1: "l" is not supported: ignored)",
                                      "t.obj:9:1: faces of fewer than three corners are left out",
                                      R"(t.obj:11:1: there is no material "gold": grey is used)"}));
}

const std::string models = LANTHORN_SOURCE_DIR "/tests/scenes/models/";

std::vector<std::string> messages(const std::filesystem::path& file) { return warnings(read_scene(file)); }

// The largest angle between a corner's normal and its triangle's normal, degrees.
float bend(const SceneDescription& scene) {
  float largest = 0;
  for (const Shape& shape : scene.shapes) {
    const auto& m = std::get<TriangleMesh>(shape.geometry);
    if (m.normals.empty()) continue;
    for (const auto& t : m.triangles) {
      const Vec3 n = normalize(cross(m.positions[t[1]] - m.positions[t[0]], m.positions[t[2]] - m.positions[t[0]]));
      for (const std::uint32_t i : t) largest = std::fmax(largest, std::acos(std::fmin(dot(n, m.normals[i]), 1.0f)));
    }
  }
  return largest * 180 / pi;
}

// An octagonal tube: sides in one smoothing group, caps in none.
TEST(ObjSmoothing, GroupsAreSmoothAndOtherFacesFlat) {
  const SceneDescription scene = read_scene(models + "smooth-tube.obj");
  EXPECT_TRUE(warnings(scene).empty());
  std::size_t round = 0, flat = 0;
  for (const Shape& shape : scene.shapes) {
    const auto& m = std::get<TriangleMesh>(shape.geometry);
    for (const auto& t : m.triangles) {
      const bool is_cap = m.positions[t[0]].y == m.positions[t[1]].y && m.positions[t[0]].y == m.positions[t[2]].y;
      ++(is_cap ? flat : round);
      ASSERT_EQ(m.normals.empty(), is_cap);
      for (const std::uint32_t i : t) {
        if (is_cap) continue;
        const Vec3 radial = Vec3(m.positions[i].x, 0, m.positions[i].z);
        EXPECT_LT(length(m.normals[i] - radial), 2e-4f);  // the file has four digits
      }
    }
  }
  EXPECT_EQ(round, 16u);
  EXPECT_EQ(flat, 12u);
}

// Two squares that share an edge on the y axis; the second is rotated about it by this angle out of the first's plane.
std::string hinge(float degrees) {
  const float a = degrees * pi / 180;
  return "v -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv " + std::to_string(std::cos(a)) + " 0 " +
         std::to_string(-std::sin(a)) + "\nv " + std::to_string(std::cos(a)) + " 1 " + std::to_string(-std::sin(a)) +
         "\n";
}
const std::string left = "f 1 2 3 4\n", right = "f 2 5 6 3\n";

TEST(ObjSmoothing, GroupsDecideWhereTheFileHasAny) {
  const std::string sharp = hinge(60);
  EXPECT_NEAR(bend(read(sharp + "s 1\n" + left + right)), 30, 0.01f);
  EXPECT_NEAR(bend(read(sharp + "usemtl a\ns 7\n" + left + "usemtl b\n" + right)), 30, 0.01f) << "across materials";
  EXPECT_NEAR(bend(read(sharp + "s on\n" + left + right)), 30, 0.01f);
  EXPECT_NEAR(bend(read(sharp + "s 1\n" + left + "s off\ns 1\n" + right)), 30, 0.01f);
  EXPECT_EQ(bend(read(sharp + "s 1\n" + left + "s 2\n" + right)), 0);
  EXPECT_EQ(bend(read(sharp + "s 1\n" + left + "f 2 3 6 5\n")), 0) << "wound the other way";
  for (const char* none : {"s off\n", "s 0\n", "s null\n", "s\n"})
    EXPECT_EQ(bend(read(hinge(9) + none + left + right)), 0);
  EXPECT_EQ(bend(read(hinge(9) + left + "s 1\n" + right)), 0) << "the first face has no group";
  // Sheets with separate back faces: each side is smooth on its own.
  const std::string backs = "f 4 3 2 1\nf 3 6 5 2\n";
  EXPECT_NEAR(bend(read(sharp + "s 1\n" + left + right + backs)), 30, 0.01f);
  EXPECT_NEAR(bend(read(sharp + "s 1\n" + left + backs + right)), 30, 0.01f);
  EXPECT_EQ(bend(read(sharp + "s 1\n" + left + "f 4 3 2 1\n")), 0) << "a card";
  // Normals in the file are used, whatever its smoothing groups.
  EXPECT_EQ(mesh(read(sharp + "vn 0 1 0\ns 1\nf 1//1 2//1 3//1 4//1\n")).normals[0], Vec3(0, 1, 0));
}

TEST(ObjSmoothing, WithoutGroupsEdgesOfLessThan30DegreesAreSmooth) {
  EXPECT_NEAR(bend(read(hinge(28) + left + right)), 14, 0.01f);
  EXPECT_EQ(bend(read(hinge(32) + left + right)), 0);
  const SceneDescription plane = read(hinge(0) + left + right);
  ASSERT_EQ(plane.shapes.size(), 1u);
  EXPECT_TRUE(mesh(plane).normals.empty()) << "flat faces need none";
  // Normals are weighted by angle: of the three corners at the vertex, of 90, 45 and 45 degrees, the latter two agree.
  const SceneDescription fan = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 .2 0\nv -1 .2 1\nf 1 2 3\nf 1 3 4\nf 1 4 5\n");
  EXPECT_EQ(bend(fan), 0) << "a right angle stays";
  // Degenerate faces, and edges of three faces.
  EXPECT_EQ(read("v 0 0 0\nv 1 0 0\nf 1 1 1\nf 1 2 1\ns 1\nf 1 2 1\n").shapes.size(), 1u);
  EXPECT_EQ(read("s 1\n" + triangle + "v 0 0 1\nf 1 2 3\nf 2 1 4\nf 2 1 3\n").shapes.empty(), false);
}

// Collections for students' renderers have models with a picture but without an MTL file.
TEST(Obj, APictureCalledAfterTheModelIsSuggested) {
  test::TemporaryDir dir;
  const std::string faces = triangle + "vt 0 0\nf 1/1 2/1 3/1\n";
  const auto said = [&](const std::string& text) {
    const std::vector<std::string> all = messages(dir.write("Head.obj", text));
    return all.empty() ? "" : all.back().substr(dir.path().string().size() + 1);
  };
  EXPECT_EQ(said(faces), "");
  dir.write("head_nm.png", "");
  dir.write("headless_diffuse.png", "");
  EXPECT_EQ(said(faces), "");
  dir.write("head_d.png", "");
  dir.write("head_Diffuse.TGA", "");
  EXPECT_EQ(said(faces),
            R"(Head.obj:1:1: no material has a picture, but "head_Diffuse.TGA" lies beside the file: to use it, begin )"
            R"(the file with "mtllib Head.mtl" and "usemtl skin", and write Head.mtl of the lines "newmtl skin" and )"
            R"("map_Kd head_Diffuse.TGA")");
  EXPECT_TRUE(said(triangle + "f 1 2 3\n").empty()) << "no texture coordinates";
  dir.write("a.mtl", "newmtl m\n");
  EXPECT_TRUE(said("mtllib a.mtl\nusemtl m\n" + faces)
                  .ends_with(R"(to use it, add the line "map_Kd head_Diffuse.TGA" )"
                             "to its material"));
  dir.write("a.mtl", "newmtl m\nmap_Kd head_d.png\n");
  EXPECT_EQ(said("mtllib a.mtl\nusemtl m\n" + faces), "");
}

// A card whose picture has transparent holes.
TEST(Obj, TransparentTexelsOfColoursAreHoles) {
  const Scene scene(read_scene(models + "leaf.obj"));
  const auto is_hit = [&](float u, float v) {
    return scene.intersect(Ray({2 * u - 1, 2 * v, 1}, {0, 0, -1}), Wavelengths::rgb(0.5f)).has_value();
  };
  const Image leaf = read_image(models + "leaf.png");
  ASSERT_EQ(leaf.channel_count(), 4u);
  int holes = 0, solid = 0;
  for (int y = 0; y < leaf.height; ++y)
    for (int x = 0; x < leaf.width; ++x) {
      const float alpha = leaf.at(x, y, 3);
      if (alpha > 0 && alpha < 1) continue;
      ++(alpha > 0 ? solid : holes);
      EXPECT_EQ(is_hit((static_cast<float>(x) + 0.5f) / static_cast<float>(leaf.width),
                       1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(leaf.height)),
                alpha > 0)
          << x << " " << y;
    }
  EXPECT_GT(holes, 9);
  EXPECT_GT(solid, 9);
}

// The parts of an MTL file with this material.
SceneDescription with_mtl(const std::string& lines) {
  return read(triangle + "mtllib m.mtl\nusemtl m\nf 1 2 3\n", {{"dir/m.mtl", "newmtl m\n" + lines}});
}
template <class T>
T material(const std::string& lines) {
  const SceneDescription scene = with_mtl(lines);
  EXPECT_EQ(warnings(scene), std::vector<std::string>{});
  return std::get<T>(scene.materials.at(scene.shapes.at(0).material).node);
}
Rgb rgb(const SpectrumParameter& p) { return std::get<RgbSpectrum>(p.value).rgb; }

TEST(Mtl, KindsOfMaterials) {
  EXPECT_EQ(rgb(material<DiffuseMaterial>("Kd 0.1 0.2 0.3\nKa 1 1 1\nillum 1\n").reflectance), (Rgb{0.1f, 0.2f, 0.3f}));
  EXPECT_EQ(rgb(material<DiffuseMaterial>("Kd 0.5\n").reflectance), (Rgb{0.5f, 0.5f, 0.5f}));
  const auto gloss = material<PlasticMaterial>("Kd 0.1 0.2 0.3\nKs 0.5 0.5 0.5\nNs 198\nNi 1.4\nillum 2\n");
  EXPECT_EQ(rgb(gloss.reflectance), (Rgb{0.1f, 0.2f, 0.3f}));
  EXPECT_NEAR(gloss.roughness.u.value, 0.1f, 1e-6f);  // sqrt(2 / 200)
  EXPECT_EQ(std::get<float>(gloss.eta), 1.4f);
  EXPECT_EQ(std::get<float>(material<DielectricMaterial>("Ni 1.33\nillum 7\nd 0.1\n").eta), 1.33f);
  EXPECT_EQ(std::get<float>(material<DielectricMaterial>("Ni 1.2\nillum 9\n").eta), 1.2f);
  const auto filter = material<DielectricMaterial>("Ni 1.33\nillum 7\nTf 0.2 0.9 0.4\n");
  EXPECT_EQ(rgb(filter.tint), (Rgb{0.2f, 0.9f, 0.4f}));
  for (const char* none : {"", "Tf 1 1 1\n", "Tf 0 0 0\n", "Tf 3 3 3\n"})
    EXPECT_EQ(std::get<float>(material<DielectricMaterial>("illum 7\n" + std::string(none)).tint.value), 1) << none;
  const auto mirror = material<ConductorMaterial>("Kd 0 0 0\nKs 0.9 0.8 0.7\nillum 3\n");
  EXPECT_EQ(rgb(*mirror.reflectance), (Rgb{0.9f, 0.8f, 0.7f}));
  EXPECT_EQ(mirror.roughness.u.value, 0);
  const auto metal = material<ConductorMaterial>("Kd 1 0.8 0.2\nPm 1\nPr 0.5\n");
  EXPECT_EQ(metal.roughness.u.value, 0.25f);
}

// The closure at (1/4, 1/4) of the only face, seen from the front. There the corners have the weights 1/2, 1/4, 1/4.
template <class Closure>
Closure closure_of(const SceneDescription& description) {
  const Scene scene(description);
  const auto at = scene.intersect({{0.25f, 0.25f, 1}, {0, 0, -1}}, Wavelengths::rgb(0.5f));
  return std::get<Closure>(at.value().bsdf.get());
}
void expect_near(const Spectrum& colour, const Rgb& expected, const std::string& what) {
  EXPECT_NEAR(colour[0], expected.r, 1e-5f) << what;
  EXPECT_NEAR(colour[1], expected.g, 1e-5f) << what;
  EXPECT_NEAR(colour[2], expected.b, 1e-5f) << what;
}

// Vertex colours are in sRGB, from 0 to 1 or to 255. They multiply Kd, and replace a missing material.
TEST(Obj, ColoursOfVerticesMultiplyTheReflectance) {
  const std::string faces = "f 1 2 3\n";
  const auto corners = [](const std::string& a, const std::string& b, const std::string& c) {
    return "v 0 0 0 " + a + "\nv 1 0 0 " + b + "\nv 0 1 0 " + c + "\n";
  };
  const std::string primaries = corners("1 0 0", "0 1 0", "0 0 1");
  expect_near(closure_of<Diffuse>(read(primaries + faces)).reflectance, {0.5f, 0.25f, 0.25f}, "no material");
  expect_near(closure_of<Diffuse>(read(corners("255 0 0", "0 255 0", "0 0 255") + faces)).reflectance,
              {0.5f, 0.25f, 0.25f}, "bytes");
  const float half = 0.21404114f;  // linear value of 0.5
  expect_near(closure_of<Diffuse>(read(corners("0.5 0.5 0.5", "0.5 0.5 0.5", "0.5 0.5 0.5") + faces)).reflectance,
              {half, half, half}, "sRGB");
  expect_near(closure_of<Diffuse>(read(corners("1 0 0", "", "nan 0 0") + faces)).reflectance, {1, 0.5f, 0.5f},
              "white where there is none");
  const auto with = [&](const std::string& lines) {
    return read(primaries + "mtllib m.mtl\nusemtl m\n" + faces, {{"dir/m.mtl", "newmtl m\n" + lines}});
  };
  expect_near(closure_of<Diffuse>(with("Kd 0.8 0.4 1\n")).reflectance, {0.4f, 0.1f, 0.25f}, "diffuse");
  expect_near(closure_of<Plastic>(with("Kd 0.8 0.4 1\nKs 1 1 1\n")).reflectance, {0.4f, 0.1f, 0.25f}, "plastic");
  // A vertex weight is not a colour, and without colours nothing changes.
  expect_near(closure_of<Diffuse>(read(corners("1", "1", "1") + faces)).reflectance, {0.5f, 0.5f, 0.5f}, "weights");
  const SceneDescription plain = read(triangle + faces);
  EXPECT_TRUE(mesh(plain).colors.empty());
  EXPECT_TRUE(plain.spectrum_textures.empty());
}

// As Blender writes a leaf of alpha 0.5, and a robot with an alpha of 0 that its own renderer ignores.
TEST(Mtl, OpacityDecidesWhetherModelNineIsGlass) {
  const std::string blender = "Kd 0.2 0.4 0.1\nKs 0.5 0.5 0.5\nNs 96\nNi 1.45\nillum 9\n";
  for (const auto& [line, alpha] :
       {std::pair("d 0.5\n", 0.5f), std::pair("d 0\n", 1.0f), std::pair("Tr 0.25\n", 0.75f)}) {
    const SceneDescription scene = with_mtl(blender + line);
    EXPECT_TRUE(std::holds_alternative<PlasticMaterial>(scene.materials.at(scene.shapes.at(0).material).node)) << line;
    EXPECT_EQ(scene.shapes.at(0).alpha.value, alpha) << line;
  }
  EXPECT_EQ(std::get<float>(material<DielectricMaterial>(blender + "d 1\n").eta), 1.45f);
}

// Exporters that confuse opacity with transparency, or lose the material's name, write such files.
TEST(Mtl, InvisibleAndNamelessMaterialsAreShown) {
  for (const char* line : {"d 0\n", "Tr 1\n"}) {
    const SceneDescription scene = with_mtl(line);
    EXPECT_EQ(scene.shapes.at(0).alpha.value, 1) << line;
    EXPECT_EQ(warnings(scene), std::vector<std::string>{R"(dir/m.mtl:1:1: material "m" would be invisible because of )"
                                                        R"("d" or "Tr", usually a mistake: it is opaque)"});
  }
  const SceneDescription nameless =
      read(triangle + "mtllib m.mtl\nusemtl\nf 1 2 3\n", {{"dir/m.mtl", "newmtl\nKd 1 0 0\n"}});
  EXPECT_EQ(rgb(std::get<DiffuseMaterial>(nameless.materials.at(nameless.shapes.at(0).material).node).reflectance),
            (Rgb{1, 0, 0}));
  EXPECT_EQ(warnings(nameless),
            std::vector<std::string>{"dir/m.mtl:1:7: the material has no name: usemtl without a name refers to it"});
}

TEST(Mtl, TheAlphaOfColoursCountsWhereNoMapOfAlphaIsGiven) {
  const auto alpha_of = [](const SceneDescription& scene) {
    return std::get<ImageTexture>(scene.float_textures.at(scene.shapes.at(0).alpha.texture.value()).node);
  };
  const ImageTexture colours = alpha_of(with_mtl("d 0.5\nmap_Kd leaf.png\n"));
  EXPECT_EQ(colours.filename, "dir/leaf.png");
  EXPECT_EQ(colours.channel, 3);
  EXPECT_EQ(colours.scale, 0.5f);
  EXPECT_EQ(alpha_of(with_mtl("map_Kd leaf.png\nd 0\n")).scale, 1) << "by mistake";
  EXPECT_EQ(alpha_of(with_mtl("map_Kd leaf.png\nmap_d holes.png\n")).filename, "dir/holes.png");
  EXPECT_FALSE(with_mtl("illum 7\nmap_Kd leaf.png\n").shapes.at(0).alpha.texture);
  for (const char* blender : {"# Blender MTL File: 'a.blend'\n", "# Blender 3.6.4 MTL File: 'None'\n"}) {
    const SceneDescription scene = read(triangle + "mtllib m.mtl\nusemtl m\nf 1 2 3\n",
                                        {{"dir/m.mtl", blender + std::string("newmtl m\nmap_Kd leaf.png\n")}});
    EXPECT_FALSE(scene.shapes.at(0).alpha.texture) << "Blender names a map_d where alpha counts";
  }
}

TEST(Mtl, AlphaAndEmission) {
  EXPECT_EQ(with_mtl("d 0.25\n").shapes.at(0).alpha.value, 0.25f);
  EXPECT_EQ(with_mtl("Tr 0.25\n").shapes.at(0).alpha.value, 0.75f);
  EXPECT_EQ(with_mtl("d -halo 0.5\n").shapes.at(0).alpha.value, 0.5f);
  EXPECT_EQ(with_mtl("illum 7\nd 0.25\n").shapes.at(0).alpha.value, 1);
  const SceneDescription lamp = with_mtl("Ke 3 2 1\n");
  EXPECT_EQ(rgb(lamp.area_lights.at(lamp.shapes.at(0).area_light.value()).radiance), (Rgb{3, 2, 1}));
  EXPECT_EQ(lamp.lights.size(), 1u) << "the studio: the lamp has nothing to light";
  EXPECT_EQ(with_mtl("Kd 1 1 1\n").lights.size(), 1u);
  const std::string room = "mtllib m.mtl\n" + triangle + "usemtl lamp\nf 1 2 3\nusemtl wall\nf 3 2 1\n";
  EXPECT_TRUE(read(room, {{"dir/m.mtl", "newmtl lamp\nKe 3 2 1\nnewmtl wall\nKd 1 1 1\n"}}).lights.empty());
  EXPECT_EQ(read(room, {{"dir/m.mtl", "newmtl lamp\nKe 0.01 0 0\nnewmtl wall\nKd 1 1 1\n"}}).lights.size(), 1u);
}

TEST(Mtl, TextureMaps) {
  const SceneDescription scene = with_mtl(
      "Kd 0.5 0.5 1\nmap_kd -s 2 3 1 -o 0.5 -clamp on tex\\wood grain.png\nmap_d -imfchan r -bm 2 leaf.png\nrefl "
      "-type sphere sky.png\nmap_Ns gloss.png\nrefl more.png\n");
  EXPECT_EQ(warnings(scene), (std::vector<std::string>{
                                 R"(dir/m.mtl:4:7: the options "-imfchan", "-bm" of texture maps are not supported: )"
                                 "ignored",
                                 R"(dir/m.mtl:5:1: "refl", "map_Ns" in materials are not supported: ignored)"}));
  const auto& base = std::get<ImageTexture>(scene.spectrum_textures.at(0).node);
  EXPECT_EQ(base.filename, "dir/tex/wood grain.png");
  EXPECT_EQ(base.tint, (Rgb{0.5f, 0.5f, 1}));
  EXPECT_EQ(std::get<UvMapping>(base.mapping).linear, Mat2(2, 0, 0, 3));
  EXPECT_EQ(std::get<UvMapping>(base.mapping).offset, Vec2(0.5f, 0));
  EXPECT_EQ(base.wrap, Wrap::clamp);
  const Shape& shape = scene.shapes.at(0);
  EXPECT_EQ(std::get<ImageTexture>(scene.float_textures.at(shape.alpha.texture.value()).node).filename, "dir/leaf.png");
}

// The image itself tells whether a bump map contains normals or heights.
TEST(Mtl, BumpMapsAreOfNormalsOrHeights) {
  for (const char* name : {"map_Bump", "map_bump", "bump"})
    for (const char* kind : {"Kd 1 1 1\n", "Ks 1 1 1\n", "illum 7\n", "illum 3\nKd 0 0 0\nKs 1 1 1\n"}) {
      const SceneDescription scene = with_mtl(std::string(kind) + name + " -s 2 2 -bm 0.25 relief.png\n");
      EXPECT_EQ(warnings(scene), std::vector<std::string>{}) << name;
      const Material& m = scene.materials.at(scene.shapes.at(0).material);
      ASSERT_TRUE(m.normal_map && m.displacement) << kind;
      EXPECT_EQ(m.normal_map->strength, 0.25f);
      EXPECT_EQ(m.normal_map->image.scale, 1);
      const auto& heights = std::get<ImageTexture>(scene.float_textures.at(m.displacement->texture.value()).node);
      EXPECT_EQ(heights.scale, 0.25f);
      EXPECT_EQ(heights.channel, 0);
      for (const ImageTexture& image : {m.normal_map->image, heights}) {
        EXPECT_EQ(image.filename, "dir/relief.png");
        EXPECT_EQ(image.encoding, Encoding::linear);
        EXPECT_EQ(std::get<UvMapping>(image.mapping).linear, Mat2(2, 0, 0, 2));
      }
    }
  const SceneDescription both = with_mtl("bump relief.png\nnorm normals.png\n");
  const Material& m = both.materials.at(both.shapes.at(0).material);
  EXPECT_EQ(m.normal_map.value().image.filename, "dir/normals.png");
  EXPECT_FALSE(m.displacement.has_value());
}

TEST(Mtl, SpecularMaps) {
  for (const char* ks : {"", "Ks 0 0 0\n", "Ks 0.3 0.3 0.3\n"}) {
    const SceneDescription scene = with_mtl(std::string(ks) + "map_Ks shine.png\n");
    EXPECT_EQ(warnings(scene), std::vector<std::string>{});
    const auto& gloss = std::get<PlasticMaterial>(scene.materials.at(scene.shapes.at(0).material).node);
    const auto& image = std::get<ImageTexture>(scene.spectrum_textures.at(gloss.specular_color.texture.value()).node);
    EXPECT_EQ(image.filename, "dir/shine.png");
    EXPECT_EQ(image.tint, (Rgb{1, 1, 1}));
  }
  EXPECT_TRUE(std::holds_alternative<DiffuseMaterial>(with_mtl("illum 1\nmap_Ks shine.png\n").materials.at(0).node));
}

// From version 3.1 on, Blender writes roughness in Ns and map_Ns, and metalness in map_refl.
TEST(Mtl, FilesByBlenderHaveItsRoughness) {
  const auto by = [](const std::string& program, const std::string& lines) {
    return read(triangle + "mtllib m.mtl\nusemtl m\nf 1 2 3\n", {{"dir/m.mtl", program + "newmtl m\n" + lines}});
  };
  const std::string blender = "# Blender 3.6.4 MTL File: 'None'\n# www.blender.org\n\n";
  const auto width = [&](const std::string& program, const std::string& ns) {
    return std::get<PlasticMaterial>(by(program, "Ks 0.5 0.5 0.5\nNs " + ns + "\n").materials.at(0).node)
        .roughness.u.value;
  };
  EXPECT_NEAR(width(blender, "250"), 0.25f, 1e-6f);  // the square of roughness 1/2
  EXPECT_EQ(width(blender, "0"), 1);
  EXPECT_EQ(width(blender, "2000"), 0);
  EXPECT_NEAR(width("# Blender MTL File: 'a.blend'\n", "198"), 0.1f, 1e-6f);
  const std::string maps = "Ks 0.5 0.5 0.5\nNs 250\nmap_Ns rough.png\nmap_refl metal.png\n";
  const SceneDescription scene = by(blender, maps);
  EXPECT_EQ(warnings(scene), std::vector<std::string>{});
  std::vector<std::string> files;
  for (const FloatTexture& texture : scene.float_textures)
    if (const auto* image = std::get_if<ImageTexture>(&texture.node)) files.push_back(image->filename);
  EXPECT_EQ(files, (std::vector<std::string>{"dir/rough.png", "dir/metal.png"}));
  EXPECT_EQ(
      warnings(by("", maps)),
      (std::vector<std::string>{R"(dir/m.mtl:4:1: "map_Ns", "map_refl" in materials are not supported: ignored)"}));
}

TEST(Mtl, NormalAndEmissionMaps) {
  const SceneDescription scene = with_mtl("Kd 1 1 1\nnorm -s 2 2 bumps.png\nKe 3 2 1\nmap_Ke glow.png\n");
  EXPECT_EQ(warnings(scene), std::vector<std::string>{});
  const auto& map = scene.materials.at(scene.shapes.at(0).material).normal_map;
  ASSERT_TRUE(map.has_value());
  EXPECT_EQ(map->image.filename, "dir/bumps.png");
  EXPECT_EQ(map->image.encoding, Encoding::linear);
  EXPECT_EQ(map->strength, 1);
  EXPECT_EQ(std::get<UvMapping>(map->image.mapping).linear, Mat2(2, 0, 0, 2));
  const auto emission = [](const SceneDescription& s) {
    const description::AreaLight& light = s.area_lights.at(s.shapes.at(0).area_light.value());
    return std::get<ImageTexture>(s.spectrum_textures.at(light.radiance.texture.value()).node);
  };
  EXPECT_EQ(emission(scene).filename, "dir/glow.png");
  EXPECT_EQ(emission(scene).tint, (Rgb{3, 2, 1}));
  EXPECT_EQ(emission(with_mtl("Ke 0 0 0\nmap_Ke glow.png\n")).tint, (Rgb{1, 1, 1})) << "as exporters leave it";
}

TEST(Obj, LibrariesAreReadOnceEach) {
  int reads = 0;
  const FileReader files = [&](const std::filesystem::path&) {
    ++reads;
    return "newmtl m\nKd 1 0 0\n";
  };
  std::string text;
  for (int i = 0; i < 100; ++i) text += "mtllib a.mtl\nmtllib b.mtl a.mtl\n";
  obj::read(text + triangle + "f 1 2 3\n", "dir", "dir/t.obj", files);
  EXPECT_LE(reads, 3);  // "b.mtl a.mtl" may be the name of one file
}

double area(const std::vector<Point>& corners, const Triangles& triangles) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles) {
    const Vec3 n = cross(corners[b] - corners[a], corners[c] - corners[a]);
    EXPECT_GT(n.z, 0);  // the polygon's winding
    sum += 0.5 * static_cast<double>(n.z);
  }
  return sum;
}

Triangles triangulate(const std::vector<Point>& corners, std::uint64_t tests = 1000) {
  return obj::triangulate(corners, tests);
}

TEST(ObjPolygon, CoversConcavePolygonsOnce) {
  const std::vector<Point> arrow = {{0, 0, 0}, {4, -2, 0}, {1, 0, 0}, {4, 2, 0}};
  EXPECT_DOUBLE_EQ(area(arrow, triangulate(arrow)), 2);
  const std::vector<Point> comb = {{0, 0, 1}, {5, 0, 1}, {5, 3, 1}, {4, 3, 1}, {4, 1, 1}, {3, 1, 1},
                                   {3, 3, 1}, {2, 3, 1}, {2, 1, 1}, {1, 1, 1}, {1, 3, 1}, {0, 3, 1}};
  const Triangles triangles = triangulate(comb);
  EXPECT_EQ(triangles.size(), comb.size() - 2);
  EXPECT_DOUBLE_EQ(area(comb, triangles), 5 + 3 * 2);
  std::uint64_t tests = 1000, few = 50;
  obj::triangulate(comb, tests);
  EXPECT_LT(tests, 900u);
  EXPECT_EQ(triangulate(comb, 1000 - tests), triangles);
  const Triangles fan = obj::triangulate(comb, few);
  for (std::uint32_t i = 0; i < 10; ++i) EXPECT_EQ(fan.at(i), (std::array<std::uint32_t, 3>{0, i + 1, i + 2}));
  const std::vector<Point> line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  EXPECT_EQ(triangulate(line).size(), 2u);
}

}  // namespace
}  // namespace lanthorn::obj_test
