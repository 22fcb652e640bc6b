// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "lanthorn/scene.h"
#include "math/vec.h"

namespace lanthorn {

namespace {

using Corners = std::array<Vec3, 3>;

std::vector<Corners> triangles_of(const description::Shape& shape) {
  std::vector<Corners> result;
  if (const auto* mesh = std::get_if<description::TriangleMesh>(&shape.geometry))
    for (const auto& [a, b, c] : mesh->triangles)
      result.push_back({mesh->positions[a], mesh->positions[b], mesh->positions[c]});
  if (const auto* mesh = std::get_if<description::BilinearMesh>(&shape.geometry))
    for (const auto& [a, b, c, d] : mesh->patches) {
      result.push_back({mesh->positions[a], mesh->positions[b], mesh->positions[c]});
      result.push_back({mesh->positions[b], mesh->positions[d], mesh->positions[c]});
    }
  return result;
}

Vec3 area_vector(const Corners& t) { return 0.5f * cross(t[1] - t[0], t[2] - t[0]); }

// A closed sheet, such as a box: nine tenths of its area lie in two parallel planes, which are closer to each other
// than a tenth of their extent. A single plane may be the surface of water.
bool is_flat_slab(std::span<const Corners> triangles) {
  if (triangles.empty()) return false;
  const auto area = [](const Corners& t) { return std::sqrt(length_squared(area_vector(t))); };
  const Corners& largest = *std::max_element(triangles.begin(), triangles.end(),
                                             [&](const Corners& a, const Corners& b) { return area(a) < area(b); });
  if (!(area(largest) > 0)) return false;
  const Vec3 axis = area_vector(largest) / area(largest);
  float low = infinity, high = -infinity, parallel = 0, all = 0;
  Bounds bounds;
  for (const Corners& t : triangles) {
    for (const Vec3& p : t) {
      low = std::fmin(low, dot(p, axis));
      high = std::fmax(high, dot(p, axis));
      bounds.extend(p);
    }
    all += area(t);
    if (std::fabs(dot(area_vector(t), axis)) > 0.999f * area(t)) parallel += area(t);
  }
  const Vec3 extent = bounds.extent();
  const float thickness = high - low, size = max_component(extent);
  return parallel > 0.9f * all && thickness > 1e-6f * size && thickness < 0.1f * std::sqrt(0.5f * parallel);
}

bool is_zero(const description::FloatParameter& x) { return !x.texture && x.value == 0; }
bool is_smooth(const description::Roughness& roughness) { return is_zero(roughness.u) && is_zero(roughness.v); }
bool is_colourless(const description::SpectrumParameter& tint) {
  const float* value = std::get_if<float>(&tint.value);
  return !tint.texture && value != nullptr && *value == 1;
}

// The pane that a shape of this material is, if it is one.
std::optional<description::Pane> pane_of(const description::Shape& shape, const description::Material& material) {
  if (material.normal_map || material.displacement || material.interior || shape.area_light ||
      shape.inside_medium != shape.outside_medium)
    return {};
  if (const auto* thin = std::get_if<description::ThinDielectricMaterial>(&material.node))
    if (const float* eta = std::get_if<float>(&thin->eta))
      if (is_smooth(thin->roughness) && is_colourless(thin->tint)) return description::Pane{*eta, true};
  if (const auto* glass = std::get_if<description::DielectricMaterial>(&material.node))
    if (const float* eta = std::get_if<float>(&glass->eta))
      if (is_smooth(glass->roughness) && is_flat_slab(triangles_of(shape))) return description::Pane{*eta, false};
  return {};
}

}  // namespace

std::size_t replace_window_glass(SceneDescription& scene) {
  std::size_t count = 0;
  const auto mirror = static_cast<description::Index>(scene.materials.size());
  const auto replace = [&](std::vector<description::Shape>& shapes) {
    for (description::Shape& shape : shapes) {
      shape.pane = pane_of(shape, scene.materials[shape.material]);
      if (!shape.pane) continue;
      shape.material = mirror;
      ++count;
    }
  };
  replace(scene.shapes);
  for (description::Object& object : scene.objects) replace(object.shapes);
  if (count == 0) return 0;
  description::ConductorMaterial perfect;
  perfect.reflectance = description::SpectrumParameter{1.0f, {}};
  scene.materials.emplace_back().node = perfect;
  return count;
}

}  // namespace lanthorn
