// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Microsoft's "Programming Guide for DDS" with the header extension of DirectX 10.
#include <cassert>
#include <cstdint>
#include <string>

#include "io/texels.h"
#include "lanthorn/ibl.h"

namespace lanthorn {

namespace {

constexpr std::uint32_t flags_caps = 0x1, flags_height = 0x2, flags_width = 0x4, flags_pitch = 0x8,
                        flags_pixel_format = 0x1000, flags_mip_count = 0x20000;
constexpr std::uint32_t caps_complex = 0x8, caps_texture = 0x1000, caps_mip = 0x400000;
constexpr std::uint32_t caps2_cube_with_all_faces = 0xFE00;
constexpr std::uint32_t pixel_format_four_cc = 0x4, four_cc_dx10 = 0x30315844;
constexpr std::uint32_t dxgi_r16g16b16a16_float = 10, dxgi_r9g9b9e5_sharedexp = 67;
constexpr std::uint32_t dimension_texture_2d = 3, misc_cube = 4;

}  // namespace

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
