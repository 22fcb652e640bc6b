// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Portable Network Graphics, third edition (W3C 2025).
#include <zlib.h>

#include <algorithm>
#include <new>
#include <string_view>

#include "image/own_formats.h"

namespace lanthorn {

namespace {

using PngBytes = std::vector<unsigned char>;

void append_big_endian(PngBytes& out, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<unsigned char>(value >> shift));
}

// §5.3
void append_chunk(PngBytes& out, std::string_view type, std::span<const unsigned char> data) {
  append_big_endian(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  append_big_endian(out, static_cast<std::uint32_t>(crc32_z(0, out.data() + start, out.size() - start)));
}

// §9.2: each row stores its differences from the row above (filter type 2, Up).
PngBytes filtered(std::span<const std::uint8_t> colors, std::size_t row) {
  constexpr unsigned char filter_up = 2;
  PngBytes result;
  result.reserve(colors.size() + colors.size() / row);
  for (std::size_t at = 0; at < colors.size(); ++at) {
    if (at % row == 0) result.push_back(filter_up);
    result.push_back(static_cast<unsigned char>(colors[at] - (at < row ? 0 : colors[at - row])));
  }
  return result;
}

PngBytes deflated(const PngBytes& raw) {
  uLongf size = compressBound(raw.size());
  PngBytes result(size);
  if (compress2(result.data(), &size, raw.data(), raw.size(), Z_DEFAULT_COMPRESSION) != Z_OK) throw std::bad_alloc();
  result.resize(size);
  return result;
}

// §11.3.3.4: no compression, no language.
PngBytes international_text(const PngText& entry) {
  PngBytes data(entry.keyword.begin(), entry.keyword.end());
  data.resize(data.size() + 5);
  data.insert(data.end(), entry.text.begin(), entry.text.end());
  return data;
}

}  // namespace

std::vector<unsigned char> encode_png_colors(int width, std::span<const std::uint8_t> colors,
                                             const std::vector<PngText>& texts) {
  const std::size_t row = 3 * static_cast<std::size_t>(width);
  PngBytes file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'}, header;
  append_big_endian(header, static_cast<std::uint32_t>(width));
  append_big_endian(header, static_cast<std::uint32_t>(colors.size() / row));
  constexpr unsigned char bits = 8, true_color = 2;
  header.insert(header.end(), {bits, true_color, 0, 0, 0});
  append_chunk(file, "IHDR", header);
  constexpr unsigned char perceptual = 0;
  append_chunk(file, "sRGB", {&perceptual, 1});
  for (const PngText& entry : texts) append_chunk(file, "iTXt", international_text(entry));
  const PngBytes data = deflated(filtered(colors, row));
  constexpr std::size_t most = std::size_t{1} << 30;  // per chunk
  for (std::size_t at = 0; at < data.size(); at += most)
    append_chunk(file, "IDAT", std::span(data).subspan(at, std::min(most, data.size() - at)));
  append_chunk(file, "IEND", {});
  return file;
}

}  // namespace lanthorn
