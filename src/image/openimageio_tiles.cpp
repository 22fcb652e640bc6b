// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "image/openimageio_tiles.h"

#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/imageio.h>

#include <atomic>
#include <cstddef>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

namespace lanthorn {

namespace {

constexpr const char* image_attribute = "lanthorn:image";

/// Supplies OpenImageIO's cache with the tiles of a TiledImage, whose address is passed as a configuration attribute.
class TileInput final : public OIIO::ImageInput {
 public:
  static OIIO::ImageInput* create() { return new TileInput; }

  const char* format_name() const override { return "lanthorn tiles"; }
  bool open(const std::string& /*name*/, OIIO::ImageSpec& /*spec*/) override { return false; }
  bool open(const std::string& /*name*/, OIIO::ImageSpec& spec, const OIIO::ImageSpec& config) override {
    if (!config.getattribute(image_attribute, OIIO::TypeDesc::PTR, &image_) || image_ == nullptr) return false;
    if (!seek_subimage(0, 0)) return false;
    spec = m_spec;
    return true;
  }
  bool close() override { return true; }
  int current_miplevel() const override { return level_; }
  bool seek_subimage(int subimage, int level) override {
    if (subimage != 0 || level < 0 || level >= image_->levels) return false;
    const OIIO::TypeDesc type = image_->samples == SampleType::uint8 ? OIIO::TypeUInt8 : OIIO::TypeFloat;
    m_spec =
        OIIO::ImageSpec(level_size(image_->width, level), level_size(image_->height, level), image_->channels, type);
    m_spec.tile_width = m_spec.tile_height = tile_side;
    m_spec.tile_depth = 1;
    level_ = level;
    return true;
  }
  bool read_native_scanline(int, int, int, int, void*) override { return false; }
  bool read_native_tile(int /*subimage*/, int level, int x, int y, int /*z*/, void* texels) override {
    return image_->read_tile(level, x / tile_side, y / tile_side, texels);
  }

 private:
  const TiledImage* image_ = nullptr;
  int level_ = 0;
};

struct CachedImage {
  OIIO::ImageCache::ImageHandle* handle = nullptr;
  std::size_t texel_bytes = 0;
};

using Perthread = OIIO::ImageCache::Perthread;

// OpenImageIO keeps what a thread last used under the address of the cache. It forgets that of the destroying thread
// alone, so a later cache at the same address would meet tiles and files that no longer exist. Hence each cache owns
// the records of its threads, and no two caches use the same name for an image.
class TileCache {
 public:
  TileCache() = default;
  TileCache(const TileCache&) = delete;
  TileCache& operator=(const TileCache&) = delete;
  ~TileCache() {
    for (const auto& [id, thread] : threads_) tiles->destroy_thread_info(thread);
  }

  Perthread* this_thread() {
    struct Last {
      std::uint64_t cache = 0;
      Perthread* thread = nullptr;
    };
    thread_local Last last;
    if (last.cache != number_) {
      const std::scoped_lock lock(mutex_);
      Perthread*& thread = threads_[std::this_thread::get_id()];
      if (thread == nullptr) thread = tiles->create_thread_info();
      last = {number_, thread};
    }
    return last.thread;
  }
  void* add(const TiledImage& image) {
    Perthread* const thread = this_thread();
    const std::scoped_lock lock(mutex_);
    const OIIO::ustring name("lanthorn-image-" + std::to_string(number_) + "-" + std::to_string(images_.size()));
    OIIO::ImageSpec config;
    const TiledImage* address = &image;
    config.attribute(image_attribute, OIIO::TypeDesc::PTR, &address);
    if (!tiles->add_file(name, TileInput::create, &config)) throw std::runtime_error(tiles->geterror());
    return &images_.emplace_back(CachedImage{tiles->get_image_handle(name, thread), image.texel_bytes()});
  }

  const std::unique_ptr<OIIO::ImageCache, void (*)(OIIO::ImageCache*)> tiles{
      OIIO::ImageCache::create(false), [](OIIO::ImageCache* cache) { OIIO::ImageCache::destroy(cache); }};

 private:
  static std::uint64_t next_number() {
    static std::atomic<std::uint64_t> count{0};
    return ++count;
  }

  const std::uint64_t number_ = next_number();  // from 1
  std::mutex mutex_;
  std::map<std::thread::id, Perthread*> threads_;
  std::deque<CachedImage> images_;  // a deque keeps addresses stable
};

TileCache& cache_of(void* cache) { return *static_cast<TileCache*>(cache); }

}  // namespace

std::shared_ptr<void> make_tile_cache(std::uint64_t bytes) {
  auto cache = std::make_shared<TileCache>();
  cache->tiles->attribute("max_memory_MB", static_cast<float>(static_cast<double>(bytes) / (1 << 20)));
  cache->tiles->attribute("max_open_files", 1 << 20);  // these are not actual files
  return cache;
}

void* add_image(void* cache, const TiledImage& image) { return cache_of(cache).add(image); }

bool read_texels(void* cache, void* image, int level, std::span<const TexelPlace> places, void* texels) {
  TileCache& all = cache_of(cache);
  OIIO::ImageCache& tiles = *all.tiles;
  const auto& [handle, texel_bytes] = *static_cast<const CachedImage*>(image);
  Perthread* const thread = all.this_thread();
  OIIO::ImageCache::Tile* tile = nullptr;
  const std::byte* in_tile = nullptr;
  TexelPlace of_tile{-1, -1};
  auto* out = static_cast<std::byte*>(texels);
  for (const TexelPlace& place : places) {
    const TexelPlace wanted{place.column / tile_side, place.row / tile_side};
    if (wanted.column != of_tile.column || wanted.row != of_tile.row) {
      if (tile != nullptr) tiles.release_tile(tile);
      tile = tiles.get_tile(handle, thread, 0, level, place.column, place.row, 0);
      if (tile == nullptr) return false;
      OIIO::TypeDesc type;
      in_tile = static_cast<const std::byte*>(tiles.tile_pixels(tile, type));
      of_tile = wanted;
      if (in_tile == nullptr) break;
    }
    const auto column = static_cast<std::size_t>(place.column % tile_side),
               row = static_cast<std::size_t>(place.row % tile_side), texel = row * tile_side + column;
    std::memcpy(out, in_tile + texel * texel_bytes, texel_bytes);
    out += texel_bytes;
  }
  if (tile != nullptr) tiles.release_tile(tile);
  return in_tile != nullptr;
}

TileCacheCounts count_tiles(void* cache) {
  const OIIO::ImageCache& tiles = *cache_of(cache).tiles;
  int created = 0;
  long long bytes = 0;
  tiles.getattribute("stat:tiles_created", OIIO::TypeDesc::INT, &created);
  tiles.getattribute("stat:bytes_read", OIIO::TypeDesc::INT64, &bytes);
  return {static_cast<std::uint64_t>(created), static_cast<std::uint64_t>(bytes)};
}

}  // namespace lanthorn
