// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The KTX File Format Specification, version 2.0 [K2], and the Khronos Data Format Specification, version 1.3 [DF].
#include <cassert>
#include <cstdint>
#include <string>
#include <vector>

#include "io/texels.h"
#include "lanthorn/ibl.h"

namespace lanthorn {

namespace {

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

}  // namespace lanthorn
