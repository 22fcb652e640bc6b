// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 §3.7.2.
#include "io/gltf/meshes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "io/finite_mesh.h"
#include "io/gltf/accessor.h"
#include "io/gltf/draco.h"
#include "io/gltf/tangents.h"
#include "math/vec.h"

namespace lanthorn::gltf {

namespace {

using namespace description;

constexpr std::size_t most_corners = std::size_t{1} << 31;

enum Mode : std::uint8_t { points, lines, line_loop, line_strip, triangle_list, triangle_strip, triangle_fan };

Strokes strokes_of(std::uint64_t mode, const std::vector<std::uint32_t>& order) {
  Strokes result;
  const std::size_t n = order.size();
  if (mode == points)
    for (const std::uint32_t i : order) result.push_back({i, i});
  if (mode == lines)
    for (std::size_t i = 0; i + 1 < n; i += 2) result.push_back({order[i], order[i + 1]});
  if (mode == line_strip || mode == line_loop)
    for (std::size_t i = 0; i + 1 < n; ++i) result.push_back({order[i], order[i + 1]});
  if (mode == line_loop && n > 2) result.push_back({order[n - 1], order[0]});
  return result;
}

// The triangles' corners, from the vertex order of the modes triangles, strip and fan.
std::vector<std::array<std::uint32_t, 3>> triangles_of(std::uint64_t mode, const std::vector<std::uint32_t>& order) {
  std::vector<std::array<std::uint32_t, 3>> result;
  const std::size_t n = order.size();
  if (mode == triangle_list) {
    result.reserve(n / 3);
    for (std::size_t i = 0; i + 2 < n; i += 3) result.push_back({order[i], order[i + 1], order[i + 2]});
  } else if (mode == triangle_strip) {
    for (std::size_t i = 0; i + 2 < n; ++i) result.push_back({order[i], order[i + 1 + i % 2], order[i + 2 - i % 2]});
  } else if (mode == triangle_fan) {
    for (std::size_t i = 1; i + 1 < n; ++i) result.push_back({order[i], order[i + 1], order[0]});
  }
  return result;
}

std::vector<std::uint32_t> read_order(Document& document, const Value& primitive, std::size_t vertices) {
  std::vector<std::uint32_t> order;
  if (const auto reference = primitive.find("indices")) {
    const Accessor indices(document, *reference, 1);
    if (!indices.is_unsigned()) throw reference->error("indices must be unsigned integers");
    if (indices.count() > most_corners) throw reference->error("there are too many indices");
    order.resize(indices.count());
    for (std::size_t i = 0; i < order.size(); ++i) {
      order[i] = indices.integer(i, 0);
      if (order[i] >= vertices)
        throw reference->error("index number " + std::to_string(i) + " is " + std::to_string(order[i]) +
                               ", but there are " + std::to_string(vertices) + " vertices");
    }
  } else {
    if (vertices > most_corners) throw primitive.error("there are too many vertices");
    order.resize(vertices);
    std::iota(order.begin(), order.end(), 0u);
  }
  return order;
}

// Selects the vertices to keep and renumbers `order` accordingly. Keeps all unless only a few are used: primitives may
// share long accessors and each use only a small part of them.
std::vector<std::uint32_t> kept_vertices(std::vector<std::uint32_t>& order, std::size_t vertices) {
  std::vector<std::uint32_t> kept;
  if (vertices / 2 <= order.size()) {
    kept.resize(vertices);
    std::iota(kept.begin(), kept.end(), 0u);
    return kept;
  }
  kept = order;
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  for (std::uint32_t& i : order)
    i = static_cast<std::uint32_t>(std::lower_bound(kept.begin(), kept.end(), i) - kept.begin());
  return kept;
}

template <class V>
std::vector<V> gather(const Accessor& accessor, const std::vector<std::uint32_t>& vertices) {
  std::vector<V> result(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i)
    for (int k = 0; k < V::length(); ++k) result[i][k] = accessor.number(vertices[i], static_cast<std::size_t>(k));
  return result;
}

// An attribute with `components` numbers for each of `count` vertices; nullopt if the primitive lacks it.
std::optional<Accessor> find_attribute(Document& document, const Value& attributes, const std::string& name,
                                       std::size_t components, std::size_t count) {
  const auto reference = attributes.find(name);
  if (!reference) return {};
  Accessor accessor(document, *reference, components);
  if (accessor.count() != count)
    throw reference->error("has " + std::to_string(accessor.count()) + " elements, but there are " +
                           std::to_string(count) + " positions");
  return accessor;
}

// Colours with or without alpha (§3.7.2.1).
std::vector<glm::vec4> read_colors(Document& document, const Value& attributes, std::size_t count,
                                   const std::vector<std::uint32_t>& vertices) {
  const auto reference = attributes.find("COLOR_0");
  if (!reference) return {};
  const bool has_alpha = document.follow("accessors", *reference).at("type").text() == "VEC4";
  const auto colors = find_attribute(document, attributes, "COLOR_0", has_alpha ? 4 : 3, count);
  if (has_alpha) return gather<glm::vec4>(*colors, vertices);
  std::vector<glm::vec4> result;
  for (const Vec3& c : gather<Vec3>(*colors, vertices)) result.emplace_back(c, 1);
  return result;
}

void apply_skin(Document& document, const Value& attributes, std::span<const glm::dmat4> joints, std::size_t count,
                const std::vector<std::uint32_t>& vertices, TriangleMesh& mesh) {
  Skinning skinning(joints, vertices.size());
  for (int set = 0; attributes.find("JOINTS_" + std::to_string(set)); ++set) {
    const std::string number = std::to_string(set);
    const Value place = attributes.at("JOINTS_" + number);
    const auto indices = find_attribute(document, attributes, "JOINTS_" + number, 4, count);
    const auto weights = find_attribute(document, attributes, "WEIGHTS_" + number, 4, count);
    if (!indices->is_unsigned()) throw place.error("joints must be unsigned integers");
    if (!weights) throw attributes.error("needs the member \"WEIGHTS_" + number + "\"");
    for (std::size_t i = 0; i < vertices.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k)
        skinning.add(i, indices->integer(vertices[i], k), weights->number(vertices[i], k), place);
  }
  skinning.apply(mesh);
}

Primitive read_plain(Document& document, const Value& primitive, std::uint64_t mode, const Surface& surface,
                     const Deformation& deformation) {
  const Value attributes = primitive.at("attributes");
  const Accessor positions(document, attributes.at("POSITION"), 3);
  const std::size_t count = positions.count();
  std::vector<std::uint32_t> order = read_order(document, primitive, count);
  const std::vector<std::uint32_t> kept = kept_vertices(order, count);
  Primitive result{{}, strokes_of(mode, order)};
  TriangleMesh& mesh = result.mesh;
  mesh.triangles = triangles_of(mode, order);
  mesh.positions = gather<Point>(positions, kept);
  mesh.colors = read_colors(document, attributes, count, kept);
  if (const auto uvs = find_attribute(document, attributes, "TEXCOORD_" + std::to_string(surface.uv_set), 2, count))
    mesh.uvs = gather<Vec2>(*uvs, kept);
  for (Vec2& uv : mesh.uvs) uv.y = 1 - uv.y;
  if (const auto normals = find_attribute(document, attributes, "NORMAL", 3, count))
    mesh.normals = gather<Normal>(*normals, kept);
  std::vector<glm::vec4> tangents;
  if (const auto given = find_attribute(document, attributes, "TANGENT", 4, count))
    tangents = gather<glm::vec4>(*given, kept);
  set_tangents(mesh, std::move(tangents), surface.tangent_turn);
  morph(document, primitive, deformation.weights, kept, mesh);
  if (!deformation.joints.empty()) apply_skin(document, attributes, deformation.joints, count, kept, mesh);
  return result;
}

Primitive read_compressed(Document& document, const Value& primitive, const Value& compressed, const Surface& surface,
                          const Deformation& deformation) {
  Primitive result{decode_draco(document, compressed, surface, deformation.joints), {}};
  if (!std::all_of(deformation.weights.begin(), deformation.weights.end(), [](float w) { return w == 0; }))
    document.warn("Draco targets", primitive, "morph targets of meshes compressed by Draco are ignored");
  return result;
}

// The format forbids such numbers, but exporters write them, for example as the normals of faces without area.
void repair_not_finite(Document& document, const Value& primitive, Primitive& result) {
  TriangleMesh& mesh = result.mesh;
  if (const std::size_t cells =
          erase_not_finite(mesh.triangles, mesh.positions) + erase_not_finite(result.strokes, mesh.positions);
      cells > 0)
    document.warn("not finite", primitive,
                  std::to_string(cells) + " faces, lines or points with a corner that is not finite: left out");
  // No cell uses these positions any more: they move onto another, so that the bounding box stays tight.
  const auto place = std::find_if(mesh.positions.begin(), mesh.positions.end(), is_finite<Point>);
  replace_not_finite(mesh.positions, place == mesh.positions.end() ? Point(0) : Point(*place));
  if (const std::size_t replaced = replace_not_finite(mesh.normals, Normal(0)) +
                                   replace_not_finite(mesh.tangents, Vec3(0)) + replace_not_finite(mesh.uvs, Vec2(0)) +
                                   replace_not_finite(mesh.colors, glm::vec4(1));
      replaced > 0)
    document.warn("attributes not finite", primitive,
                  std::to_string(replaced) +
                      " normals, tangents, texture coordinates or colours that are not finite: read as 0, or as white");
}

}  // namespace

std::optional<Primitive> read_primitive(Document& document, const Value& primitive, const Surface& surface,
                                        const Deformation& deformation) {
  const std::uint64_t mode = primitive.integer("mode", triangle_list);
  if (mode > triangle_fan) throw primitive.at("mode").error("there is no mode " + std::to_string(mode));
  if (!primitive.at("attributes").find("POSITION")) {
    document.warn("no POSITION", primitive, "the primitive has no positions: left out");
    return {};
  }
  const auto compressed = primitive.extension("KHR_draco_mesh_compression");
  Primitive result = compressed ? read_compressed(document, primitive, *compressed, surface, deformation)
                                : read_plain(document, primitive, mode, surface, deformation);
  repair_not_finite(document, primitive, result);
  if (result.mesh.triangles.empty() && result.strokes.empty()) {
    document.warn("no triangles", primitive, "the primitive has no triangles: left out");
    return {};
  }
  return result;
}

}  // namespace lanthorn::gltf
