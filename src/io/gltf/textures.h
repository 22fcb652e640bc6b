// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "io/gltf/document.h"

namespace lanthorn::gltf {

/// The image texture of a textureInfo (glTF 2.0 §3.8, KHR_texture_transform) and the texture coordinates it uses.
/// Meshes keep (u, 1 - v), so that t runs upwards.
struct TextureUse {
  /// None if the image is missing and left out, or in a format that is not supported (warning): a neutral value stands
  /// in, which depends on what the texture is for.
  std::optional<description::ImageTexture> image;
  std::size_t uv_set = 0;
};

/// Empty if `owner` has no such texture.
std::optional<TextureUse> find_texture(Document& document, const Value& owner, std::string_view key);

}  // namespace lanthorn::gltf
