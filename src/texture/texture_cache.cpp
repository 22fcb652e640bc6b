// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "texture/texture_cache.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "texture/texel_reader.h"

namespace lanthorn {

namespace {

int tiles_along(int texels) { return (texels + tile_side - 1) / tile_side; }

std::uint32_t checksum(const void* bytes, std::size_t count) {
  return static_cast<std::uint32_t>(crc32_z(0, static_cast<const Bytef*>(bytes), count));
}

}  // namespace

class TextureCache::Image {
 public:
  struct Level {
    int columns = 0, rows = 0;  // of tiles
    std::uint64_t begin = 0;    // in the file
    std::vector<std::uint32_t> checksums;
    std::vector<std::byte> band;  // rows of texels that wait for their tiles

    std::size_t number(int column, int row) const {
      return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
    }
  };

  std::string name;
  SourceLocation location;
  TiledImage tiled;
  std::vector<Level> levels;
  void* handle = nullptr;  // in the cache of tiles
};

namespace {

// Writes rows of texels as tiles.
class TileWriter {
 public:
  using Level = TextureCache::Image::Level;

  TileWriter(ScratchFile& file, TextureCache::Image& image)
      : file_(file), image_(image), tile_(image.tiled.tile_bytes()) {
    for (std::size_t i = 0; i < image.levels.size(); ++i) image.levels[i].band.resize(row_bytes(i) * tile_side);
  }

  void add(std::size_t i, int y, const std::byte* row) {
    Level& level = image_.levels[i];
    const auto in_band = static_cast<std::size_t>(y % tile_side);
    std::memcpy(level.band.data() + in_band * row_bytes(i), row, row_bytes(i));
    const bool is_last = y + 1 == level_size(image_.tiled.height, static_cast<int>(i));
    if (in_band + 1 == tile_side || is_last) write_band(i, y / tile_side, in_band + 1);
    if (is_last) level.band = {};
  }

 private:
  std::size_t row_bytes(std::size_t i) const {
    return image_.tiled.texel_bytes() * static_cast<std::size_t>(level_size(image_.tiled.width, static_cast<int>(i)));
  }
  void write_band(std::size_t i, int tile_row, std::size_t rows) {
    Level& level = image_.levels[i];
    const std::size_t row = row_bytes(i), tile_row_bytes = tile_side * image_.tiled.texel_bytes();
    for (int x = 0; x < level.columns; ++x) {
      const std::size_t left = static_cast<std::size_t>(x) * tile_row_bytes;
      const std::size_t there = std::min(tile_row_bytes, row - left);
      std::fill(tile_.begin(), tile_.end(), std::byte{});
      for (std::size_t y = 0; y < rows; ++y)
        std::memcpy(tile_.data() + y * tile_row_bytes, level.band.data() + y * row + left, there);
      const auto number = level.number(x, tile_row);
      level.checksums[number] = checksum(tile_.data(), tile_.size());
      file_.write(level.begin + number * tile_.size(), tile_);
    }
  }

  ScratchFile& file_;
  TextureCache::Image& image_;
  std::vector<std::byte> tile_;
};

}  // namespace

TextureCache::TextureCache(std::uint64_t bytes) : bytes_(bytes), tiles_(image_codec().make_tile_cache(bytes)) {}

TextureCache::~TextureCache() = default;

std::uint64_t TextureCache::disk_bytes(const TextureFormat& format, int levels) {
  std::uint64_t tiles = 0;
  for (int level = 0; level < levels; ++level)
    tiles += static_cast<std::uint64_t>(tiles_along(level_size(format.width, level))) *
             static_cast<std::uint64_t>(tiles_along(level_size(format.height, level)));
  return tiles * tile_side * tile_side * format.texel_bytes();
}

std::uint64_t TextureCache::reserve(std::uint64_t bytes) {
  const std::scoped_lock lock(mutex_);
  return std::exchange(end_, end_ + bytes);
}

std::uint64_t TextureCache::bytes_on_disk() const {
  const std::scoped_lock lock(mutex_);
  return end_;
}

const TextureCache::Image& TextureCache::add(TexelReader& reader, int levels,
                                             const std::function<void(const std::byte* row)>& sees_row,
                                             const SourceLocation& location) {
  const TextureFormat& format = reader.format();
  auto made = std::make_unique<Image>();
  Image& image = *made;
  image.name = reader.what();
  image.location = location;
  image.tiled = {format.width,
                 format.height,
                 format.channels,
                 levels,
                 format.is_8_bit ? SampleType::uint8 : SampleType::float32,
                 {}};
  std::uint64_t begin = reserve(disk_bytes(format, levels));
  for (int i = 0; i < levels; ++i) {
    Image::Level& level = image.levels.emplace_back();
    level.columns = tiles_along(level_size(format.width, i));
    level.rows = tiles_along(level_size(format.height, i));
    level.begin = begin;
    level.checksums.resize(static_cast<std::size_t>(level.columns) * static_cast<std::size_t>(level.rows));
    begin += level.checksums.size() * image.tiled.tile_bytes();
  }
  TileWriter tiles(file_, image);
  LevelMaker maker(format, levels,
                   [&](int level, int y, const std::byte* row) { tiles.add(static_cast<std::size_t>(level), y, row); });
  reader.read_rows([&](const std::byte* row) {
    sees_row(row);
    maker.add(row);
  });
  image.tiled.read_tile = [this, &image](int level, int x, int y, void* texels) {
    return read_tile(image, level, x, y, texels);
  };
  image.handle = image_codec().add_image(tiles_.get(), image.tiled);
  const std::scoped_lock lock(mutex_);
  images_.push_back(std::move(made));
  return image;
}

bool TextureCache::read_tile(const Image& image, int i, int x, int y, void* texels) const {
  const Image::Level& level = image.levels[static_cast<std::size_t>(i)];
  const std::size_t bytes = image.tiled.tile_bytes();
  const auto number = level.number(x, y);
  const char* problem = nullptr;
  if (!file_.read(level.begin + number * bytes, {static_cast<std::byte*>(texels), bytes}))
    problem = "cannot be read";
  else if (checksum(texels, bytes) != level.checksums[number])
    problem = "is damaged";
  if (problem == nullptr) return true;
  note({image.location, image.name + ": a tile of it in the temporary file in " + file_.folder().string() + " " +
                            problem + ": check that disk"});
  return false;
}

void TextureCache::note(Error problem) const {
  const std::scoped_lock lock(mutex_);
  if (!problem_) problem_ = std::move(problem);
}

std::optional<Error> TextureCache::problem() const {
  const std::scoped_lock lock(mutex_);
  return problem_;
}

void TextureCache::read(const Image& image, int level, std::span<const TexelPlace> places, std::byte* texels) const {
  if (image_codec().read_texels(tiles_.get(), image.handle, level, places, texels)) return;
  std::memset(texels, 0, places.size() * image.tiled.texel_bytes());
  note({image.location, image.name + ": a tile of it cannot be read"});
}

TileCacheCounts TextureCache::counts() const { return image_codec().count_tiles(tiles_.get()); }

}  // namespace lanthorn
