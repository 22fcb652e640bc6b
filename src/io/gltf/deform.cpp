// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/meshes.h"

#include <algorithm>
#include <glm/matrix.hpp>
#include <string>

#include "io/gltf/accessor.h"

namespace lanthorn::gltf {

namespace {

void add_target(Document& document, const Value& target, const char* name, float weight,
                const std::vector<std::uint32_t>& vertices, std::size_t count, std::vector<Vec3>& values) {
  const auto reference = target.find(name);
  if (!reference || values.empty()) return;
  const Accessor offsets(document, *reference, 3);
  if (offsets.count() != count)
    throw reference->error("has " + std::to_string(offsets.count()) + " elements, but there are " +
                           std::to_string(count) + " positions");
  for (std::size_t i = 0; i < vertices.size(); ++i)
    for (int k = 0; k < 3; ++k) values[i][k] += weight * offsets.number(vertices[i], static_cast<std::size_t>(k));
}

}  // namespace

bool Deformation::is_none() const {
  return joints.empty() && std::all_of(weights.begin(), weights.end(), [](float w) { return w == 0; });
}

void morph(Document& document, const Value& primitive, const std::vector<float>& weights,
           const std::vector<std::uint32_t>& vertices, description::TriangleMesh& mesh) {
  const auto targets = primitive.find_array("targets");
  if (!targets) return;
  const std::size_t count = Accessor(document, primitive.at("attributes").at("POSITION"), 3).count();
  for (std::size_t i = 0; i < std::min(weights.size(), targets->size()); ++i) {
    if (weights[i] == 0) continue;
    const Value target = targets->element(i);
    add_target(document, target, "POSITION", weights[i], vertices, count, mesh.positions);
    add_target(document, target, "NORMAL", weights[i], vertices, count, mesh.normals);
    add_target(document, target, "TANGENT", weights[i], vertices, count, mesh.tangents);
  }
}

Skinning::Skinning(std::span<const glm::dmat4> joints, std::size_t vertices) : joints_(joints), blends_(vertices) {}

void Skinning::add(std::size_t vertex, std::uint32_t joint, float weight, const Value& place) {
  if (!(weight > 0)) return;
  if (joint >= joints_.size())
    throw place.error("vertex " + std::to_string(vertex) + " is bound to joint " + std::to_string(joint) +
                      ", but the skin has " + std::to_string(joints_.size()));
  blends_[vertex].sum += static_cast<double>(weight) * joints_[joint];
  blends_[vertex].weight += static_cast<double>(weight);
}

void Skinning::apply(description::TriangleMesh& mesh) const {
  for (std::size_t i = 0; i < blends_.size(); ++i) {
    if (!(blends_[i].weight > 0)) continue;
    const glm::dmat4 m = blends_[i].sum / blends_[i].weight;
    const glm::dmat3 linear(m);
    mesh.positions[i] = Point(m * glm::dvec4(mesh.positions[i], 1));
    if (!mesh.tangents.empty()) mesh.tangents[i] = Vec3(linear * glm::dvec3(mesh.tangents[i]));
    if (mesh.normals.empty()) continue;
    // The cofactor matrix: the inverse transpose times the determinant; unlike the inverse, singular matrices have it.
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    mesh.normals[i] = Normal(cofactors * glm::dvec3(mesh.normals[i]));
  }
}

}  // namespace lanthorn::gltf
