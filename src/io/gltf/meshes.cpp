// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 §3.7.2; KHR_draco_mesh_compression.
#include "io/gltf/meshes.h"

#include <draco/compression/decode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/finite_mesh.h"
#include "io/gltf/accessor.h"
#include "lanthorn/scene_description.h"
#include "math/vec.h"

namespace lanthorn::gltf {

namespace {

using namespace description;

// Tangents along u, with w the side of the bitangent; averages over the triangles at each vertex.
std::vector<glm::vec4> tangents_along_u(const TriangleMesh& mesh) {
  std::vector<Vec3> along_u(mesh.positions.size(), Vec3(0)), along_t = along_u;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 edge1 = mesh.positions[b] - mesh.positions[a], edge2 = mesh.positions[c] - mesh.positions[a];
    const Vec2 st1 = mesh.uvs[b] - mesh.uvs[a], st2 = mesh.uvs[c] - mesh.uvs[a];
    const float determinant = st1.x * st2.y - st1.y * st2.x;
    if (determinant == 0) continue;
    for (const std::uint32_t corner : {a, b, c}) {
      along_u[corner] += (st2.y * edge1 - st1.y * edge2) / determinant;
      along_t[corner] += (st1.x * edge2 - st2.x * edge1) / determinant;
    }
  }
  std::vector<glm::vec4> result;
  for (std::size_t i = 0; i < along_u.size(); ++i)
    result.emplace_back(along_u[i], dot(cross(mesh.normals[i], along_u[i]), along_t[i]) < 0 ? -1 : 1);
  return result;
}

// Gives the mesh the file's tangents, whose w is the side of the bitangent (one per position, or none), rotated about
// the normals by `turn` radians: counter-clockwise as seen from outside if w is 1. Without tangents in the file, those
// to be rotated run along u. Needs the mesh's normals and, in that case, its texture coordinates (u, 1 - v).
void set_tangents(TriangleMesh& mesh, std::vector<glm::vec4> tangents, float turn) {
  mesh.tangents.assign(tangents.begin(), tangents.end());
  if (turn == 0 || mesh.normals.empty()) return;
  if (tangents.empty() && !mesh.uvs.empty()) tangents = tangents_along_u(mesh);
  mesh.tangents.resize(tangents.size());
  for (std::size_t i = 0; i < tangents.size(); ++i) {
    const Vec3 tangent(tangents[i]), bitangent = tangents[i].w * cross(mesh.normals[i], tangent);
    mesh.tangents[i] = std::cos(turn) * tangent + std::sin(turn) * bitangent;
  }
}

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

// The values of the attribute that `attributes` calls `name`, one per point; empty if there is none.
template <class V>
std::vector<V> values(const draco::Mesh& mesh, const Value& attributes, const std::string& name) {
  constexpr auto components = static_cast<std::int8_t>(V::length());
  const auto id = attributes.find(name);
  if (!id) return {};
  const draco::PointAttribute* attribute =
      mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id->integer(std::numeric_limits<std::uint32_t>::max())));
  if (attribute == nullptr) throw id->error("the compressed mesh has no such attribute");
  if (attribute->num_components() < components)
    throw id->error("the attribute has " + std::to_string(attribute->num_components()) + " numbers, needs " +
                    std::to_string(V::length()));
  // glTF has no boolean attributes; Draco would read them from the file's bytes unchecked.
  if (attribute->data_type() == draco::DT_BOOL) throw id->error("the attribute consists of booleans");
  std::vector<V> result(mesh.num_points());
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    const draco::AttributeValueIndex at = attribute->mapped_index(draco::PointIndex(i));
    std::array<float, V::length()> numbers{};
    if (at.value() >= attribute->size() || !attribute->ConvertValue<float, V::length()>(at, numbers.data()))
      throw id->error("the attribute cannot be decoded");
    for (int k = 0; k < V::length(); ++k) result[i][k] = numbers[static_cast<std::size_t>(k)];
  }
  return result;
}

// Colours with or without alpha.
std::vector<glm::vec4> colors(const draco::Mesh& mesh, const Value& attributes) {
  const auto id = attributes.find("COLOR_0");
  if (!id) return {};
  const draco::PointAttribute* attribute =
      mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id->integer(std::numeric_limits<std::uint32_t>::max())));
  if (attribute != nullptr && attribute->num_components() >= 4) return values<glm::vec4>(mesh, attributes, "COLOR_0");
  std::vector<glm::vec4> result;
  for (const Vec3& c : values<Vec3>(mesh, attributes, "COLOR_0")) result.emplace_back(c, 1);
  return result;
}

void apply_skin(const draco::Mesh& source, const Value& attributes, std::span<const glm::dmat4> joints,
                TriangleMesh& mesh) {
  Skinning skinning(joints, mesh.positions.size());
  for (int set = 0; attributes.find("JOINTS_" + std::to_string(set)); ++set) {
    const std::string number = std::to_string(set);
    const auto indices = values<glm::vec4>(source, attributes, "JOINTS_" + number);
    const auto weights = values<glm::vec4>(source, attributes, "WEIGHTS_" + number);
    for (std::size_t i = 0; i < weights.size(); ++i)
      for (int k = 0; k < 4; ++k) {
        constexpr float most = 65535;
        const float joint = std::fmin(std::fmax(indices[i][k], 0.0f), most);
        skinning.add(i, static_cast<std::uint32_t>(joint), weights[i][k], attributes);
      }
  }
  skinning.apply(mesh);
}

// Decodes the mesh of a KHR_draco_mesh_compression extension, with the attributes that its surface needs: texture
// coordinates as (u, 1 - v), tangents. Vertices are moved by the joints of a skin if there are any. Throws Error at
// the extension.
TriangleMesh decode_draco(Document& document, const Value& extension, const Surface& surface,
                          std::span<const glm::dmat4> joints) {
  const std::string_view bytes = document.buffer_view(extension.at("bufferView")).bytes;
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    throw extension.error("the compressed mesh cannot be decoded: " + decoded.status().error_msg_string());
  const draco::Mesh& source = *decoded.value();
  const Value attributes = extension.at("attributes");
  TriangleMesh mesh;
  mesh.positions = values<Point>(source, attributes, "POSITION");
  mesh.normals = values<Normal>(source, attributes, "NORMAL");
  mesh.uvs = values<Vec2>(source, attributes, "TEXCOORD_" + std::to_string(surface.uv_set));
  for (Vec2& uv : mesh.uvs) uv.y = 1 - uv.y;
  mesh.colors = colors(source, attributes);
  if (mesh.positions.empty()) throw extension.error("the compressed mesh has no positions");
  mesh.triangles.reserve(source.num_faces());
  for (std::uint32_t i = 0; i < source.num_faces(); ++i) {
    const auto& face = source.face(draco::FaceIndex(i));
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = face[k].value();
      if (corners[k] >= mesh.positions.size()) throw extension.error("the compressed mesh has an index out of range");
    }
    mesh.triangles.push_back(corners);
  }
  set_tangents(mesh, values<glm::vec4>(source, attributes, "TANGENT"), surface.tangent_turn);
  if (!joints.empty()) apply_skin(source, attributes, joints, mesh);
  return mesh;
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
