// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Decodes image files in a module that alone links OpenImageIO and is loaded on first use.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "lanthorn/image.h"

namespace lanthorn {

enum class SampleType : std::uint8_t { uint8, uint16, half, float32, other };

struct ImageAttribute {
  std::string name;
  std::variant<int, float, std::string> value;
};

/// Properties of an image's pixels according to its header.
struct ImageHeader {
  int width = 0, height = 0;
  int depth = 1;  ///< slices; more than 1 in a volume
  ImageWindow window;
  std::vector<std::string> channels;
  int alpha_channel = -1, z_channel = -1;  ///< -1: none
  SampleType samples = SampleType::float32;
  std::uint64_t pixel_bytes = 0;  ///< of a pixel in memory, in the file's sample type
  bool deep = false;              ///< any number of samples per pixel
  int row_step = 1;               ///< rows that are decoded together: the height of tiles or strips
  /// CIE 1931 x and y of red, green, blue and white, if the file states them.
  std::optional<std::array<float, 8>> chromaticities;
  std::vector<ImageAttribute> attributes;
};

/// An image file whose header has been read.
struct OpenImage {
  ImageHeader header;
  /// Reads the first `channels` of all pixels, interleaved, as float32, or as uint8 if the file stores uint8.
  std::function<void(int channels, SampleType as, void* pixels)> read;
  /// Reads rows [first, end) in the same way. Rows must be read in order; `first` must be a multiple of
  /// `ImageHeader::row_step`, and so must `end` unless it is the height. Empty for formats that are read as a whole.
  std::function<void(int first, int end, int channels, SampleType as, void* pixels)> read_rows;
};

/// Colours of a picture, interleaved R, G, B, rows from the top.
struct CodecColors {
  int width = 0, height = 0;
  SampleType samples = SampleType::uint8;  ///< or uint16
  const void* pixels = nullptr;
};

/// An image in tiles of `tile_side` x `tile_side` texels, with coarser levels: each has half the columns and rows of
/// the level before it, rounded up. Tiles at the right and lower edges are padded.
inline constexpr int tile_side = 64;
struct TiledImage {
  int width = 0, height = 0, channels = 0, levels = 1;
  SampleType samples = SampleType::uint8;  ///< or float32
  /// Reads the tile in column x and row y of a level. Returns false if it cannot be read.
  std::function<bool(int level, int x, int y, void* texels)> read_tile;

  std::size_t texel_bytes() const {
    return static_cast<std::size_t>(channels) * (samples == SampleType::uint8 ? 1 : sizeof(float));
  }
  std::size_t tile_bytes() const { return texel_bytes() * tile_side * tile_side; }
};
/// Columns or rows of a level of an image that has `size` of them at level 0.
constexpr int level_size(int size, int level) {
  return static_cast<int>(((std::int64_t{1} << level) + size - 1) >> level);
}

struct TexelPlace {
  int column = 0, row = 0;  ///< within the level
};

/// Statistics of a tile cache.
struct TileCacheCounts {
  std::uint64_t tiles_read = 0, bytes_read = 0;
};

/// `format` is OpenImageIO's name of a format ("openexr"). Failures throw a std::exception that states the reason.
struct ImageCodec {
  /// `bytes` must outlive the result.
  OpenImage (*open)(std::string_view bytes, const char* format);
  /// Like `open`, for a file on disk.
  OpenImage (*open_file)(std::shared_ptr<std::FILE> file, const char* format);
  /// Encodes a file with `text` as its attribute ImageDescription.
  std::vector<unsigned char> (*encode)(const char* format, const CodecColors& colors, const std::string& text);
  /// Converts linear Rec.709 to display values, in place, by a view of the OpenColorIO configuration in the file
  /// `config`; empty names select its defaults.
  void (*apply_view)(const std::string& config, const std::string& display, const std::string& view, int width,
                     int height, float* colors);
  /// From now on, only the calling thread decodes, encodes and converts. Briefly starts a thread for each further core.
  void (*use_one_thread)();
  /// Version of OpenImageIO, such as "2.4.7".
  std::string (*version)();

  /// OpenImageIO's tile cache with a capacity of `bytes`. Several threads may use it.
  std::shared_ptr<void> (*make_tile_cache)(std::uint64_t bytes);
  /// Adds an image, which must outlive the cache; returns its handle.
  void* (*add_image)(void* cache, const TiledImage& image);
  /// Copies texels of a level, consecutively. Returns false if a tile cannot be read.
  bool (*read_texels)(void* cache, void* image, int level, std::span<const TexelPlace> places, void* texels);
  TileCacheCounts (*count_tiles)(void* cache);
};

/// The function of the module that returns its codec.
constexpr const char* image_codec_symbol = "lanthorn_image_codec";
using ImageCodecFunction = const ImageCodec* (*)();

/// Loads the module on first use. Throws Error if it cannot be loaded.
const ImageCodec& image_codec();

}  // namespace lanthorn
