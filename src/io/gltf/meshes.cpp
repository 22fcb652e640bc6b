// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 §3.7.2.
#include "io/gltf/meshes.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "io/gltf/accessor.h"
#include "io/gltf/draco.h"

namespace lanthorn::gltf {

namespace {

using namespace description;

constexpr std::size_t most_corners = std::size_t{1} << 31;

// The corners of all triangles, three for each, from the vertex order of the modes triangles, strip and fan.
std::vector<std::array<std::uint32_t, 3>> triangles_of(std::uint64_t mode, const std::vector<std::uint32_t>& order) {
  std::vector<std::array<std::uint32_t, 3>> result;
  const std::size_t n = order.size();
  constexpr std::uint64_t list = 4, strip = 5;
  if (mode == list) {
    result.reserve(n / 3);
    for (std::size_t i = 0; i + 2 < n; i += 3) result.push_back({order[i], order[i + 1], order[i + 2]});
  } else if (mode == strip) {
    for (std::size_t i = 0; i + 2 < n; ++i) result.push_back({order[i], order[i + 1 + i % 2], order[i + 2 - i % 2]});
  } else {
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

// The vertices to keep; renumbers `order` accordingly. Keeps all unless only a few are used: primitives may share long
// accessors of which each uses a small part.
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

// An attribute with `components` numbers for each of `count` vertices, if the primitive has it.
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

TriangleMesh read_plain(Document& document, const Value& primitive, std::uint64_t mode, std::size_t uv_set) {
  const Value attributes = primitive.at("attributes");
  const Accessor positions(document, attributes.at("POSITION"), 3);
  const std::size_t count = positions.count();
  std::vector<std::uint32_t> order = read_order(document, primitive, count);
  const std::vector<std::uint32_t> kept = kept_vertices(order, count);
  TriangleMesh mesh;
  mesh.triangles = triangles_of(mode, order);
  mesh.positions = gather<Point>(positions, kept);
  if (const auto normals = find_attribute(document, attributes, "NORMAL", 3, count))
    mesh.normals = gather<Normal>(*normals, kept);
  if (const auto tangents = find_attribute(document, attributes, "TANGENT", 4, count))
    mesh.tangents = gather<Vec3>(*tangents, kept);
  if (const auto uvs = find_attribute(document, attributes, "TEXCOORD_" + std::to_string(uv_set), 2, count))
    mesh.uvs = gather<Vec2>(*uvs, kept);
  return mesh;
}

void warn_of_attributes(Document& document, const Value& primitive) {
  if (primitive.at("attributes").find("COLOR_0"))
    document.warn("COLOR_0", primitive, "vertex colours are not supported: ignored");
  if (primitive.find("targets"))
    document.warn("targets", primitive, "morph targets are not supported: meshes keep their base shape");
}

}  // namespace

std::optional<TriangleMesh> read_primitive(Document& document, const Value& primitive, std::size_t uv_set) {
  const std::uint64_t mode = primitive.integer("mode", 4);
  if (mode > 6) throw primitive.at("mode").error("there is no mode " + std::to_string(mode));
  if (mode < 4) {
    document.warn("lines", primitive, "points and lines are not supported: left out");
    return {};
  }
  warn_of_attributes(document, primitive);
  if (!primitive.at("attributes").find("POSITION")) {
    document.warn("no POSITION", primitive, "the primitive has no positions: left out");
    return {};
  }
  const auto compressed = primitive.extension("KHR_draco_mesh_compression");
  TriangleMesh mesh =
      compressed ? decode_draco(document, *compressed, uv_set) : read_plain(document, primitive, mode, uv_set);
  for (Vec2& uv : mesh.uvs) uv.y = 1 - uv.y;
  if (mesh.triangles.empty()) {
    document.warn("no triangles", primitive, "the primitive has no triangles: left out");
    return {};
  }
  return mesh;
}

}  // namespace lanthorn::gltf
