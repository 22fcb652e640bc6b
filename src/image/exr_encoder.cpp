// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// "OpenEXR File Layout" and "Technical Introduction to OpenEXR" (openexr.com), version 2 of the format, single part.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <new>
#include <numeric>
#include <string_view>

#include "base/bytes.h"
#include "base/parallel.h"
#include "image/own_formats.h"
#include "lanthorn/error.h"
#include "lanthorn/packed_float.h"
#include "spectrum/rgb_matrix.h"

namespace lanthorn {

namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::uint32_t magic_number = 20000630, format_version = 2, has_long_names = 0x400;
constexpr std::size_t longest_short_name = 31, longest_name = 255;
constexpr std::int32_t type_half = 1, type_float = 2;
constexpr unsigned char compression_zip = 3, increasing_y = 0;
constexpr int lines_per_chunk = 16;  // of ZIP compression

void append_text(Bytes& out, std::string_view text) {
  out.insert(out.end(), text.begin(), text.end());
  out.push_back(0);
}

template <class Value>
void append_attribute(Bytes& out, std::string_view name, std::string_view type, const Value& value) {
  append_text(out, name);
  append_text(out, type);
  append_number(out, static_cast<std::int32_t>(std::size(value) * sizeof(value[0])));
  for (const auto& part : value) append_number(out, part);
}

// The file stores channels in order of their names. A channel without a name would end the list of channels.
std::string channel_name(const std::string& name) { return name.empty() ? "Y" : name; }
std::vector<std::size_t> sorted_channels(const Image& image) {
  std::vector<std::size_t> order(image.channel_count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return channel_name(image.channels[a]) < channel_name(image.channels[b]);
  });
  return order;
}

Bytes list_of_channels(const Image& image, const std::vector<std::size_t>& order) {
  Bytes list;
  for (const std::size_t c : order) {
    append_text(list, channel_name(image.channels[c]));
    append_number(list, is_noise_channel(image.channels[c]) ? type_half : type_float);
    append_number(list, std::uint32_t{0});               // not for perceptually linear compression
    for (int i = 0; i < 2; ++i) append_number(list, 1);  // one sample per column and line
  }
  list.push_back(0);
  return list;
}

void append_own_attribute(Bytes& out, const ImageAttribute& attribute) {
  if (const auto* const text = std::get_if<std::string>(&attribute.value))
    append_attribute(out, attribute.name, "string", *text);
  else if (const auto* const integer = std::get_if<int>(&attribute.value))
    append_attribute(out, attribute.name, "int", std::array{*integer});
  else
    append_attribute(out, attribute.name, "float", std::array{std::get<float>(attribute.value)});
}

Bytes header_of(const Image& image, const std::vector<std::size_t>& order,
                const std::vector<ImageAttribute>& attributes) {
  std::size_t longest = 0;
  for (const std::string& channel : image.channels) longest = std::max(longest, channel.size());
  for (const ImageAttribute& attribute : attributes) longest = std::max(longest, attribute.name.size());
  if (longest > longest_name) throw Error("cannot write: OpenEXR has no names of more than 255 characters");
  Bytes header;
  append_number(header, magic_number);
  append_number(header, longest > longest_short_name ? format_version | has_long_names : format_version);
  const ImageWindow& window = image.window;
  const int full_width = window.full_width > 0 ? window.full_width : image.width;
  const int full_height = window.full_height > 0 ? window.full_height : image.height;
  append_attribute(header, "channels", "chlist", list_of_channels(image, order));
  append_attribute(header, "chromaticities", "chromaticities", rec709_chromaticities);
  append_attribute(header, "compression", "compression", std::array{compression_zip});
  append_attribute(header, "dataWindow", "box2i",
                   std::array{window.x, window.y, window.x + image.width - 1, window.y + image.height - 1});
  append_attribute(header, "displayWindow", "box2i", std::array{0, 0, full_width - 1, full_height - 1});
  append_attribute(header, "lineOrder", "lineOrder", std::array{increasing_y});
  append_attribute(header, "pixelAspectRatio", "float", std::array{1.0f});
  append_attribute(header, "screenWindowCenter", "v2f", std::array{0.0f, 0.0f});
  append_attribute(header, "screenWindowWidth", "float", std::array{1.0f});
  for (const ImageAttribute& attribute : attributes) append_own_attribute(header, attribute);
  header.push_back(0);
  return header;
}

