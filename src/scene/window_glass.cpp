// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lanthorn/scene.h"
#include "math/vec.h"

namespace lanthorn {

namespace {

using Corners = std::array<Vec3, 3>;

// The triangles in the space around the shape.
std::vector<Corners> triangles_of(const description::Shape& shape) {
  std::vector<Corners> result;
  const Transform& to_space = shape.object_to_world.start;
  const auto add = [&](const std::vector<Point>& positions, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    result.push_back({to_space.point(positions[a]), to_space.point(positions[b]), to_space.point(positions[c])});
  };
  if (const auto* mesh = std::get_if<description::TriangleMesh>(&shape.geometry))
    for (const auto& [a, b, c] : mesh->triangles) add(mesh->positions, a, b, c);
  if (const auto* mesh = std::get_if<description::BilinearMesh>(&shape.geometry))
    for (const auto& [a, b, c, d] : mesh->patches) {
      add(mesh->positions, a, b, c);
      add(mesh->positions, b, d, c);
    }
  return result;
}

Vec3 area_vector(const Corners& t) { return 0.5f * cross(t[1] - t[0], t[2] - t[0]); }
float area_of(const Corners& t) { return std::sqrt(length_squared(area_vector(t))); }

// A closed sheet, such as a box, or its two faces alone: nine tenths of the area lie in two parallel planes, which are
// closer to each other than a tenth of their extent. A single plane may be the surface of water.
bool is_flat_slab(std::span<const Corners> triangles) {
  if (triangles.empty()) return false;
  const Corners& largest = *std::max_element(
      triangles.begin(), triangles.end(), [&](const Corners& a, const Corners& b) { return area_of(a) < area_of(b); });
  if (!(area_of(largest) > 0)) return false;
  const Vec3 axis = area_vector(largest) / area_of(largest);
  float low = infinity, high = -infinity, parallel = 0, all = 0;
  Bounds bounds;
  for (const Corners& t : triangles) {
    for (const Vec3& p : t) {
      low = std::fmin(low, dot(p, axis));
      high = std::fmax(high, dot(p, axis));
      bounds.extend(p);
    }
    all += area_of(t);
    if (std::fabs(dot(area_vector(t), axis)) > 0.999f * area_of(t)) parallel += area_of(t);
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

// The glass of a shape, if it is glass.
struct Glass {
  description::Pane pane;
  std::string_view flaw{};  // why a pane of it cannot let all rays pass straight; empty if it can
};

std::string_view flaw_of(const description::Roughness& roughness, const description::SpectrumParameter& tint,
                         bool has_film) {
  if (!is_smooth(roughness)) return "is rough";
  if (!is_colourless(tint)) return "is tinted";
  return has_film ? "has a thin film" : "";
}

std::optional<Glass> glass_of(const description::Shape& shape, const description::Material& material) {
  Glass glass;
  const description::SpectrumValue* eta = nullptr;
  const auto take = [&](const auto& dielectric, bool thin) {
    eta = &dielectric.eta;
    glass.pane.thin = thin;
    glass.flaw = flaw_of(dielectric.roughness, dielectric.tint, dielectric.film.has_value());
  };
  if (const auto* thin = std::get_if<description::ThinDielectricMaterial>(&material.node)) take(*thin, true);
  if (const auto* solid = std::get_if<description::DielectricMaterial>(&material.node)) take(*solid, false);
  if (eta == nullptr) return {};
  if (const float* constant = std::get_if<float>(eta))
    glass.pane.eta = *constant;
  else
    glass.flaw = "has dispersion";
  if (material.interior || shape.inside_medium != shape.outside_medium) glass.flaw = "has a medium inside";
  if (material.normal_map || material.displacement) glass.flaw = "has a relief";
  if (shape.area_light) glass.flaw = "emits light";
  return glass;
}

/// A shape of glass that may be one of a pane's two faces.
struct Face {
  static constexpr float alike = 0.1f;

  std::size_t shape = 0;
  Glass glass;
  std::vector<Corners> triangles;
  Point centre{0};
  float area = 0;

  Face(std::size_t number, const Glass& its_glass, std::vector<Corners> corners)
      : shape(number), glass(its_glass), triangles(std::move(corners)) {
    Bounds bounds;
    for (const Corners& t : triangles) {
      area += area_of(t);
      for (const Vec3& p : t) bounds.extend(p);
    }
    centre = bounds.centre();
  }
  /// Squared distance from this face's centre within which the other face's centre must lie, m².
  float reach2() const { return sqr(alike) * area; }
  bool makes_slab_with(const Face& other) const {
    if (glass.pane.eta != other.glass.pane.eta || glass.flaw != other.glass.flaw) return false;
    if (std::fabs(area - other.area) > alike * area) return false;
    if (distance_squared(centre, other.centre) > reach2()) return false;
    std::vector<Corners> both = triangles;
    both.insert(both.end(), other.triangles.begin(), other.triangles.end());
    return is_flat_slab(both);
  }
};

// The glass of the panes among the shapes, by shape: sheets of thin glass, slabs, and pairs of faces.
std::vector<std::optional<Glass>> find_panes(const std::vector<description::Shape>& shapes,
                                             const std::vector<description::Material>& materials) {
  std::vector<std::optional<Glass>> panes(shapes.size());
  std::vector<Face> faces;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const std::optional<Glass> glass = glass_of(shapes[i], materials[shapes[i].material]);
    if (!glass) continue;
    std::vector<Corners> triangles;
    if (!glass->pane.thin) triangles = triangles_of(shapes[i]);
    if (glass->pane.thin || is_flat_slab(triangles))
      panes[i] = glass;
    else if (!triangles.empty() && !shapes[i].object_to_world.is_moving())
      faces.emplace_back(i, *glass, std::move(triangles));
  }
  // Sorted by centre, so that only neighbours are compared: testing all pairs would take too long with many glass
  // shapes.
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.centre.x < b.centre.x; });
  for (std::size_t a = 0; a < faces.size(); ++a)
    for (std::size_t b = a + 1; b < faces.size() && sqr(faces[b].centre.x - faces[a].centre.x) <= faces[a].reach2();
         ++b)
      if (faces[a].makes_slab_with(faces[b])) panes[faces[a].shape] = panes[faces[b].shape] = faces[a].glass;
  return panes;
}

// Panes that stay as they are, by what their glass has against it.
struct Leftovers {
  struct Kind {
    std::string_view flaw;
    std::size_t shapes;
    SourceLocation first;
  };
  std::vector<Kind> kinds;

