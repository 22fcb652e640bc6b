// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/meshes.h"

#include <cmath>

#include "math/frame.h"
#include "math/vec.h"

namespace lanthorn::gltf {

namespace {

using description::TriangleMesh;

class Thickener {
 public:
  Thickener(const TriangleMesh& vertices, const Transform& place, float radius)
      : from_(vertices), place_(place), radius_(radius) {}

  void add_point(std::uint32_t i) {
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    for (const Vec3& axis :
         {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)})
      add_vertex(i, axis);
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t a = first + k, b = first + (k + 1) % 4;
      result.triangles.push_back({a, b, first + 4});
      result.triangles.push_back({b, a, first + 5});
    }
  }

  void add_line(std::uint32_t i, std::uint32_t j) {
    constexpr std::uint32_t sides = 6;
    const Vec3 along = place_.point(from_.positions[j]) - place_.point(from_.positions[i]);
    const float length2 = length_squared(along);
    if (!(length2 > 0) || !std::isfinite(length2)) return add_point(i);
    const Frame frame(along / std::sqrt(length2));
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    for (std::uint32_t k = 0; k < sides; ++k) {
      const float angle = 2 * pi * static_cast<float>(k) / sides;
      const Vec3 outwards = frame.to_world({std::cos(angle), std::sin(angle), 0});
      add_vertex(i, outwards);
      add_vertex(j, outwards);
    }
    for (std::uint32_t k = 0; k < sides; ++k) {
      const std::uint32_t a = first + 2 * k, b = first + 2 * ((k + 1) % sides);
      result.triangles.push_back({a, b, b + 1});
      result.triangles.push_back({a, b + 1, a + 1});
    }
  }

  TriangleMesh result;

 private:
  void add_vertex(std::uint32_t i, const Vec3& outwards) {
    result.positions.push_back(place_.point(from_.positions[i]) + radius_ * outwards);
    result.normals.push_back(outwards);
    if (!from_.uvs.empty()) result.uvs.push_back(from_.uvs[i]);
    if (!from_.colors.empty()) result.colors.push_back(from_.colors[i]);
  }

  const TriangleMesh& from_;
  const Transform& place_;
  float radius_;
};

}  // namespace

TriangleMesh thickened(const TriangleMesh& vertices, const Strokes& strokes, const Transform& place, float radius) {
  Thickener thickener(vertices, place, radius);
  for (const auto& [i, j] : strokes) {
    if (i == j)
      thickener.add_point(i);
    else
      thickener.add_line(i, j);
  }
  return std::move(thickener.result);
}

}  // namespace lanthorn::gltf
