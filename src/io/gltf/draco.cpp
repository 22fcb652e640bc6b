// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/draco.h"

#include <draco/compression/decode.h>

#include <cmath>
#include <string>

#include "io/gltf/tangents.h"

namespace lanthorn::gltf {

namespace {

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
                description::TriangleMesh& mesh) {
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

}  // namespace

description::TriangleMesh decode_draco(Document& document, const Value& extension, const Surface& surface,
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
  description::TriangleMesh mesh;
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

}  // namespace lanthorn::gltf
