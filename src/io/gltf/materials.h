// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "io/gltf/document.h"
#include "io/metallic_roughness.h"

namespace lanthorn::gltf {

/// The properties that a material gives to its shapes.
struct Surface {
  description::Index material = 0;
  std::optional<description::Index> area_light;
  description::FloatParameter alpha{1, {}};
  std::optional<description::Index> inside_medium;  ///< into SceneDescription::media
  std::size_t uv_set = 0;                           ///< its textures use TEXCOORD_n
  float tangent_turn = 0;                           ///< radians from the mesh's tangents to the direction of anisotropy
};

/// Builds each material of the file once, on its first use.
class Materials {
 public:
  explicit Materials(Document& document) : document_(document) {}

  /// True for the names of the extensions that are read here.
  static bool reads_extension(std::string_view name);

  /// Selects a variant of the file (KHR_materials_variants), an index of its list.
  void choose_variant(std::size_t variant) { variant_ = variant; }
  /// The material of a primitive: the one of the chosen variant, that of its member "material", or the default
  /// material.
  const Surface& of(const Value& primitive);
  /// The area lights that may illuminate the scene. Excludes lights of unlit materials, and of materials with textured
  /// emission (a texture may be black except for a few spots).
  const std::vector<description::Index>& lamps() const { return lamps_; }
  /// True if one of them is metal or glass that shows what is around it.
  bool reflect_surroundings() const { return reflect_surroundings_; }
  /// Those materials of the scene that are not double-sided.
  const std::set<description::Index>& one_sided() const { return one_sided_; }

 private:
  std::optional<Value> reference_of(const Value& primitive) const;
  Surface make(const Value& material, bool has_colors);

  Document& document_;
  // Key: the material's index, -1 for the default, and whether the primitive has vertex colours.
  std::map<std::pair<std::int64_t, bool>, Surface> made_;
  std::vector<description::Index> lamps_;
  std::set<description::Index> one_sided_;
  std::optional<std::size_t> variant_;
  bool reflect_surroundings_ = false;
};

/// The image texture of a textureInfo (glTF 2.0 §3.8, KHR_texture_transform) and the texture coordinates it uses.
/// Meshes store (u, 1 - v), so that t points up.
struct TextureUse {
  /// nullopt if the image is missing and skipped, or in an unsupported format (warning): a neutral value that depends
  /// on the texture's use replaces it.
  std::optional<description::ImageTexture> image;
  std::size_t uv_set = 0;
};

/// nullopt if `owner` has no such texture.
std::optional<TextureUse> find_texture(Document& document, const Value& owner, std::string_view key);

}  // namespace lanthorn::gltf