  void add(std::string_view flaw, const SourceLocation& location) {
    for (Kind& kind : kinds)
      if (kind.flaw == flaw) {
        ++kind.shapes;
        return;
      }
    kinds.push_back({flaw, 1, location});
  }
  void warn(SceneDescription& scene) const {
    for (const Kind& kind : kinds)
      scene.warnings.push_back(
          {kind.first, fmt::format("--window-glass: {} as before, because {} glass {}; only panes of clear, smooth "
                                   "glass let all rays pass. Methods with photons find the light behind the others",
                                   kind.shapes == 1 ? "this pane stays" : fmt::format("{} panes stay", kind.shapes),
                                   kind.shapes == 1 ? "its" : "their", kind.flaw)});
  }
};

}  // namespace

std::size_t replace_window_glass(SceneDescription& scene) {
  std::size_t count = 0;
  Leftovers left;
  const auto mirror = static_cast<description::Index>(scene.materials.size());
  const auto replace = [&](std::vector<description::Shape>& shapes) {
    const std::vector<std::optional<Glass>> panes = find_panes(shapes, scene.materials);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      shapes[i].pane.reset();
      if (!panes[i]) continue;
      if (!panes[i]->flaw.empty()) {
        left.add(panes[i]->flaw, shapes[i].location);
        continue;
      }
      shapes[i].pane = panes[i]->pane;
      shapes[i].material = mirror;
      ++count;
    }
  };
  replace(scene.shapes.edit());
  for (description::Object& object : scene.objects) replace(object.shapes);
  left.warn(scene);
  if (count == 0) return 0;
  description::ConductorMaterial perfect;
  perfect.reflectance = description::SpectrumParameter{1.0f, {}};
  scene.materials.emplace_back().node = perfect;
  return count;
}

}  // namespace lanthorn
