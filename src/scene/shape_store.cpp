// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// From described shapes to the arrays that Embree and the records read, and the surface that they describe.
#include <algorithm>
#include <cmath>
#include <string>

#include "scene/geometry.h"

namespace lanthorn {

namespace {

using description::BilinearMesh;
using description::TriangleMesh;

template <class Cell>
void check_mesh(const std::vector<Cell>& cells, std::size_t positions, std::size_t normals, std::size_t uvs,
                std::size_t tangents, const SourceLocation& location) {
  const auto check_count = [&](std::size_t count, const char* what) {
    if (count != 0 && count != positions)
      throw Error(location, std::string("the mesh has ") + std::to_string(positions) + " positions but " +
                                std::to_string(count) + " " + what);
  };
  check_count(normals, "normals");
  check_count(uvs, "uvs");
  check_count(tangents, "tangents");
  for (const Cell& cell : cells)
    for (const std::uint32_t corner : cell)
      if (corner >= positions)
        throw Error(location, "the mesh has an index " + std::to_string(corner) + " but only " +
                                  std::to_string(positions) + " positions");
}

void bake_positions(std::vector<Point>& positions, const Transform& t, const SourceLocation& location) {
  const bool identity = t.is_identity();
  const Affine map(t);
  for (Point& p : positions) {
    if (!identity) p = Point(map.point(DVec3(p)));
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw Error(location, "the mesh has a position that is not finite");
  }
  positions.push_back(positions.empty() ? Point(0) : positions.back());  // Embree reads 16 bytes at the last one
}

// As pbrt: normals go with the surface and are turned round by ReverseOrientation.
void bake_normals(std::vector<Normal>& normals, const Transform& t, bool reverse) {
  if (t.is_identity() && !reverse) return;
  const Affine map(t);
  for (Normal& n : normals) {
    n = Normal(map.normal(DVec3(n)));
    if (reverse) n = -n;
  }
}

void link(ShapeStore& store) {
  GeometryRecord& r = store.record;
  r.triangles = store.triangles.empty() ? nullptr : store.triangles.data();
  r.positions = store.positions.empty() ? nullptr : store.positions.data();
  r.normals = store.normals.empty() ? nullptr : store.normals.data();
  r.uvs = store.uvs.empty() ? nullptr : store.uvs.data();
  r.tangents = store.tangents.empty() ? nullptr : store.tangents.data();
  if (r.kind == GeometryRecord::Kind::quadric)
    r.quadric = &store.quadric;
  else
    r.patches = store.patches.empty() ? nullptr : store.patches.data();
}

void take(ShapeStore& store, TriangleMesh& mesh, const Transform& t, bool reverse, const SourceLocation& location) {
  check_mesh(mesh.triangles, mesh.positions.size(), mesh.normals.size(), mesh.uvs.size(), mesh.tangents.size(),
             location);
  store.triangles = std::move(mesh.triangles);
  store.positions = std::move(mesh.positions);
  store.normals = std::move(mesh.normals);
  store.uvs = std::move(mesh.uvs);
  store.tangents = std::move(mesh.tangents);
  bake_positions(store.positions, t, location);
  bake_normals(store.normals, t, reverse);
  if (!t.is_identity()) {
    const Affine map(t);
    for (Vec3& tangent : store.tangents) tangent = Vec3(map.vector(DVec3(tangent)));
  }
  store.record.kind = GeometryRecord::Kind::triangles;
}

bool are_parallelograms(const ShapeStore& store) {
  return store.normals.empty() && store.uvs.empty() &&
         std::all_of(store.patches.begin(), store.patches.end(), [&](const std::array<std::uint32_t, 4>& p) {
           return is_parallelogram(store.positions[p[0]], store.positions[p[1]], store.positions[p[2]],
                                   store.positions[p[3]]);
         });
}

void take(ShapeStore& store, BilinearMesh& mesh, const Transform& t, bool reverse, const SourceLocation& location) {
  check_mesh(mesh.patches, mesh.positions.size(), mesh.normals.size(), mesh.uvs.size(), 0, location);
  store.patches = std::move(mesh.patches);
  store.positions = std::move(mesh.positions);
  store.normals = std::move(mesh.normals);
  store.uvs = std::move(mesh.uvs);
  bake_positions(store.positions, t, location);
  bake_normals(store.normals, t, reverse);
  store.record.kind = GeometryRecord::Kind::patches;
  if (!are_parallelograms(store)) return;
  store.record.kind = GeometryRecord::Kind::triangles;
  store.record.quads = true;
  store.triangles.reserve(2 * store.patches.size());
  for (const auto& [p00, p10, p01, p11] : store.patches) {
    store.triangles.push_back({p00, p10, p11});
    store.triangles.push_back({p00, p11, p01});
  }
}

template <class Shape>
void take(ShapeStore& store, const Shape& shape, const Transform& t, bool, const SourceLocation& location) {
  store.quadric = Quadric::from(shape, t);
  if (!(store.quadric.radius > 0)) throw Error(location, "the radius must be positive");
  store.record.kind = GeometryRecord::Kind::quadric;
}

// Rounds to single precision; the error is that of the rounding and of `slack`.
void set_position(SurfaceGeometry& s, const DVec3& p, double slack) {
  s.position = Point(p);
  s.error = 0x1p-23f * abs(s.position) + Vec3(static_cast<float>(slack));
}

SurfaceGeometry evaluate_quadric(const GeometryRecord& record, const DVec3& near) {
  const QuadricPoint q = evaluate(*record.quadric, near);
  SurfaceGeometry s;
  set_position(s, q.position, rounding_slack(*record.quadric));
  s.normal = Normal(record.flip_normal ? -q.normal : q.normal);
  s.shading_normal = s.normal;
  s.uv = q.uv;
  if (record.wants_tangent) s.tangent = Vec3(q.dpdu);
  return s;
}

// d(position)/ds where (s, t) are given at the corners: the chain rule through (u, v).
DVec3 dpds(const DVec3& dpdu, const DVec3& dpdv, const std::array<Vec2, 4>& st, float u, float v) {
  const glm::dvec2 du = (1.0 - v) * glm::dvec2(st[1] - st[0]) + static_cast<double>(v) * glm::dvec2(st[3] - st[2]);
  const glm::dvec2 dv = (1.0 - u) * glm::dvec2(st[2] - st[0]) + static_cast<double>(u) * glm::dvec2(st[3] - st[1]);
  const double determinant = du.x * dv.y - du.y * dv.x;
  return determinant == 0 ? DVec3(0) : (dv.y * dpdu - du.y * dpdv) / determinant;
}

template <class T>
T bilinear(const T* values, const std::array<std::uint32_t, 4>& c, float u, float v) {
  return (1 - v) * ((1 - u) * values[c[0]] + u * values[c[1]]) + v * ((1 - u) * values[c[2]] + u * values[c[3]]);
}

SurfaceGeometry evaluate_patch(const GeometryRecord& record, std::uint32_t primitive, float u, float v) {
  const std::array<std::uint32_t, 4>& c = record.patches[primitive];
  const Patch patch{DVec3(record.positions[c[0]]), DVec3(record.positions[c[1]]), DVec3(record.positions[c[2]]),
                    DVec3(record.positions[c[3]])};
  SurfaceGeometry s;
  double reach = 0;
  for (const DVec3& p : {patch.p00, patch.p10, patch.p01, patch.p11})
    reach = std::max({reach, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  set_position(s, patch.position(u, v), 0x1p-46 * reach);
  const DVec3 dpdu = patch.dpdu(v);
  const DVec3 dpdv = patch.dpdv(u);
  s.normal = Normal(glm::normalize(glm::cross(dpdu, dpdv)));
  if (record.flip_normal) s.normal = -s.normal;
  s.shading_normal = s.normal;
  if (record.normals != nullptr) {
    const Normal n = bilinear(record.normals, c, u, v);
    if (length_squared(n) > 0) {
      s.shading_normal = normalize(n);
      if (dot(s.normal, s.shading_normal) < 0) s.normal = -s.normal;
    }
  }
  s.uv = record.uvs != nullptr ? bilinear(record.uvs, c, u, v) : Vec2(u, v);
  if (record.wants_tangent) {
    s.tangent = Vec3(dpdu);
    if (record.uvs != nullptr)
      s.tangent =
          Vec3(dpds(dpdu, dpdv, {record.uvs[c[0]], record.uvs[c[1]], record.uvs[c[2]], record.uvs[c[3]]}, u, v));
  }
  return s;
}

template <class T>
std::size_t size_of(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

}  // namespace

std::size_t ShapeStore::primitives() const {
  switch (record.kind) {
    case GeometryRecord::Kind::triangles:
      return triangles.size();
    case GeometryRecord::Kind::patches:
      return patches.size();
    case GeometryRecord::Kind::quadric:
      return 1;
  }
  return 0;
}

std::size_t ShapeStore::bytes() const {
  return size_of(triangles) + size_of(patches) + size_of(positions) + size_of(normals) + size_of(uvs) +
         size_of(tangents) + sizeof(ShapeStore);
}

Patch ShapeStore::patch(std::uint32_t primitive) const {
  const std::array<std::uint32_t, 4>& c = patches[primitive];
  return {DVec3(positions[c[0]]), DVec3(positions[c[1]]), DVec3(positions[c[2]]), DVec3(positions[c[3]])};
}

std::unique_ptr<ShapeStore> make_shape_store(description::Shape& source, const Transform& to_space) {
  if (to_space.is_singular()) throw Error(source.location, "the shape's transformation is singular");
  auto store = std::make_unique<ShapeStore>();
  std::visit([&](auto& shape) { take(*store, shape, to_space, source.reverse_orientation, source.location); },
             source.geometry);
  store->record.flip_normal = source.reverse_orientation != to_space.swaps_handedness();
  store->record.material = source.material;
  link(*store);
  return store;
}

SurfaceGeometry evaluate_surface(const GeometryRecord& record, std::uint32_t primitive, float u, float v,
                                 const DVec3& near) {
  switch (record.kind) {
    case GeometryRecord::Kind::triangles:
      return evaluate_triangle(record, primitive, u, v);
    case GeometryRecord::Kind::patches:
      return evaluate_patch(record, primitive, u, v);
    case GeometryRecord::Kind::quadric:
      return evaluate_quadric(record, near);
  }
  return {};
}

}  // namespace lanthorn
