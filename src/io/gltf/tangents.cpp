// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/tangents.h"

#include <cmath>

#include "math/vec.h"

namespace lanthorn::gltf {

namespace {

using namespace description;

// Tangents along u, with w the side of the bitangent; averages over the triangles at each vertex.
std::vector<glm::vec4> tangents_along_u(const TriangleMesh& mesh) {
  std::vector<Vec3> along_u(mesh.positions.size(), Vec3(0)), along_t = along_u;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 edge1 = mesh.positions[b] - mesh.positions[a], edge2 = mesh.positions[c] - mesh.positions[a];
    const Vec2 st1 = mesh.uvs[b] - mesh.uvs[a], st2 = mesh.uvs[c] - mesh.uvs[a];
    const float determinant = st1.x * st2.y - st1.y * st2.x;
    if (determinant == 0) continue;
    for (const std::uint32_t corner : {a, b, c}) {
      along_u[corner] += (st2.y * edge1 - st1.y * edge2) / determinant;
      along_t[corner] += (st1.x * edge2 - st2.x * edge1) / determinant;
    }
  }
  std::vector<glm::vec4> result;
  for (std::size_t i = 0; i < along_u.size(); ++i)
    result.emplace_back(along_u[i], dot(cross(mesh.normals[i], along_u[i]), along_t[i]) < 0 ? -1 : 1);
  return result;
}

}  // namespace

void set_tangents(TriangleMesh& mesh, std::vector<glm::vec4> tangents, float turn) {
  mesh.tangents.assign(tangents.begin(), tangents.end());
  if (turn == 0 || mesh.normals.empty()) return;
  if (tangents.empty() && !mesh.uvs.empty()) tangents = tangents_along_u(mesh);
  mesh.tangents.resize(tangents.size());
  for (std::size_t i = 0; i < tangents.size(); ++i) {
    const Vec3 tangent(tangents[i]), bitangent = tangents[i].w * cross(mesh.normals[i], tangent);
    mesh.tangents[i] = std::cos(turn) * tangent + std::sin(turn) * bitangent;
  }
}

}  // namespace lanthorn::gltf
