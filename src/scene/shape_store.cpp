// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Stores described shapes in the arrays that Embree and the records read, and evaluates their surfaces.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "scene/geometry.h"
#include "shape/curves.h"
#include "shape/triangle_memory.h"

namespace lanthorn {

namespace {

using description::BilinearMesh;
using description::TriangleMesh;

template <class Cell>
void check_mesh(const std::vector<Cell>& cells, std::size_t positions, std::size_t normals, std::size_t uvs,
                std::size_t tangents, std::size_t colors, const SourceLocation& location) {
  const auto check_count = [&](std::size_t count, const char* what) {
    if (count != 0 && count != positions)
      throw Error(location, std::string("the mesh has ") + std::to_string(positions) + " positions but " +
                                std::to_string(count) + " " + what);
  };
  check_count(normals, "normals");
  check_count(uvs, "uvs");
  check_count(tangents, "tangents");
  check_count(colors, "colours");
  for (const Cell& cell : cells)
    for (const std::uint32_t corner : cell)
      if (corner >= positions)
        throw Error(location, "the mesh has an index " + std::to_string(corner) + " but only " +
                                  std::to_string(positions) + " positions");
}

// Converts a normal of any length; normalises it if its length cannot be squared in single precision.
Normal normal_in_range(const DVec3& n) {
  constexpr double shortest2 = 1e-20, longest2 = 1e20;
  const double length2 = glm::dot(n, n);
  if (!(length2 > 0) || !std::isfinite(length2)) return Normal(0);
  return Normal(length2 < shortest2 || length2 > longest2 ? n / std::sqrt(length2) : n);
}

// Moves the mesh's vertices to the space that `t` maps to. As in pbrt, normals transform with the surface, and
// ReverseOrientation negates them.
template <class Mesh>
void take_vertices(ShapeStore& store, Mesh& mesh, const Transform& t, bool reverse, const SourceLocation& location) {
  const bool is_identity = t.is_identity();
  const Affine map(t);
  for (Point& p : mesh.positions) {
    if (!is_identity) p = Point(map.point(DVec3(p)));
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw Error(location, "the mesh has a position that is not finite");
  }
  store.record.has_normals = !mesh.normals.empty();
  store.record.has_uvs = !mesh.uvs.empty();
  if (!store.record.has_normals && !store.record.has_uvs) {
    store.positions = std::move(mesh.positions);
    store.positions.push_back(store.positions.empty() ? Point(0) : store.positions.back());  // Embree reads 16 bytes
    return;
  }
  store.vertices.resize(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    Vertex& v = store.vertices[i];
    v.position = mesh.positions[i];
    if (store.record.has_normals)
      v.normal = normal_in_range(is_identity ? DVec3(mesh.normals[i]) : map.normal(DVec3(mesh.normals[i])));
    if (reverse) v.normal = -v.normal;
    if (store.record.has_uvs) v.uv = mesh.uvs[i];
  }
  mesh.positions = {};
  mesh.normals = {};
  mesh.uvs = {};
}

void link(ShapeStore& store) {
  GeometryRecord& r = store.record;
  const auto data = [](const auto& values) { return values.empty() ? nullptr : values.data(); };
  r.triangles = data(store.triangles);
  r.positions = data(store.positions);
  if (r.has_vertices())
    r.vertices = data(store.vertices);
  else
    r.flat = data(store.flat);
  r.tangents = data(store.tangents);
  if (r.kind == GeometryRecord::Kind::quadric)
    r.quadric = &store.quadric;
  else if (r.kind == GeometryRecord::Kind::curves)
    r.curves = &store.curves;
  else if (r.has_colors)
    r.colors = store.colors.data();
  else
    r.patches = data(store.patches);
}

std::vector<FlatTriangle> flat_triangles(const ShapeStore& store) {
  std::vector<FlatTriangle> result;
  if (store.record.has_vertices()) return result;
  result.reserve(store.triangles.size());
  for (const auto& [a, b, c] : store.triangles)
    result.push_back(
        flat_triangle({store.positions[a], store.positions[b], store.positions[c]}, store.record.flip_normal));
  return result;
}

void take(ShapeStore& store, TriangleMesh& mesh, const Transform& t, bool reverse, const SourceLocation& location) {
  check_mesh(mesh.triangles, mesh.positions.size(), mesh.normals.size(), mesh.uvs.size(), mesh.tangents.size(),
             mesh.colors.size(), location);
  store.triangles = std::move(mesh.triangles);
  store.tangents = std::move(mesh.tangents);
  store.colors = std::move(mesh.colors);
  store.record.has_colors = !store.colors.empty();
  take_vertices(store, mesh, t, reverse, location);
  if (!t.is_identity()) {
    const Affine map(t);
    for (Vec3& tangent : store.tangents) tangent = Vec3(map.vector(DVec3(tangent)));
  }
  store.record.kind = GeometryRecord::Kind::triangles;
}

// True if the shape consists of triangles without normals, and triangles 2 i and 2 i + 1 are the halves of a
// parallelogram for all i.
bool are_pairs(const ShapeStore& store) {
  const std::size_t count = store.triangles.size();
  if (count == 0 || count % 2 != 0 || store.record.has_normals) return false;
  for (std::uint32_t i = 0; i < count; i += 2)
    if (!parallelogram_of(corners_of(store.record, i), corners_of(store.record, i + 1))) return false;
  return true;
}

bool are_parallelograms(const ShapeStore& store) {
  return store.vertices.empty() &&
         std::all_of(store.patches.begin(), store.patches.end(), [&](const std::array<std::uint32_t, 4>& p) {
           return is_parallelogram(store.positions[p[0]], store.positions[p[1]], store.positions[p[2]],
                                   store.positions[p[3]]);
         });
}

void take(ShapeStore& store, BilinearMesh& mesh, const Transform& t, bool reverse, const SourceLocation& location) {
  check_mesh(mesh.patches, mesh.positions.size(), mesh.normals.size(), mesh.uvs.size(), 0, 0, location);
  store.patches = std::move(mesh.patches);
  take_vertices(store, mesh, t, reverse, location);
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

// Embree divides by the size of a segment's bounds; the quotient must not overflow.
void widen_points_of_nothing(description::Curves& curves) {
  constexpr float least = 1e-30f;
  for (const std::uint32_t first : curves.segments) {
    glm::vec4* p = &curves.points[first];
    float size = 0;
    for (int i = 0; i < 4; ++i) size = std::max({size, p[i].w, max_component(abs(Vec3(p[i]) - Vec3(p[0])))});
    for (int i = 0; i < 4 && size < least; ++i) p[i].w = least;
  }
}

void take(ShapeStore& store, description::Curves& curves, const Transform& t, bool, const SourceLocation& location) {
  check_curves(curves, location);
  store.curves = transformed(std::move(curves), t);
  // Embree connects a ribbon's edges from its ends; over a long turn they come too close to each other.
  if (store.curves.kind == description::CurveKind::ribbon) store.curves = cut(store.curves, ribbon_pieces);
  for (const glm::vec4& p : store.curves.points)
    if (!std::isfinite(p.x + p.y + p.z + p.w)) throw Error(location, "the curve has a point that is not finite");
  widen_points_of_nothing(store.curves);
  if (!store.curves.normals.empty()) store.curves.normals.push_back(store.curves.normals.back());
  store.record.kind = GeometryRecord::Kind::curves;
}

template <class Shape>
void take(ShapeStore& store, const Shape& shape, const Transform& t, bool, const SourceLocation& location) {
  store.quadric = Quadric::from(shape, t);
  if (!(store.quadric.radius > 0)) throw Error(location, "the radius must be positive");
  store.record.kind = GeometryRecord::Kind::quadric;
}

// Rounds to single precision; the error bound includes this rounding and `slack`.
void set_position(SurfaceGeometry& s, const DVec3& p, double slack) {
  s.position = Point(p);
  s.error = 0x1p-23f * abs(s.position) + Vec3(static_cast<float>(slack));
}

SurfaceGeometry evaluate_quadric(const GeometryRecord& record, const DVec3& near) {
  const QuadricPoint q = evaluate(*record.quadric, near);
  SurfaceGeometry s;
  set_position(s, q.position, record.quadric->rounding_slack);
  s.normal = Normal(record.flip_normal ? -q.normal : q.normal);
  s.shading_normal = s.normal;
  if (record.wants_uv) s.uv = evaluate_uv(*record.quadric, near);
  if (record.wants_derivatives()) {
    const QuadricTangents t = evaluate_tangents(*record.quadric, near);
    s.tangent = Vec3(t.around);
    s.dpdu = Vec3(t.dpdu);
    s.dpdv = Vec3(t.dpdv);
  }
  return s;
}

SurfaceGeometry evaluate_curve(const GeometryRecord& record, const PrimitiveHit& hit) {
  const CurvePoint c = evaluate(*record.curves, hit.primitive, hit.u, hit.near, hit.along);
  SurfaceGeometry s;
  set_position(s, c.position, 0);
  s.normal = Normal(record.flip_normal ? -c.normal : c.normal);
  s.error += static_cast<float>(c.error) * abs(s.normal);
  s.shading_normal = s.normal;
  s.uv = c.uv;
  if (record.wants_derivatives()) {
    s.dpdu = Vec3(c.dpdu);
    s.dpdv = Vec3(c.dpdv);
    s.tangent = s.dpdu;
  }
  return s;
}

// Derivatives with respect to texture coordinates (s, t) given at the corners, by the chain rule through (u, v). Left
// at 0 if the map from (u, v) to (s, t) is degenerate.
void set_derivatives(SurfaceGeometry& s, const DVec3& dpdu, const DVec3& dpdv, const std::array<Vec2, 4>& st, float u,
                     float v) {
  const glm::dvec2 du = (1.0 - v) * glm::dvec2(st[1] - st[0]) + static_cast<double>(v) * glm::dvec2(st[3] - st[2]);
  const glm::dvec2 dv = (1.0 - u) * glm::dvec2(st[2] - st[0]) + static_cast<double>(u) * glm::dvec2(st[3] - st[1]);
  const double determinant = du.x * dv.y - du.y * dv.x;
  if (determinant == 0) return;
  s.dpdu = Vec3((dv.y * dpdu - du.y * dpdv) / determinant);
  s.dpdv = Vec3((du.x * dpdv - dv.x * dpdu) / determinant);
}

template <class T>
T bilinear(const std::array<T, 4>& values, float u, float v) {
  return (1 - v) * ((1 - u) * values[0] + u * values[1]) + v * ((1 - u) * values[2] + u * values[3]);
}

Patch patch_of(const GeometryRecord& record, std::uint32_t primitive) {
  const std::array<std::uint32_t, 4>& c = record.patches[primitive];
  return {DVec3(record.position(c[0])), DVec3(record.position(c[1])), DVec3(record.position(c[2])),
          DVec3(record.position(c[3]))};
}

SurfaceGeometry evaluate_patch(const GeometryRecord& record, std::uint32_t primitive, float u, float v) {
  const Patch patch = patch_of(record, primitive);
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
  const std::array<std::uint32_t, 4>& c = record.patches[primitive];
  const auto at_corners = [&](auto member) {
    return std::array{record.vertices[c[0]].*member, record.vertices[c[1]].*member, record.vertices[c[2]].*member,
                      record.vertices[c[3]].*member};
  };
  if (record.has_normals) {
    const Normal n = bilinear(at_corners(&Vertex::normal), u, v);
    if (detail::is_squarable(length_squared(n))) {
      s.shading_normal = normalize(n);
      if (dot(s.normal, s.shading_normal) < 0) s.normal = -s.normal;
    }
  }
  s.uv = record.has_uvs ? bilinear(at_corners(&Vertex::uv), u, v) : Vec2(u, v);
  if (record.wants_derivatives()) {
    if (record.has_uvs) {
      set_derivatives(s, dpdu, dpdv, at_corners(&Vertex::uv), u, v);
    } else {
      s.dpdu = Vec3(dpdu);
      s.dpdv = Vec3(dpdv);
    }
    s.tangent = s.dpdu;
  }
  return s;
}

template <class T>
std::size_t size_of(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

// Extends the bounds by the ball of a control point: a curve lies within the hull of these balls.
void extend(Bounds& b, const glm::vec4& control_point) {
  b.extend(Point(control_point) - Vec3(control_point.w));
  b.extend(Point(control_point) + Vec3(control_point.w));
}

Bounds rounded_outwards(Bounds b) {
  for (int i = 0; i < 3; ++i) {
    b.min[i] = std::nextafter(b.min[i], -infinity);
    b.max[i] = std::nextafter(b.max[i], infinity);
  }
  return b;
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
    case GeometryRecord::Kind::curves:
      return curves.segments.size();
  }
  return 0;
}

std::size_t ShapeStore::bytes() const {
  return size_of(triangles) + size_of(patches) + size_of(positions) + size_of(vertices) + size_of(flat) +
         size_of(tangents) + size_of(colors) + size_of(curves.points) + size_of(curves.normals) +
         size_of(curves.segments) + sizeof(ShapeStore);
}

Bounds ShapeStore::bounds() const {
  if (record.kind == GeometryRecord::Kind::quadric) return quadric.bounds();
  Bounds b;
  for (const glm::vec4& p : curves.points) extend(b, p);
  for (const Vertex& v : vertices) b.extend(v.position);
  for (const Point& p : positions) b.extend(p);
  return rounded_outwards(b);
}

Bounds ShapeStore::bounds_of(std::uint32_t primitive) const {
  if (record.kind == GeometryRecord::Kind::quadric) return quadric.bounds();
  Bounds b;
  if (record.kind == GeometryRecord::Kind::curves) {
    for (std::uint32_t i = 0; i < 4; ++i) extend(b, curves.points[curves.segments[primitive] + i]);
  } else if (record.kind == GeometryRecord::Kind::patches) {
    for (const std::uint32_t corner : patches[primitive]) b.extend(record.position(corner));
  } else {
    for (const std::uint32_t corner : triangles[primitive]) b.extend(record.position(corner));
  }
  return rounded_outwards(b);
}

Patch ShapeStore::patch(std::uint32_t primitive) const { return patch_of(record, primitive); }

namespace {

// True if the map to the shape's space mirrors, and so exchanges the outside with the side of the natural normal, which
// follows from the winding or the parametrisation:
// - of meshes, because mirroring reverses their winding; their outside stays where it was;
// - of quadrics that do not emit, because pbrt-v4 turns them inside out.
// A lamp emits from the same side in the world, in an instance and in motion. (In pbrt-v4, a mirrored quadric lights
// the scene from its natural side and shows its light on the other side.) Curves have no natural side.
bool mirroring_flips(const ShapeStore& store, const description::Shape& source, const Transform& to_space) {
  switch (store.record.kind) {
    case GeometryRecord::Kind::triangles:
    case GeometryRecord::Kind::patches:
      return to_space.swaps_handedness();
    case GeometryRecord::Kind::quadric:
      return to_space.swaps_handedness() && !source.area_light;
    case GeometryRecord::Kind::curves:
      break;
  }
  return false;
}

}  // namespace

std::unique_ptr<ShapeStore> make_shape_store(description::Shape& source, const Transform& to_space) {
  if (to_space.is_singular()) throw Error(source.location, "the shape's transformation is singular");
  auto store = std::make_unique<ShapeStore>();
  store->location = source.location;
  std::visit([&](auto& shape) { take(*store, shape, to_space, source.reverse_orientation, source.location); },
             source.geometry);
  store->record.flip_normal = source.reverse_orientation != mirroring_flips(*store, source, to_space);
  store->record.material = source.material;
  store->flat = flat_triangles(*store);
  link(*store);
  store->record.lit_in_pairs = store->record.quads || (source.area_light && are_pairs(*store));
  return store;
}

SurfaceGeometry evaluate_surface(const GeometryRecord& record, const PrimitiveHit& hit) {
  switch (record.kind) {
    case GeometryRecord::Kind::triangles:
      return evaluate_triangle(record, hit.primitive, hit.u, hit.v);
    case GeometryRecord::Kind::patches:
      return evaluate_patch(record, hit.primitive, hit.u, hit.v);
    case GeometryRecord::Kind::quadric:
      return evaluate_quadric(record, hit.near);
    case GeometryRecord::Kind::curves:
      return evaluate_curve(record, hit);
  }
  return {};
}

}  // namespace lanthorn
