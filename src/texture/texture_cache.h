// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Images that do not fit into memory: tiles in a nameless temporary file, with a cache of bounded size for the tiles in
// use.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/scratch_file.h"
#include "image/image_codec.h"
#include "lanthorn/error.h"
#include "texture/texture_format.h"

namespace lanthorn {

class TexelReader;

/// May be used by several threads.
class TextureCache {
 public:
  class Image;

  /// `bytes`: memory for tiles.
  explicit TextureCache(std::uint64_t bytes);
  ~TextureCache();
  TextureCache(const TextureCache&) = delete;
  TextureCache& operator=(const TextureCache&) = delete;

  /// Reads all rows of the image and writes the tiles of its first `levels` levels. The image lives as long as the
  /// cache. `sees_row(row)` is called for each row of texels. Throws Error with `location` if the image is damaged, or
  /// naming the folder if the disk is full.
  const Image& add(TexelReader& reader, int levels, const std::function<void(const std::byte* row)>& sees_row,
                   const SourceLocation& location);
  /// Copies stored texels of a level, one behind the other. Texels that cannot be read become 0, and `problem` reports
  /// why.
  void read(const Image& image, int level, std::span<const TexelPlace> places, std::byte* texels) const;

  /// The first tile that could not be read. It is recorded instead of thrown, because tiles are looked up in the middle
  /// of a ray.
  std::optional<Error> problem() const;
  TileCacheCounts counts() const;
  std::uint64_t bytes() const { return bytes_; }
  std::uint64_t bytes_on_disk() const;

  /// Bytes on disk of the first `levels` levels.
  static std::uint64_t disk_bytes(const TextureFormat& format, int levels);

 private:
  bool read_tile(const Image& image, int level, int x, int y, void* texels) const;
  std::uint64_t reserve(std::uint64_t bytes);
  void note(Error problem) const;

  std::uint64_t bytes_;
  ScratchFile file_;
  mutable std::mutex mutex_;
  std::uint64_t end_ = 0;  // end of the reserved part of the file
  std::vector<std::unique_ptr<Image>> images_;
  mutable std::optional<Error> problem_;
  std::shared_ptr<void> tiles_;  // destroyed first: it asks for tiles of images
};

}  // namespace lanthorn
