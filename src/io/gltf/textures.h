// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "io/gltf/document.h"

namespace lanthorn::gltf {

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
