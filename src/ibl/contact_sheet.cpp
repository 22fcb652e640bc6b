// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "ibl/cube_map.h"
#include "lanthorn/ibl.h"

namespace lanthorn {

namespace {

constexpr int tile = 96, gap = 4;

// Characters of 3 x 5 dots, row by row from the top: only those that labels need.
struct Glyph {
  char character;
  std::array<std::uint8_t, 5> rows;
};
constexpr int glyph_width = 3, glyph_height = 5, dot_size = 2, advance = (glyph_width + 1) * dot_size,
              line_height = (glyph_height + 2) * dot_size;
constexpr std::array<Glyph, 30> glyphs{{
    {'0', {7, 5, 5, 5, 7}}, {'1', {2, 6, 2, 2, 7}}, {'2', {7, 1, 7, 4, 7}}, {'3', {7, 1, 7, 1, 7}},
    {'4', {5, 5, 7, 1, 1}}, {'5', {7, 4, 7, 1, 7}}, {'6', {7, 4, 7, 5, 7}}, {'7', {7, 1, 1, 1, 1}},
    {'8', {7, 5, 7, 5, 7}}, {'9', {7, 5, 7, 1, 7}}, {'.', {0, 0, 0, 0, 2}}, {'+', {0, 2, 7, 2, 0}},
    {'-', {0, 0, 7, 0, 0}}, {'A', {2, 5, 7, 5, 5}}, {'C', {7, 4, 4, 4, 7}}, {'D', {6, 5, 5, 5, 6}},
    {'E', {7, 4, 6, 4, 7}}, {'H', {5, 5, 7, 5, 5}}, {'I', {7, 2, 2, 2, 7}}, {'L', {4, 4, 4, 4, 7}},
    {'M', {5, 7, 7, 5, 5}}, {'N', {6, 5, 5, 5, 5}}, {'O', {7, 5, 5, 5, 7}}, {'P', {7, 5, 7, 4, 4}},
    {'R', {6, 5, 6, 5, 5}}, {'S', {7, 4, 7, 1, 7}}, {'U', {5, 5, 5, 5, 7}}, {'X', {5, 5, 2, 5, 5}},
    {'Y', {5, 5, 2, 2, 2}}, {'Z', {7, 1, 2, 4, 7}},
}};
constexpr int margin = 11 * advance;

// Empty for a space.
std::array<std::uint8_t, 5> rows_of(char character) {
  for (const Glyph& glyph : glyphs)
    if (glyph.character == character) return glyph.rows;
  return {};
}

class Sheet {
 public:
  /// `white`: the colour of labels.
  Sheet(int rows, float white)
      : image_(margin + cube_faces * (tile + gap) + gap, line_height + rows * (tile + gap) + gap, {"R", "G", "B"}),
        white_(white) {
    constexpr std::array<const char*, cube_faces> faces{"+X", "-X", "+Y", "-Y", "+Z", "-Z"};
    for (int face = 0; face < cube_faces; ++face)
      write(faces[static_cast<std::size_t>(face)], margin + gap + face * (tile + gap), gap);
  }

  /// A row of six tiles; `at(face, place)` returns the colours.
  template <class Colour>
  void add_row(std::string_view name, std::string_view more, Colour&& at) {
    const int top = line_height + gap + row_ * (tile + gap);
    write(name, gap, top);
    write(more, gap, top + line_height);
    for (int y = 0; y < tile; ++y)
      for (int column = 0; column < cube_faces * tile; ++column) {
        const Vec2 place = Vec2(static_cast<float>(column % tile) + 0.5f, static_cast<float>(y) + 0.5f) / float{tile};
        const int face = column / tile;
        const Spectrum colour = at(face, place);
        for (std::size_t c = 0; c < 3; ++c)
          image_.at(margin + gap + face * (tile + gap) + column % tile, top + y, c) = colour.v[c];
      }
    ++row_;
  }
  Image take() { return std::move(image_); }

 private:
  void write(std::string_view text, int left, int top) {
    for (const char character : text) {
      const auto rows = rows_of(character);
      for (int y = 0; y < glyph_height * dot_size; ++y)
        for (int x = 0; x < glyph_width * dot_size; ++x)
          if ((rows[static_cast<std::size_t>(y / dot_size)] >> (glyph_width - 1 - x / dot_size) & 1) != 0)
            for (std::size_t c = 0; c < 3; ++c) image_.at(left + x, top + y, c) = white_;
      left += advance;
    }
  }

  Image image_;
  float white_;
  int row_ = 0;
};

}  // namespace

Image contact_sheet(const Ibl& ibl) {
  constexpr float much_brighter = 10;
  const float white = much_brighter * std::max({ibl.mean.r, ibl.mean.g, ibl.mean.b});
  Sheet sheet(static_cast<int>(ibl.specular.size()) + (ibl.irradiance ? 1 : 0) + (ibl.sh ? 1 : 0), white);
  const auto add_cube = [&](std::string_view name, std::string_view more, const Image& strip) {
    const CubeMap map = cube_of(strip);
    sheet.add_row(name, more, [&](int face, const Vec2& at) { return map.lookup(cube_direction(face, at)); });
  };
  for (const SpecularLevel& level : ibl.specular)
    add_cube("SPECULAR", fmt::format("{:.2f}", level.roughness), level.faces);
  if (ibl.irradiance) add_cube("IRRADIANCE", "", *ibl.irradiance);
  if (ibl.sh)
    sheet.add_row("HARMONICS", "", [&](int face, const Vec2& at) {
      const Direction d = cube_direction(face, at);
      const Rgb e = irradiance_at(*ibl.sh, {d.x, d.y, d.z}, 3);
      return Spectrum{e.r, e.g, e.b, 0};
    });
  return sheet.take();
}

}  // namespace lanthorn
