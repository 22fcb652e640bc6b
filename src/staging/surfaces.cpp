// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "staging/surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>
#include <variant>

#include "math/hash.h"
#include "math/vec.h"

namespace lanthorn {

namespace {

using namespace description;

struct Corners {
  std::array<glm::dvec3, 3> at;

  Corners(const TriangleMesh& mesh, std::size_t triangle, const Transform& place) {
    for (std::size_t k = 0; k < 3; ++k) at[k] = place.point(mesh.positions[mesh.triangles[triangle][k]]);
  }
  glm::dvec3 twice_area_normal() const { return glm::cross(at[1] - at[0], at[2] - at[0]); }
};

// The index of the first running sum that exceeds `x`.
std::size_t find(const std::vector<double>& cumulative, double x) {
  const auto found = std::upper_bound(cumulative.begin(), cumulative.end(), x);
  return std::min(static_cast<std::size_t>(found - cumulative.begin()), cumulative.size() - 1);
}

struct PlaceHash {
  std::size_t operator()(const Point& p) const { return hash_vec(p); }
};

double before(const std::vector<double>& cumulative, std::size_t i) { return i == 0 ? 0 : cumulative[i - 1]; }

// Extends each box by the mesh in that box's space.
void extend(std::span<Bounds> bounds, const Shape& shape, std::span<const Transform> to_spaces) {
  const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
  if (mesh == nullptr) return;
  std::vector<Transform> places;
  for (const Transform& to_space : to_spaces) places.push_back(to_space * shape.object_to_world.start);
  for (const Point& p : mesh->positions)
    for (std::size_t i = 0; i < places.size(); ++i) bounds[i].extend(places[i].point(p));
}

}  // namespace

std::vector<Bounds> bounds_of(const SceneDescription& scene, std::span<const Transform> from_world) {
  std::vector<Bounds> bounds(from_world.size());
  for (const Shape& shape : scene.shapes) extend(bounds, shape, from_world);
  std::vector<Bounds> objects(scene.objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i)
    for (const Bounds& shape : bounds_of(scene.objects[i].shapes)) objects[i].extend(shape);
  for (const Instance& instance : scene.instances)
    if (const Bounds& object = objects[instance.object]; !object.empty())
      for (std::size_t i = 0; i < bounds.size(); ++i)
        bounds[i].extend((from_world[i] * instance.object_to_world.start).bounds(object));
  return bounds;
}

std::vector<Bounds> bounds_of(const std::vector<Shape>& shapes) {
  std::vector<Bounds> bounds(shapes.size());
  const std::array own_space{Transform()};
  for (std::size_t i = 0; i < shapes.size(); ++i) extend({&bounds[i], 1}, shapes[i], own_space);
  return bounds;
}

std::vector<Part> parts_of(const SceneDescription& scene) {
  std::vector<Part> parts;
  const std::vector<Bounds> shapes = bounds_of(scene.shapes);
  for (std::size_t i = 0; i < shapes.size(); ++i) parts.push_back({shapes[i], i, false});
  std::vector<Bounds> objects(scene.objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i)
    for (const Bounds& box : bounds_of(scene.objects[i].shapes)) objects[i].extend(box);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Bounds& object = objects[scene.instances[i].object];
    if (!object.empty()) parts.push_back({scene.instances[i].object_to_world.start.bounds(object), i, true});
  }
  std::erase_if(parts, [](const Part& part) { return part.box.empty(); });
  return parts;
}

Bounds bounds_of(const SceneDescription& scene, const Transform& from_world) {
  return bounds_of(scene, std::array{from_world}).front();
}

Surfaces::Group Surfaces::make_group(const std::vector<Shape>& shapes, const std::set<Index>* lights) {
  Group group;
  double sum = 0;
  for (const Shape& shape : shapes) {
    const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
    if (mesh == nullptr || mesh->triangles.empty()) continue;
    if (lights != nullptr && (!shape.area_light || lights->count(*shape.area_light) == 0)) continue;
    Piece piece{mesh, shape.material, shape.area_light, shape.object_to_world.start, {}};
    piece.cumulative.reserve(mesh->triangles.size());
    double own = 0;
    for (std::size_t i = 0; i < mesh->triangles.size(); ++i) {
      const double area = glm::length(Corners(*mesh, i, piece.place).twice_area_normal()) / 2;
      if (std::isfinite(area)) own += area;
      piece.cumulative.push_back(own);
    }
    sum += own;
    if (shape.area_light) group.emitting.emplace_back(*shape.area_light, own);
    group.pieces.push_back(std::move(piece));
    group.cumulative.push_back(sum);
  }
  return group;
}

void Surfaces::place(std::size_t group, const Transform& to_world) {
  const Group& g = groups_[group];
  const double stretch = std::pow(std::fabs(glm::determinant(DMat3(to_world.matrix))), 2.0 / 3);
  if (g.cumulative.empty() || !std::isfinite(stretch)) return;
  placed_.push_back({group, to_world, stretch});
  cumulative_.push_back(area() + stretch * g.cumulative.back());
  for (const auto& [light, emitting] : g.emitting) emitting_[light] += stretch * emitting;
}

