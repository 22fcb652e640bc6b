// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "shape/displacement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

namespace lanthorn {

namespace {

using description::TriangleMesh;
using Corners = std::array<std::uint32_t, 3>;

constexpr double most_triangles = 1 << 24;

template <class T>
void append_middle(std::vector<T>& values, std::uint32_t a, std::uint32_t b) {
  if (!values.empty()) values.push_back(0.5f * (values[a] + values[b]));
}

Error too_short(const SourceLocation& location) {
  return {location, "the edge length of the displacement is too short for single precision, this far from the origin"};
}

// One round of splitting every edge that is too long at its middle. Both triangles of an edge share the new vertex.
class Splitter {
 public:
  Splitter(TriangleMesh& mesh, float edge_length, const Transform& to_world, const SourceLocation& location)
      : mesh_(mesh), longest2_(edge_length * edge_length), to_world_(to_world), location_(location) {}

  /// Returns true if any edge was split.
  bool split() {
    std::vector<Corners> result;
    result.reserve(mesh_.triangles.size());
    for (const Corners& c : mesh_.triangles) split(c, result);
    mesh_.triangles = std::move(result);
    return !middles_.empty();
  }

 private:
  static constexpr std::uint32_t none = 0xffffffff;

  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    if (distance_squared(to_world_.point(mesh_.positions[a]), to_world_.point(mesh_.positions[b])) <= longest2_)
      return none;
    const std::uint64_t key = (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
    const auto [it, is_new] = middles_.emplace(key, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (is_new) {
      append_middle(mesh_.positions, a, b);
      const Point& added = mesh_.positions.back();  // rounded to an end: splitting it would never end
      if (added == mesh_.positions[a] || added == mesh_.positions[b]) throw too_short(location_);
      append_middle(mesh_.normals, a, b);
      append_middle(mesh_.uvs, a, b);
    }
    return it->second;
  }

  void split(Corners c, std::vector<Corners>& result) {
    std::array<std::uint32_t, 3> m{middle(c[0], c[1]), middle(c[1], c[2]), middle(c[2], c[0])};
    const auto count = std::count_if(m.begin(), m.end(), [](std::uint32_t i) { return i != none; });
    // Rotates the corners so that edge 0 is split and, if two edges are split, edge 2 is not.
    while (count > 0 && (m[0] == none || (count == 2 && m[1] == none))) {
      std::rotate(m.begin(), m.begin() + 1, m.end());
      std::rotate(c.begin(), c.begin() + 1, c.end());
    }
    switch (count) {
      case 0:
        result.push_back(c);
        break;
      case 1:
        result.insert(result.end(), {{c[0], m[0], c[2]}, {m[0], c[1], c[2]}});
        break;
      case 2:
        result.insert(result.end(), {{c[0], m[0], c[2]}, {m[0], m[1], c[2]}, {m[0], c[1], m[1]}});
        break;
      default:
        result.insert(result.end(), {{c[0], m[0], m[2]}, {m[0], c[1], m[1]}, {m[2], m[1], c[2]}, {m[0], m[1], m[2]}});
    }
  }

  TriangleMesh& mesh_;
  float longest2_;
  const Transform& to_world_;
  const SourceLocation& location_;
  std::unordered_map<std::uint64_t, std::uint32_t> middles_;
};

// For each vertex, the area-weighted sum of its faces' normals; not normalised.
std::vector<Normal> normals_of_faces(const TriangleMesh& mesh) {
  std::vector<Normal> sums(mesh.positions.size(), Normal(0));
  for (const Corners& c : mesh.triangles) {
    const Point &p0 = mesh.positions[c[0]], &p1 = mesh.positions[c[1]], &p2 = mesh.positions[c[2]];
    const Normal n = cross(p1 - p0, p2 - p0);
    for (const std::uint32_t corner : c) sums[corner] += n;
  }
  return sums;
}

// Lower bound of the number of triangles after splitting. Equilateral triangles with the longest allowed edge cover the
// most area; needles are cut along their length.
double least_triangles(const TriangleMesh& mesh, float edge_length, const Transform& to_world) {
  const auto length = static_cast<double>(edge_length);
  double sum = 0;
  for (const Corners& c : mesh.triangles) {
    const Point p0 = to_world.point(mesh.positions[c[0]]), p1 = to_world.point(mesh.positions[c[1]]),
                p2 = to_world.point(mesh.positions[c[2]]);
    const double area = 0.5 * std::sqrt(static_cast<double>(length_squared(cross(p1 - p0, p2 - p0))));
    const double longest = std::sqrt(
        static_cast<double>(std::max({distance_squared(p0, p1), distance_squared(p1, p2), distance_squared(p2, p0)})));
    sum += std::max(area / (std::sqrt(3.0) / 4 * length * length), longest / length);
  }
  return sum;
}

// The distance in world space between neighbouring floats where the mesh is farthest from the origin.
float spacing_of_floats(const TriangleMesh& mesh, const Transform& to_world) {
  float farthest = 0;
  for (const Point& p : mesh.positions) farthest = std::max(farthest, max_component(abs(to_world.point(p))));
  return farthest * 0x1p-23f;
}

void check_corners(const TriangleMesh& mesh, const SourceLocation& location) {
  for (const Corners& c : mesh.triangles)
    if (std::max({c[0], c[1], c[2]}) >= mesh.positions.size())
      throw Error(location, "the mesh has a face whose vertex does not exist");
}

}  // namespace

TriangleMesh triangulated(description::BilinearMesh mesh) {
  TriangleMesh result{std::move(mesh.positions), std::move(mesh.normals), {}, std::move(mesh.uvs), {}};
  result.triangles.reserve(2 * mesh.patches.size());
  for (const auto& [p00, p10, p01, p11] : mesh.patches)
    result.triangles.insert(result.triangles.end(), {{p00, p10, p11}, {p00, p11, p01}});
  return result;
}

double least_displaced_triangles(const description::Shape& shape) {
  const auto* quads = std::get_if<description::BilinearMesh>(&shape.geometry);
  const auto* triangles = std::get_if<TriangleMesh>(&shape.geometry);
  if (quads == nullptr && triangles == nullptr) return 0;
  const TriangleMesh mesh = quads != nullptr ? triangulated(*quads) : *triangles;
  check_corners(mesh, shape.location);
  return least_triangles(mesh, shape.displacement->edge_length, shape.object_to_world.start);
}

TriangleMesh displaced(TriangleMesh mesh, float edge_length, const Transform& to_world,
                       const std::function<float(const TexturePoint&)>& height, const SourceLocation& location) {
  check_corners(mesh, location);
  if (!(least_triangles(mesh, edge_length, to_world) < most_triangles))
    throw Error(location, "displacement with this edge length makes more than 16 million triangles");
  mesh.tangents.clear();
  mesh.colors.clear();
  if (edge_length < spacing_of_floats(mesh, to_world)) throw too_short(location);
  while (Splitter(mesh, edge_length, to_world, location).split())
    if (static_cast<double>(mesh.triangles.size()) >= 4 * most_triangles)
      throw Error(location, "displacement with this edge length makes more than 64 million triangles");
  if (mesh.normals.empty()) mesh.normals = normals_of_faces(mesh);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Normal& n = mesh.normals[i];
    if (!(length_squared(n) > 0)) continue;
    const Vec2 uv = mesh.uvs.empty() ? Vec2(0) : mesh.uvs[i];
    const Normal in_world = normalize(to_world.normal(n));
    mesh.positions[i] += height({to_world.point(mesh.positions[i]), in_world, uv}) * normalize(n);
  }
  std::vector<Normal> normals = normals_of_faces(mesh);
  // Keeps the side that was outside.
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (dot(normals[i], mesh.normals[i]) < 0) normals[i] = -normals[i];
  mesh.normals = std::move(normals);
  return mesh;
}

}  // namespace lanthorn
