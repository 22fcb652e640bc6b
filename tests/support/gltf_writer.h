// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Makes small glTF files. Everything goes into one buffer.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "math/vec.h"

namespace lanthorn::test {

inline std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

class GltfWriter {
 public:
  nlohmann::json root = {{"asset", {{"version", "2.0"}, {"generator", "Lanthorn's tests"}}}};

  /// Appends to one of the root's arrays. Returns the index of the new element.
  std::size_t add(const std::string& array, nlohmann::json element) {
    root[array].push_back(std::move(element));
    return root[array].size() - 1;
  }

  /// A buffer view, aligned to 4 bytes.
  std::size_t view(std::string_view bytes, std::optional<std::size_t> stride = {}) {
    buffer_.resize((buffer_.size() + 3) / 4 * 4);
    nlohmann::json view = {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}};
    if (stride) view["byteStride"] = *stride;
    buffer_ += bytes;
    return add("bufferViews", view);
  }

  /// An accessor of tightly packed numbers.
  template <class T>
  std::size_t accessor(const std::vector<T>& values, std::size_t components, bool normalized = false) {
    return add("accessors", description<T>(view(bytes_of(values)), values.size() / components, components, normalized));
  }
  /// Like `accessor`, with `padding` bytes after each element.
  template <class T>
  std::size_t padded_accessor(const std::vector<T>& values, std::size_t components, bool normalized,
                              std::size_t padding) {
    const std::string packed = bytes_of(values);
    const std::size_t size = components * sizeof(T);
    std::string bytes;
    for (std::size_t at = 0; at < packed.size(); at += size)
      bytes += packed.substr(at, size) + std::string(padding, '\x55');
    return add("accessors",
               description<T>(view(bytes, size + padding), values.size() / components, components, normalized));
  }
  template <class T>
  static nlohmann::json description(std::optional<std::size_t> view, std::size_t count, std::size_t components,
                                    bool normalized) {
    constexpr int type = std::is_same_v<T, float>           ? 5126
                         : std::is_same_v<T, std::uint32_t> ? 5125
                         : std::is_same_v<T, std::uint16_t> ? 5123
                         : std::is_same_v<T, std::int16_t>  ? 5122
                         : std::is_same_v<T, std::uint8_t>  ? 5121
                                                            : 5120;
    const std::vector<const char*> shapes = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    nlohmann::json value = {{"componentType", type}, {"count", count}, {"type", shapes.at(components)}};
    if (view) value["bufferView"] = *view;
    if (normalized) value["normalized"] = true;
    return value;
  }

  /// An accessor of positions, with the bounds that glTF requires.
  std::size_t positions(const std::vector<Point>& points) {
    const std::size_t index = accessor(flat(points), 3);
    Bounds bounds;
    for (const Point& p : points) bounds.extend(p);
    root["accessors"][index]["min"] = {bounds.min.x, bounds.min.y, bounds.min.z};
    root["accessors"][index]["max"] = {bounds.max.x, bounds.max.y, bounds.max.z};
    return index;
  }
  template <class V>
  static std::vector<float> flat(const std::vector<V>& values) {
    std::vector<float> numbers;
    for (const V& v : values)
      for (int k = 0; k < V::length(); ++k) numbers.push_back(v[k]);
    return numbers;
  }

  /// A mesh of one primitive.
  std::size_t mesh(const std::vector<Point>& points, const std::vector<std::uint32_t>& indices,
                   std::optional<std::size_t> material = {}) {
    nlohmann::json primitive = {{"attributes", {{"POSITION", positions(points)}}}, {"indices", accessor(indices, 1)}};
    if (material) primitive["material"] = *material;
    return add("meshes", {{"primitives", nlohmann::json::array({primitive})}});
  }
  /// A node that is a root of the scene.
  std::size_t node(nlohmann::json members) {
    const std::size_t index = add("nodes", std::move(members));
    root["scenes"][0]["nodes"].push_back(index);
    root["scene"] = 0;
    return index;
  }

  /// The buffer's bytes, for a separate file.
  const std::string& buffer() const { return buffer_; }
  /// JSON text whose buffer is a data URI, or the file `uri`.
  std::string text(const std::string& uri = "") const {
    nlohmann::json copy = root;
    if (!buffer_.empty())
      copy["buffers"] = {{{"byteLength", buffer_.size()},
                          {"uri", uri.empty() ? "data:application/octet-stream;base64," + base64(buffer_) : uri}}};
    return copy.dump(1);
  }
  /// The file as a binary container (.glb).
  std::string binary() const {
    nlohmann::json copy = root;
    if (!buffer_.empty()) copy["buffers"] = {{{"byteLength", buffer_.size()}}};
    std::string text = copy.dump(), data = buffer_;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4, '\0');
    std::string chunks = word(text.size()) + "JSON" + text;
    if (!data.empty()) chunks += word(data.size()) + std::string("BIN\0", 4) + data;
    return "glTF" + word(2) + word(chunks.size() + 12) + chunks;
  }

 private:
  static std::string word(std::size_t value) {
    return bytes_of(std::vector<std::uint32_t>{static_cast<std::uint32_t>(value)});
  }

  std::string buffer_;
};

/// Triangles of a sphere centred at the origin, facing outwards.
struct SphereMesh {
  std::vector<Point> positions;
  std::vector<std::uint32_t> indices;
};
inline SphereMesh sphere_mesh(float radius, std::uint32_t rings, std::uint32_t segments) {
  SphereMesh mesh;
  for (std::uint32_t i = 0; i <= rings; ++i)
    for (std::uint32_t k = 0; k <= segments; ++k) {
      const float theta = pi * static_cast<float>(i) / static_cast<float>(rings);
      const float phi = 2 * pi * static_cast<float>(k % segments) / static_cast<float>(segments);
      const float sin = i == 0 || i == rings ? 0 : std::sin(theta);
      mesh.positions.push_back(radius * Point(sin * std::cos(phi), std::cos(theta), -sin * std::sin(phi)));
    }
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t k = 0; k < segments; ++k) {
      const std::uint32_t a = i * (segments + 1) + k, b = a + segments + 1;
      if (i > 0) mesh.indices.insert(mesh.indices.end(), {a, b, a + 1});
      if (i + 1 < rings) mesh.indices.insert(mesh.indices.end(), {a + 1, b, b + 1});
    }
  return mesh;
}

}  // namespace lanthorn::test
