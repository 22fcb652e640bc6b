// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "lanthorn/error.h"
#include "texture/image_texture.h"
#include "texture/texture_cache.h"

namespace lanthorn {

/// The memory of a scene's textures: decides which images stay in memory, and owns the cache of the other images.
/// Shared by a scene and its edited copies. Whatever it decides, the picture is the same.
class TextureMemory {
 public:
  /// `bound`: bytes of all images together; by default half of the memory that is free when the bound is first needed.
  explicit TextureMemory(std::optional<std::uint64_t> bound) : bound_(bound) {}

  /// For each image that is about to be read, true if it goes through the cache. No image does if all fit; otherwise
  /// the smallest images take half of the memory, and the rest go through the cache. Throws Error if their tiles do not
  /// fit on the disk.
  std::vector<bool> plan(const std::vector<TextureImage::Need>& needs);
  /// Null as long as no image goes through the cache.
  const std::shared_ptr<TextureCache>& cache() const { return cache_; }

 private:
  std::optional<std::uint64_t> bound_;
  std::uint64_t used_ = 0;  // by images in memory
  std::shared_ptr<TextureCache> cache_;
};

/// Half of the free memory; the largest number if the free memory is unknown.
std::uint64_t default_texture_memory();

}  // namespace lanthorn