std::size_t bytes_of_pixel(const Image& image) {
  std::size_t bytes = 0;
  for (const std::string& channel : image.channels)
    bytes += is_noise_channel(channel) ? sizeof(std::uint16_t) : sizeof(float);
  return bytes;
}

template <class Value>
unsigned char* put(Value value, unsigned char* to) {
  return std::copy_n(reinterpret_cast<const unsigned char*>(&value), sizeof(value), to);
}

// Line by line, channel by channel.
Bytes pixels_of_lines(const Image& image, const std::vector<std::size_t>& order, int begin, int end) {
  Bytes bytes(static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(image.width) * bytes_of_pixel(image));
  unsigned char* to = bytes.data();
  for (int y = begin; y < end; ++y)
    for (const std::size_t c : order) {
      const float* from = image.pixels.data() + image.index(0, y, c);
      const bool is_half = is_noise_channel(image.channels[c]);
      for (int x = 0; x < image.width; ++x, from += image.channel_count())
        to = is_half ? put(encode_finite_half(*from), to) : put(*from, to);
    }
  return bytes;
}

// Reorders bytes (even positions before odd ones), replaces each byte by its difference from the previous one plus 128,
// and compresses. Data that would not shrink is stored unchanged.
Bytes compressed(const Bytes& raw) {
  Bytes split(raw.size());
  const std::size_t evens = (raw.size() + 1) / 2;
  for (std::size_t i = 0; i < evens; ++i) split[i] = raw[2 * i];
  for (std::size_t i = 0; i < raw.size() / 2; ++i) split[evens + i] = raw[2 * i + 1];
  for (std::size_t i = split.size(); i-- > 1;) split[i] = static_cast<unsigned char>(split[i] - split[i - 1] + 128);
  constexpr int level = 4;  // as in OpenEXR 3.1: higher levels cost more time than the space they save is worth
  uLongf size = compressBound(split.size());
  Bytes result(size);
  if (compress2(result.data(), &size, split.data(), split.size(), level) != Z_OK) throw std::bad_alloc();
  if (size >= raw.size()) return raw;
  result.resize(size);
  return result;
}

}  // namespace

std::vector<unsigned char> encode_openexr(const Image& image, const std::vector<ImageAttribute>& attributes) {
  const std::vector<std::size_t> order = sorted_channels(image);
  const double chunk_bytes =
      static_cast<double>(lines_per_chunk) * image.width * static_cast<double>(bytes_of_pixel(image));
  if (image.width < 1 || image.height < 1 || chunk_bytes > std::numeric_limits<std::int32_t>::max())
    throw Error("cannot write: OpenEXR has no images of " + std::to_string(image.width) + " x " +
                std::to_string(image.height) + " pixels with " + std::to_string(image.channel_count()) + " channels");
  Bytes file = header_of(image, order, attributes);
  std::vector<Bytes> chunks(static_cast<std::size_t>((image.height + lines_per_chunk - 1) / lines_per_chunk));
  const StopScope not_stopped(nullptr);  // a picture is also saved after a signal
  parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t i) {
    const int begin = static_cast<int>(i) * lines_per_chunk;
    chunks[i] = compressed(pixels_of_lines(image, order, begin, std::min(begin + lines_per_chunk, image.height)));
  });
  constexpr std::size_t chunk_header = 2 * sizeof(std::int32_t);
  std::uint64_t place = file.size() + chunks.size() * sizeof(std::uint64_t);
  for (const Bytes& chunk : chunks) {
    append_number(file, place);
    place += chunk_header + chunk.size();
  }
  file.reserve(place);
  int line = image.window.y;
  for (const Bytes& chunk : chunks) {
    append_number(file, line);
    append_number(file, static_cast<std::int32_t>(chunk.size()));
    file.insert(file.end(), chunk.begin(), chunk.end());
    line += lines_per_chunk;
  }
  return file;
}

}  // namespace lanthorn