Surfaces::Surfaces(const SceneDescription& scene, const std::set<Index>* area_lights)
    : emitting_(scene.area_lights.size()) {
  groups_.push_back(make_group(scene.shapes, area_lights));
  for (const Object& object : scene.objects) groups_.push_back(make_group(object.shapes, area_lights));
  place(0, {});
  for (const Instance& instance : scene.instances) place(instance.object + 1, instance.object_to_world.start);
}

Surfaces::Sample Surfaces::sample(std::size_t placed_index, double area, const Vec2& u) const {
  const Placed& placed = placed_[placed_index];
  const Group& group = groups_[placed.group];
  const std::size_t p = find(group.cumulative, area);
  const Piece& piece = group.pieces[p];
  const std::size_t triangle = find(piece.cumulative, area - before(group.cumulative, p));
  const Transform to_world = placed.to_world * piece.place;
  const Corners corners(*piece.mesh, triangle, to_world);
  const double root = std::sqrt(static_cast<double>(u.x)), v = static_cast<double>(u.y);
  const glm::dvec3 position = (1 - root) * corners.at[0] + root * (1 - v) * corners.at[1] + root * v * corners.at[2];
  const glm::dvec3 normal = corners.twice_area_normal();
  const double length = glm::length(normal);
  const double outside = to_world.swaps_handedness() ? -1 : 1;
  return {Point(position), length > 0 ? Normal(outside / length * normal) : Normal(0),
          piece.material,  piece.area_light,
          placed_index,    p,
          triangle};
}

std::vector<Surfaces::Sample> Surfaces::samples(std::size_t count) const {
  std::vector<Sample> result;
  if (!(area() > 0) || !std::isfinite(area())) return result;
  result.reserve(count);
  const double step = area() / static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double at = (static_cast<double>(i) + 0.5) * step;
    const std::size_t p = find(cumulative_, at);
    // Low-discrepancy additive recurrence (Roberts 2018): powers of the inverse of the plastic number.
    const auto fraction = [&](double a) {
      const double x = static_cast<double>(i) * a;
      return static_cast<float>(x - std::floor(x));
    };
    const Sample s = sample(p, (at - before(cumulative_, p)) / placed_[p].stretch,
                            {fraction(0.7548776662466927), fraction(0.5698402909980532)});
    if (std::isfinite(s.position.x + s.position.y + s.position.z)) result.push_back(s);
  }
  return result;
}

std::vector<std::vector<std::uint32_t>> Surfaces::meshes_in(const Group& group) {
  constexpr std::size_t most_vertices = std::size_t{1} << 22;
  std::size_t count = 0;
  for (const Piece& piece : group.pieces) count += piece.mesh->positions.size();
  // Union-find over vertices: one set per mesh.
  std::vector<std::uint32_t> joined;
  const auto root = [&](std::size_t i) {
    while (joined[i] != i) i = joined[i] = joined[joined[i]];
    return static_cast<std::uint32_t>(i);
  };
  std::unordered_map<Point, std::uint32_t, PlaceHash> first_at;
  std::vector<std::vector<std::uint32_t>> meshes;
  for (const Piece& piece : group.pieces) {
    const std::vector<std::array<std::uint32_t, 3>>& triangles = piece.mesh->triangles;
    std::vector<std::uint32_t>& of_triangles = meshes.emplace_back();
    if (count > most_vertices) {
      of_triangles.assign(triangles.size(), static_cast<std::uint32_t>(meshes.size()));
      continue;
    }
    const std::size_t base = joined.size();
    for (const Point& p : piece.mesh->positions)
      joined.push_back(first_at.try_emplace(piece.place.point(p) + 0.0f, joined.size()).first->second);
    for (const auto& [a, b, c] : triangles)
      for (const std::size_t other : {b, c}) joined[root(base + other)] = root(base + a);
    for (const auto& triangle : triangles) of_triangles.push_back(static_cast<std::uint32_t>(base) + triangle[0]);
  }
  if (!joined.empty())
    for (std::vector<std::uint32_t>& of_triangles : meshes)
      for (std::uint32_t& mesh : of_triangles) mesh = root(mesh);
  return meshes;
}

std::vector<std::uint32_t> Surfaces::meshes_of(const std::vector<Sample>& samples) const {
  std::map<std::size_t, std::vector<std::vector<std::uint32_t>>> groups;
  std::map<std::pair<std::size_t, std::uint32_t>, std::uint32_t> numbers;
  std::vector<std::uint32_t> result;
  result.reserve(samples.size());
  for (const Sample& s : samples) {
    const std::size_t group = placed_[s.placed].group;
    auto found = groups.find(group);
    if (found == groups.end()) found = groups.emplace(group, meshes_in(groups_[group])).first;
    const std::pair key(s.placed, found->second[s.piece][s.triangle]);
    result.push_back(numbers.try_emplace(key, numbers.size()).first->second);
  }
  return result;
}

}  // namespace lanthorn
