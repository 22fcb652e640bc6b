// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
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
  std::size_t uv_set = 0;                           ///< the TEXCOORD_n that its textures use
};

/// Builds each material of the file once, when it is first used.
class Materials {
 public:
  explicit Materials(Document& document) : document_(document) {}

  /// The material of a primitive, by its member "material", or the default material.
  const Surface& of(const Value& primitive);
  /// True if a material with emission that is not textured has been built.
  bool has_lamps() const { return has_lamps_; }

 private:
  Surface make(const Value& material);

  Document& document_;
  std::map<std::size_t, Surface> made_;
  std::optional<Surface> default_;
  bool has_lamps_ = false;
};

}  // namespace lanthorn::gltf
