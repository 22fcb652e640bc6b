// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What decodes image files: a module that alone links OpenImageIO, and is loaded when it is first asked for.
#pragma once

#include <cstdint>
#include <functional>
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

/// What an image file says of its pixels.
struct ImageHeader {
  int width = 0, height = 0;
  int depth = 1;  ///< slices; more than 1 in a volume
  ImageWindow window;
  std::vector<std::string> channels;
  int alpha_channel = -1, z_channel = -1;  ///< -1: none
  SampleType samples = SampleType::float32;
  std::uint64_t pixel_bytes = 0;  ///< of a pixel in memory, as the file stores it
  bool deep = false;              ///< any number of samples a pixel
  std::vector<ImageAttribute> attributes;
};

/// An image file in memory whose header has been read.
struct OpenImage {
  ImageHeader header;
  /// Reads the first `channels` of all pixels, interleaved, as float32, or as uint8 if the file has these.
  std::function<void(int channels, SampleType as, void* pixels)> read;
};

/// Colours of a picture, interleaved R, G, B, rows from the top.
struct CodecColors {
  int width = 0, height = 0;
  SampleType samples = SampleType::uint8;  ///< or uint16
  const void* pixels = nullptr;
};

/// `format` is OpenImageIO's name of a format ("openexr"). What fails throws a std::exception that says why.
struct ImageCodec {
  /// `bytes` must outlive what is returned.
  OpenImage (*open)(std::string_view bytes, const char* format);
  /// A file with a text for its attribute ImageDescription.
  std::vector<unsigned char> (*encode)(const char* format, const CodecColors& colors, const std::string& text);
  /// Linear Rec.709 to display values, in place: by a view of the OpenColorIO configuration in the file `config`; empty
  /// names are its defaults.
  void (*apply_view)(const std::string& config, const std::string& display, const std::string& view, int width,
                     int height, float* colors);
  /// Decodes OpenEXR with the calling thread alone from now on.
  void (*use_one_thread)();
  /// Version of OpenImageIO, such as "2.4.7".
  std::string (*version)();
};

/// The function of the module that returns its codec.
constexpr const char* image_codec_symbol = "lanthorn_image_codec";
using ImageCodecFunction = const ImageCodec* (*)();

/// Loads the module if this has not been done. Throws Error if it cannot be loaded.
const ImageCodec& image_codec();

}  // namespace lanthorn
