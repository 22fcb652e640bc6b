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
  description::ImageTexture image;
  std::size_t uv_set = 0;
};

/// Empty if `owner` has no such texture, or one in a format that is not supported (warning).
std::optional<TextureUse> find_texture(Document& document, const Value& owner, std::string_view key);

}  // namespace lanthorn::gltf
