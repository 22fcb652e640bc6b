// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <utility>

#include "io/pbrt/builders.h"
#include "io/pbrt/values.h"

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

// Empty, or one for each position.
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
  list.find("faceIndices");  // for ptex alone
  return mesh;
}

BilinearMesh bilinear_mesh(const ParameterList& list, Context& context) {
  BilinearMesh mesh;
  mesh.positions = positions(list);
  mesh.patches = faces<4>(list, mesh.positions.size());
  mesh.normals = per_position(list, "N", list.vec3s("N"), mesh.positions.size());
  mesh.uvs = per_position(list, "uv", list.vec2s("uv"), mesh.positions.size());
  list.find("faceIndices");
  if (const Parameter* image = list.find("emissionfilename"))
    context.warn("emissionfilename", image->place,
                 "\"emissionfilename\" is not supported yet: the mesh gives off light of one colour");
  return mesh;
}

float positive(const ParameterList& list, std::string_view name, float otherwise) {
  const float value = list.get(name, otherwise);
  if (!(value > 0)) throw list.error(name, "must be above 0");
  return value;
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

PlyRequest ply_mesh(const ParameterList& list, Context& context) {
  if (const Parameter* p = list.find("displacement")) {
    context.warn("shape displacement", p->place,
                 "displacement of meshes is not supported yet: the mesh stays as it is");
    for (const std::string_view name : {"edgelength", "displacement.edgelength"}) list.find(name);
  }
  return {context.add_file(list.required_string("filename"))};
}

TriangleMesh control_mesh(const ParameterList& list, Context& context) {
  context.warn("shape loopsubdiv", list.place(),
               "shape \"loopsubdiv\" is not supported yet: replaced by its control mesh, without subdivision");
  list.find("levels");
  list.find("scheme");
  return triangle_mesh(list);
}

std::variant<Geometry, PlyRequest> geometry(const std::string& kind, const ParameterList& list, Context& context) {
  if (kind == "trianglemesh") return Geometry(triangle_mesh(list));
  if (kind == "plymesh") return ply_mesh(list, context);
  if (kind == "bilinearmesh") return Geometry(bilinear_mesh(list, context));
  if (kind == "sphere") return Geometry(sphere(list));
  if (kind == "disk") return Geometry(disk(list));
  if (kind == "cylinder") return Geometry(cylinder(list));
  if (kind == "loopsubdiv") return Geometry(control_mesh(list, context));
  throw Error(list.place().location(), "unknown shape " + in_quotes(kind));
}

}  // namespace

std::optional<ShapeParts> make_shape(const std::string& kind, const ParameterList& list, Context& context) {
  if (kind == "curve") {
    context.warn("shape curve", list.place(), "shape \"curve\" is not supported yet: ignored");
    return {};
  }
  ShapeParts parts{geometry(kind, list, context), {1, {}}, texture_name(list, "alpha")};
  if (!parts.alpha_texture) parts.alpha.value = list.get("alpha", 1.0f);
  report_unused(list, context);
  return parts;
}

}  // namespace lanthorn::pbrt
