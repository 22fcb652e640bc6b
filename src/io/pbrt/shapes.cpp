// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/memory.h"
#include "io/pbrt/builders.h"
#include "io/pbrt/values.h"
#include "shape/curves.h"
#include "shape/loop_subdivision.h"

namespace lanthorn::pbrt {

namespace {

using namespace description;

// The faces of a mesh: `corners` vertex indices each, checked against the number of positions.
template <std::size_t corners>
std::vector<std::array<std::uint32_t, corners>> faces(const ParameterList& list, std::size_t positions) {
  const std::vector<std::int32_t> indices = list.integers("indices");
  if (!list.has("indices")) {
    if (positions != corners) throw list.error("indices", "is missing");
    std::array<std::uint32_t, corners> only{};
    for (std::size_t k = 0; k < corners; ++k) only[k] = static_cast<std::uint32_t>(k);
    return {only};
  }
  if (indices.empty() || indices.size() % corners != 0)
    throw list.error(
        "indices", "needs a multiple of " + std::to_string(corners) + " values, has " + std::to_string(indices.size()));
  std::vector<std::array<std::uint32_t, corners>> result(indices.size() / corners);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] < 0 || static_cast<std::size_t>(indices[i]) >= positions)
      throw list.error("indices", "has the value " + std::to_string(indices[i]) + ", but there are " +
                                      std::to_string(positions) + " points");
    result[i / corners][i % corners] = static_cast<std::uint32_t>(indices[i]);
  }
  return result;
}

std::vector<Point> positions(const ParameterList& list) {
  std::vector<Point> result = list.vec3s("P");
  if (result.empty()) throw list.error("P", "is missing");
  return result;
}

// Vertex attributes: none, or one per position.
template <class V>
std::vector<V> per_position(const ParameterList& list, std::string_view name, std::vector<V> values,
                            std::size_t count) {
  if (!values.empty() && values.size() != count)
    throw list.error(
        name, "has " + std::to_string(values.size()) + " entries, but there are " + std::to_string(count) + " points");
  return values;
}

TriangleMesh triangle_mesh(const ParameterList& list) {
  TriangleMesh mesh;
  mesh.positions = positions(list);
  mesh.triangles = faces<3>(list, mesh.positions.size());
  mesh.normals = per_position(list, "N", list.vec3s("N"), mesh.positions.size());
  mesh.tangents = per_position(list, "S", list.vec3s("S"), mesh.positions.size());
  mesh.uvs = per_position(list, "uv", list.vec2s("uv"), mesh.positions.size());
  list.find("faceIndices");  // only ptex uses it
  return mesh;
}

BilinearMesh bilinear_mesh(const ParameterList& list) {
  BilinearMesh mesh;
  mesh.positions = positions(list);
  mesh.patches = faces<4>(list, mesh.positions.size());
  mesh.normals = per_position(list, "N", list.vec3s("N"), mesh.positions.size());
  mesh.uvs = per_position(list, "uv", list.vec2s("uv"), mesh.positions.size());
  list.find("faceIndices");
  list.find("emissionfilename");  // pbrt-v4 uses it only to sample points on emitters
  return mesh;
}

float phi_max(const ParameterList& list) {
  const float value = list.get("phimax", 360.0f);
  if (!(value > 0)) throw list.error("phimax", "must be above 0 degrees");
  return std::min(value, 360.0f);
}

Sphere sphere(const ParameterList& list) {
  const float radius = positive(list, "radius", 1);
  const float a = list.get("zmin", -radius), b = list.get("zmax", radius);
  return {radius, std::min(a, b), std::max(a, b), phi_max(list)};
}

Disk disk(const ParameterList& list) {
  return {list.get("height", 0.0f), positive(list, "radius", 1), list.get("innerradius", 0.0f), phi_max(list)};
}

Cylinder cylinder(const ParameterList& list) {
  const float a = list.get("zmin", -1.0f), b = list.get("zmax", 1.0f);
  return {positive(list, "radius", 1), std::min(a, b), std::max(a, b), phi_max(list)};
}

TriangleMesh loop_subdivision(const ParameterList& list, Context& context) {
  TriangleMesh control;
  control.positions = positions(list);
  control.triangles = faces<3>(list, control.positions.size());
  const int levels = list.get("levels", 3);
  if (levels < 0) throw list.error("levels", "must not be negative");
  const double triangles = static_cast<double>(control.triangles.size()) * std::pow(4.0, levels);
  if (triangles > context.subdivided_triangles_left)
    throw list.error("levels", "would make more than 67 million triangles of the scene's subdivision surfaces");
  constexpr double bytes_of_triangle = 150;  // peak during subdivision; measured
  require_memory(bytes_of_triangle * triangles, list.place().location(), "the subdivision surface");
  context.subdivided_triangles_left -= triangles;
  list.find("scheme");  // only one scheme exists
  return loop_subdivide(control, levels);
}

CurveKind curve_kind(const ParameterList& list) {
  const std::string type = list.get("type", "flat");
  if (type == "flat") return CurveKind::flat;
  if (type == "cylinder") return CurveKind::cylinder;
  if (type == "ribbon") return CurveKind::ribbon;
  throw list.error("type", "must be flat, cylinder or ribbon, not " + in_quotes(type));
}

