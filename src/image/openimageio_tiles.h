// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The module's tile cache: implements the functions of `ImageCodec` with these names.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "image/image_codec.h"

namespace lanthorn {

std::shared_ptr<void> make_tile_cache(std::uint64_t bytes);
void* add_image(void* cache, const TiledImage& image);
bool read_texels(void* cache, void* image, int level, std::span<const TexelPlace> places, void* texels);
TileCacheCounts count_tiles(void* cache);

}  // namespace lanthorn
