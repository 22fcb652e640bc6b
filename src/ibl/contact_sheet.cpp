// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "ibl/cube_map.h"
#include "lanthorn/ibl.h"

namespace lanthorn {

namespace {

constexpr int tile = 96, gap = 4;

class Sheet {
 public:
  explicit Sheet(int rows) : image_(cube_faces * (tile + gap) + gap, rows * (tile + gap) + gap, {"R", "G", "B"}) {}

  /// A row of six tiles; `at(face, place)` gives the colours.
  template <class Colour>
  void add_row(Colour&& at) {
    for (int y = 0; y < tile; ++y)
      for (int column = 0; column < cube_faces * tile; ++column) {
        const Vec2 place = Vec2(static_cast<float>(column % tile) + 0.5f, static_cast<float>(y) + 0.5f) / float{tile};
        const int face = column / tile;
        const Spectrum colour = at(face, place);
        for (std::size_t c = 0; c < 3; ++c)
          image_.at(gap + face * (tile + gap) + column % tile, gap + row_ * (tile + gap) + y, c) = colour.v[c];
      }
    ++row_;
  }
  Image take() { return std::move(image_); }

 private:
  Image image_;
  int row_ = 0;
};

}  // namespace

Image contact_sheet(const Ibl& ibl) {
  Sheet sheet(static_cast<int>(ibl.specular.size()) + (ibl.irradiance ? 1 : 0) + (ibl.sh ? 1 : 0));
  const auto add_cube = [&](const Image& strip) {
    const CubeMap map = cube_of(strip);
    sheet.add_row([&](int face, const Vec2& at) { return map.lookup(cube_direction(face, at)); });
  };
  for (const SpecularLevel& level : ibl.specular) add_cube(level.faces);
  if (ibl.irradiance) add_cube(*ibl.irradiance);
  if (ibl.sh)
    sheet.add_row([&](int face, const Vec2& at) {
      const Direction d = cube_direction(face, at);
      const Rgb e = irradiance_at(*ibl.sh, {d.x, d.y, d.z}, 3);
      return Spectrum{e.r, e.g, e.b, 0};
    });
  return sheet.take();
}

}  // namespace lanthorn
