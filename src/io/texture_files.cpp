// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// KTX2: the KTX File Format Specification, version 2.0 [K2], and the Khronos Data Format Specification, version 1.3
// [DF]. DDS: Microsoft's "Programming Guide for DDS" with the header extension of DirectX 10.
#include <cassert>
#include <cstdint>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "lanthorn/ibl.h"
#include "lanthorn/image.h"
#include "math/packed_float.h"

namespace lanthorn {

namespace {

// Appends the texels of a rectangle with channels R, G, B; half floats get an alpha of 1.
void append_texels(std::string& out, const Image& image, int left, int width, TexelFormat format) {
  for (int y = 0; y < image.height; ++y)
    for (int x = left; x < left + width; ++x) {
      const float* const p = image.pixels.data() + image.index(x, y);
      if (format == TexelFormat::rgb9e5) {
        append_number(out, encode_rgb9e5(p[0], p[1], p[2]));
        continue;
      }
      for (int c = 0; c < 3; ++c) append_number(out, encode_finite_half(p[c]));
      append_number(out, encode_finite_half(1));
    }
}

std::uint32_t bytes_per_texel(TexelFormat format) { return format == TexelFormat::half ? 8 : 4; }

constexpr std::string_view identifier = "\xABKTX 20\xBB\r\n\x1A\n";
constexpr std::uint32_t vk_r16g16b16a16_sfloat = 97, vk_e5b9g9r9_ufloat_pack32 = 123;

struct DfdSample {
  std::uint16_t bit_offset;
  std::uint8_t bits;
  std::uint8_t channel;  // with qualifiers in the upper four bits [DF §5.10]
  std::uint32_t lower, upper;
};

// [DF table 63 ff.]: floats are declared with the range -1 to 1; the mantissas of RGB9E5 reach 1 at the exponent's
// bias.
std::vector<DfdSample> dfd_samples(TexelFormat format) {
  constexpr std::uint8_t is_float = 0x80, is_signed = 0x40, is_exponent = 0x20, alpha = 15;
  constexpr std::uint32_t minus_one = 0xBF800000, one = 0x3F800000;
  std::vector<DfdSample> samples;
  if (format == TexelFormat::half) {
    for (std::uint8_t c = 0; c < 4; ++c)
      samples.push_back({static_cast<std::uint16_t>(16 * c), 16,
                         static_cast<std::uint8_t>((c < 3 ? c : alpha) | is_float | is_signed), minus_one, one});
    return samples;
  }
  constexpr std::uint32_t mantissa_of_one = 8448, exponent_bias = 15, largest_exponent = 31;
  for (std::uint8_t c = 0; c < 3; ++c) {
    samples.push_back({static_cast<std::uint16_t>(9 * c), 9, c, 0, mantissa_of_one});
    samples.push_back({27, 5, static_cast<std::uint8_t>(c | is_exponent), exponent_bias, largest_exponent});
  }
  return samples;
}

// Basic data format descriptor block [DF §5].
std::string data_format_descriptor(TexelFormat format) {
  const std::vector<DfdSample> samples = dfd_samples(format);
  const auto block_size = static_cast<std::uint16_t>(24 + 16 * samples.size());
  std::string dfd;
  append_number(dfd, static_cast<std::uint32_t>(block_size + 4));
  append_number(dfd, std::uint32_t{0});  // vendor Khronos, basic format
  append_number(dfd, std::uint16_t{2});  // version 1.3
  append_number(dfd, block_size);
  constexpr std::uint8_t model_rgbsda = 1, primaries_bt709 = 1, transfer_linear = 1;
  for (const std::uint8_t byte : {model_rgbsda, primaries_bt709, transfer_linear, std::uint8_t{0}})
    append_number(dfd, byte);
  append_number(dfd, std::uint32_t{0});  // blocks of one texel
  append_number(dfd, static_cast<std::uint64_t>(bytes_per_texel(format)));
  for (const DfdSample& s : samples) {
    append_number(dfd, s.bit_offset);
    append_number(dfd, static_cast<std::uint8_t>(s.bits - 1));
    append_number(dfd, s.channel);
    append_number(dfd, std::uint32_t{0});  // sampled at the texel's centre
    append_number(dfd, s.lower);
    append_number(dfd, s.upper);
  }
  return dfd;
}

void pad(std::string& out, std::size_t alignment) {
  while (out.size() % alignment != 0) out += '\0';
}

// [K2 §3.11]
std::string encode_key_values(const std::map<std::string, std::string>& key_values) {
  std::string out;
  for (const auto& [key, value] : key_values) {
    append_number(out, static_cast<std::uint32_t>(key.size() + value.size() + 2));
    out.append(key).append(1, '\0').append(value).append(1, '\0');
    pad(out, 4);
  }
  return out;
}

std::string encode_level(const Texture& texture, const Image& level) {
  std::string out;
  const int faces = texture.cube ? 6 : 1, width = level.width / faces;
  for (int face = 0; face < faces; ++face) append_texels(out, level, face * width, width, texture.format);
  return out;
}

constexpr std::uint32_t flags_caps = 0x1, flags_height = 0x2, flags_width = 0x4, flags_pitch = 0x8,
                        flags_pixel_format = 0x1000, flags_mip_count = 0x20000;
constexpr std::uint32_t caps_complex = 0x8, caps_texture = 0x1000, caps_mip = 0x400000;
constexpr std::uint32_t caps2_cube_with_all_faces = 0xFE00;
constexpr std::uint32_t pixel_format_four_cc = 0x4, four_cc_dx10 = 0x30315844;
constexpr std::uint32_t dxgi_r16g16b16a16_float = 10, dxgi_r9g9b9e5_sharedexp = 67;
constexpr std::uint32_t dimension_texture_2d = 3, misc_cube = 4;

}  // namespace

std::string encode_ktx2(const Texture& texture, const std::map<std::string, std::string>& key_values) {
  assert(!texture.levels.empty());
  const std::string dfd = data_format_descriptor(texture.format), kvd = encode_key_values(key_values);
  const auto level_count = static_cast<std::uint32_t>(texture.levels.size());
  const std::size_t header_size = 80 + 24 * std::size_t{level_count};
  // Levels are stored from the smallest to the largest [K2 §3.9].
  std::vector<std::uint64_t> offsets(level_count), sizes(level_count);
  std::string data(header_size, '\0');
  data += dfd + kvd;
  for (std::size_t i = level_count; i-- > 0;) {
    pad(data, bytes_per_texel(texture.format));
    offsets[i] = data.size();
    data += encode_level(texture, *texture.levels[i]);
    sizes[i] = data.size() - offsets[i];
  }
  std::string header(identifier);
  const bool half = texture.format == TexelFormat::half;
  const auto height = static_cast<std::uint32_t>(texture.levels.front()->height);
  const auto width = static_cast<std::uint32_t>(texture.levels.front()->width) / (texture.cube ? 6 : 1);
  for (const std::uint32_t field : {half ? vk_r16g16b16a16_sfloat : vk_e5b9g9r9_ufloat_pack32, half ? 2u : 4u, width,
                                    height, 0u, 0u, texture.cube ? 6u : 1u, level_count, 0u})
    append_number(header, field);
  const auto dfd_size = static_cast<std::uint32_t>(dfd.size()), kvd_size = static_cast<std::uint32_t>(kvd.size());
  const auto dfd_offset = static_cast<std::uint32_t>(header_size);
  for (const std::uint32_t field : {dfd_offset, dfd_size, kvd_size > 0 ? dfd_offset + dfd_size : 0u, kvd_size})
    append_number(header, field);
  for (int i = 0; i < 2; ++i) append_number(header, std::uint64_t{0});  // no supercompression
  for (std::size_t i = 0; i < level_count; ++i)
    for (const std::uint64_t field : {offsets[i], sizes[i], sizes[i]}) append_number(header, field);
  return data.replace(0, header_size, header);
}

std::string encode_dds(const Texture& texture) {
  assert(!texture.levels.empty());
  const auto height = static_cast<std::uint32_t>(texture.levels.front()->height);
  const std::uint32_t faces = texture.cube ? 6 : 1;
  const std::uint32_t width = static_cast<std::uint32_t>(texture.levels.front()->width) / faces;
  const auto levels = static_cast<std::uint32_t>(texture.levels.size());
  const bool mips = levels > 1, half = texture.format == TexelFormat::half;
  std::string out = "DDS ";
  const auto append = [&](std::initializer_list<std::uint32_t> fields) {
    for (const std::uint32_t field : fields) append_number(out, field);
  };
  append({124,
          flags_caps | flags_height | flags_width | flags_pitch | flags_pixel_format | (mips ? flags_mip_count : 0),
          height, width, width * bytes_per_texel(texture.format), 0, levels});
  for (int i = 0; i < 11; ++i) append({0});  // reserved
  append({32, pixel_format_four_cc, four_cc_dx10, 0, 0, 0, 0, 0});
  append({caps_texture | (mips ? caps_mip : 0) | (mips || texture.cube ? caps_complex : 0),
          texture.cube ? caps2_cube_with_all_faces : 0, 0, 0, 0});
  append({half ? dxgi_r16g16b16a16_float : dxgi_r9g9b9e5_sharedexp, dimension_texture_2d, texture.cube ? misc_cube : 0,
          1, 0});
  for (std::uint32_t face = 0; face < faces; ++face)
    for (const Image* level : texture.levels) {
      const int size = level->width / static_cast<int>(faces);
      append_texels(out, *level, static_cast<int>(face) * size, size, texture.format);
    }
  return out;
}

}  // namespace lanthorn