// Control points of one Bézier segment, elevated to degree 3.
std::vector<DVec3> elevated(const std::vector<DVec3>& p) {
  if (p.size() == 4) return p;
  return {p[0], (p[0] + 2.0 * p[1]) / 3.0, (2.0 * p[1] + p[2]) / 3.0, p[2]};
}

// Control points of one uniform B-spline segment, converted to Bézier form (blossoming: Farin 2002, ch. 8).
std::vector<DVec3> bezier_of_spline(const std::vector<DVec3>& p) {
  if (p.size() == 3) return {(p[0] + p[1]) / 2.0, p[1], (p[1] + p[2]) / 2.0};
  return {(p[0] + 4.0 * p[1] + p[2]) / 6.0, (2.0 * p[1] + p[2]) / 3.0, (p[1] + 2.0 * p[2]) / 3.0,
          (p[1] + 4.0 * p[2] + p[3]) / 6.0};
}

// The 3 n + 1 control points of the cubic Bézier curve that the directive describes.
std::vector<DVec3> cubic_bezier(const ParameterList& list) {
  const int degree = list.get("degree", 3);
  if (degree != 2 && degree != 3) throw list.error("degree", "must be 2 or 3");
  const std::string basis = list.get("basis", "bezier");
  const bool is_spline = basis == "bspline";
  if (!is_spline && basis != "bezier") throw list.error("basis", "must be bezier or bspline, not " + in_quotes(basis));
  const std::vector<Point> given = positions(list);
  const auto order = static_cast<std::size_t>(degree) + 1, step = is_spline ? 1 : order - 1;
  if (given.size() < order || (given.size() - order) % step != 0)
    throw list.error("P", "has " + std::to_string(given.size()) + " points; a " + basis + " curve of degree " +
                              std::to_string(degree) + " needs " + std::to_string(order) +
                              (is_spline ? " or more" : " plus a multiple of " + std::to_string(step)));
  std::vector<DVec3> result;
  for (std::size_t i = 0; i + order <= given.size(); i += step) {
    std::vector<DVec3> segment;
    for (std::size_t k = 0; k < order; ++k) segment.emplace_back(given[i + k]);
    segment = elevated(is_spline ? bezier_of_spline(segment) : segment);
    result.insert(result.end(), segment.begin() + (i == 0 ? 0 : 1), segment.end());
  }
  return result;
}

std::vector<Normal> ribbon_normals(const ParameterList& list, std::size_t segments) {
  std::vector<Normal> normals = list.vec3s("N");
  if (normals.size() != segments + 1)
    throw list.error("N", "needs " + std::to_string(segments + 1) + " normals, one for each end of a segment; has " +
                              std::to_string(normals.size()));
  for (Normal& n : normals) {
    if (!(length_squared(n) > 0)) throw list.error("N", "has a normal of length 0");
    n = normalize(n);
  }
  return normals;
}

Curves curve(const ParameterList& list) {
  Curves curves;
  curves.kind = curve_kind(list);
  const std::vector<DVec3> points = cubic_bezier(list);
  const float width = list.get("width", 1.0f);
  const float width0 = list.get("width0", width), width1 = list.get("width1", width);
  for (const auto& [name, value] : {std::pair("width0", width0), std::pair("width1", width1)})
    if (!(value >= 0)) throw list.error(list.has(name) ? name : "width", "must not be negative");
  list.find("splitdepth");  // affects only pbrt-v4's intersection algorithm
  const bool is_ribbon = curves.kind == CurveKind::ribbon;
  append_curve(curves, points, width0, width1,
               is_ribbon ? ribbon_normals(list, (points.size() - 1) / 3) : std::vector<Normal>());
  return curves;
}

std::variant<Geometry, PlyRequest> geometry(const std::string& kind, const ParameterList& list, Context& context) {
  if (kind == "trianglemesh") return Geometry(triangle_mesh(list));
  if (kind == "plymesh") return PlyRequest{context.add_file(list.required_string("filename"), list.place())};
  if (kind == "bilinearmesh") return Geometry(bilinear_mesh(list));
  if (kind == "sphere") return Geometry(sphere(list));
  if (kind == "disk") return Geometry(disk(list));
  if (kind == "cylinder") return Geometry(cylinder(list));
  if (kind == "loopsubdiv") return Geometry(loop_subdivision(list, context));
  if (kind == "curve") return Geometry(curve(list));
  throw context.unknown("shape", "Shape", kind, list.place());
}

}  // namespace

ShapeParts make_shape(const std::string& kind, const ParameterList& list, Context& context) {
  ShapeParts parts;
  parts.geometry = geometry(kind, list, context);
  parts.alpha_texture = texture_name(list, "alpha");
  if (!parts.alpha_texture) parts.alpha.value = list.get("alpha", 1.0f);
  if (std::holds_alternative<PlyRequest>(parts.geometry)) {
    parts.displacement_texture = texture_name(list, "displacement");
    parts.edge_length = positive(list, "edgelength", 1);
  }
  report_unused(list, context);
  return parts;
}

}  // namespace lanthorn::pbrt
