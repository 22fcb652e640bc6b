// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The scene's shapes as triangles.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "lanthorn/scene.h"
#include "scene/scene_data.h"
#include "shape/curves.h"

namespace lanthorn {

namespace {

using Kind = GeometryRecord::Kind;

constexpr std::uint32_t segments_around = 64, segments_along = 32, patch_squares = 8;

// The vertices of a grid of squares, and their triangles: counter-clockwise where v grows to the left of u.
template <class AddVertex>
void add_grid(SceneMesh& mesh, std::uint32_t columns, std::uint32_t rows, AddVertex&& add_vertex) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t y = 0; y <= rows; ++y)
    for (std::uint32_t x = 0; x <= columns; ++x)
      add_vertex(static_cast<double>(x) / columns, static_cast<double>(y) / rows);
  for (std::uint32_t y = 0; y < rows; ++y)
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t i = first + y * (columns + 1) + x, above = i + columns + 1;
      mesh.triangles.push_back({i, i + 1, above + 1});
      mesh.triangles.push_back({i, above + 1, above});
    }
}

// A point of the quadric's surface in its object space, at shares u of the angle and v of the height or radius.
DVec3 object_point(const Quadric& q, double u, double v) {
  const double phi = u * q.phi_max;
  double z = q.z_min, r = q.radius;
  switch (q.kind) {
    case Quadric::Kind::sphere: {
      const double low = std::asin(std::clamp(q.z_min / q.radius, -1.0, 1.0));
      const double high = std::asin(std::clamp(q.z_max / q.radius, -1.0, 1.0));
      const double latitude = low + v * (high - low);
      z = q.radius * std::sin(latitude);
      r = q.radius * std::cos(latitude);
      break;
    }
    case Quadric::Kind::cylinder:
      z = q.z_min + v * (q.z_max - q.z_min);
      break;
    case Quadric::Kind::disk:
      r = q.radius + v * (q.inner_radius - q.radius);
      break;
  }
  return {r * std::cos(phi), r * std::sin(phi), z};
}

void add_quadric(SceneMesh& mesh, const Quadric& q) {
  add_grid(mesh, segments_around, segments_along, [&](double u, double v) {
    const DVec3 near = q.to_world.point(object_point(q, u, v));
    const QuadricPoint p = evaluate(q, near);
    mesh.positions.emplace_back(p.position);
    mesh.normals.emplace_back(p.normal);
    mesh.uvs.push_back(evaluate_uv(q, near));
  });
}

void add_patch(SceneMesh& mesh, const ShapeStore& shape, std::uint32_t primitive) {
  const Patch patch = shape.patch(primitive);
  const GeometryRecord& record = shape.record;
  add_grid(mesh, patch_squares, patch_squares, [&](double u, double v) {
    const SurfaceGeometry at = evaluate_surface(record, {primitive, static_cast<float>(u), static_cast<float>(v)});
    mesh.positions.emplace_back(patch.position(u, v));
    mesh.normals.push_back(at.shading_normal);
    mesh.uvs.push_back(at.uv);
  });
}

void add_triangles(SceneMesh& mesh, const ShapeStore& shape) {
  mesh.triangles = shape.triangles;
  if (shape.vertices.empty()) {
    mesh.positions.assign(shape.positions.begin(), shape.positions.end() - 1);  // the last one is Embree's
    return;
  }
  for (const Vertex& vertex : shape.vertices) {
    mesh.positions.push_back(vertex.position);
    if (shape.record.has_normals) mesh.normals.push_back(vertex.normal);
    if (shape.record.has_uvs) mesh.uvs.push_back(vertex.uv);
  }
}

void add_curves(SceneMesh& mesh, const description::Curves& curves) {
  description::TriangleMesh tube = triangulated(curves);
  mesh.positions = std::move(tube.positions);
  mesh.normals = std::move(tube.normals);
  mesh.uvs = std::move(tube.uvs);
  mesh.triangles = std::move(tube.triangles);
}

SceneMesh mesh_of(const ShapeStore& shape) {
  const GeometryRecord& record = shape.record;
  SceneMesh mesh;
  mesh.material = record.material;
  mesh.emits = record.emits;
  mesh.location = shape.location;
  switch (record.kind) {
    case Kind::triangles:
      add_triangles(mesh, shape);
      break;
    case Kind::patches:
      for (std::uint32_t i = 0; i < shape.patches.size(); ++i) add_patch(mesh, shape, i);
      break;
    case Kind::quadric:
      add_quadric(mesh, shape.quadric);
      break;
    case Kind::curves:
      add_curves(mesh, shape.curves);
      break;
  }
  // A mirroring map reverses the winding of the grid, but not the natural normal of the quadric.
  const bool reversed = record.kind == Kind::quadric && glm::determinant(shape.quadric.to_world.linear) < 0;
  if (record.flip_normal != reversed)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

// Placements are products of two maps.
Transform at_opening(const PlacedGroup& placed, float shutter_open) {
  return placed.outer.at(shutter_open) * placed.inner.at(shutter_open);
}

}  // namespace

SceneModel model_of(const Scene& scene) {
  const SceneData& data = *scene.data();
  SceneModel model;
  const auto add = [&](const std::vector<std::unique_ptr<ShapeStore>>& shapes) {
    for (const auto& shape : shapes) model.meshes.push_back(mesh_of(*shape));
  };
  add(data.geometry->shapes());
  if (!model.meshes.empty()) model.instances.push_back({0, model.meshes.size(), {}, {}, {}});
  std::vector<std::pair<std::size_t, std::size_t>> groups;  // first mesh and number
  for (const auto& group : data.geometry->groups()) {
    groups.emplace_back(model.meshes.size(), group.size());
    add(group);
  }
  for (const PlacedInstance& p : *data.placed) {
    const auto& [first, count] = groups[p.placed.group];
    std::string object =
        p.instance ? data.description.objects[data.description.instances[*p.instance].object].name : "";
    model.instances.push_back(
        {first, count, at_opening(p.placed, data.description.view.camera.shutter_open), std::move(object), p.instance});
  }
  return model;
}

}  // namespace lanthorn
