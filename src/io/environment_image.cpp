// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/memory.h"
#include "ibl/cube_map.h"
#include "image/image_file.h"
#include "lanthorn/error.h"
#include "lanthorn/ibl.h"
#include "lanthorn/image_file.h"

namespace lanthorn {

namespace fs = std::filesystem;

namespace {

/// Position of a face in a picture of several: in units of the face size, from the upper left corner.
struct FacePlace {
  int column, row;
  bool turned = false;  ///< by half a turn
};
struct CubePicture {
  int columns, rows;
  std::array<FacePlace, cube_faces> places;
};
// As seen from inside, -X +Z +X -Z form a row around the viewer in OpenGL's face orientation. In the vertical cross, -Z
// is at the bottom, upside down.
constexpr std::array<CubePicture, 3> cube_pictures{{{1, 6, {{{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}}}},
                                                    {4, 3, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}}},
                                                    {3, 4, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3, true}}}}}};

Image empty_strip(int size, const fs::path& file) {
  require_memory(3.0 * sizeof(float) * cube_faces * size * size, {file.string()}, "the cube map");
  return {cube_faces * size, size, {"R", "G", "B"}};
}

// Channels R, G, B by name, or Y for all three.
std::array<std::size_t, 3> color_channels(const Image& image, const fs::path& file) {
  const auto r = image.find_channel("R"), g = image.find_channel("G"), b = image.find_channel("B"),
             y = image.find_channel("Y");
  if (y) return {*y, *y, *y};
  if (r && g && b) return {*r, *g, *b};
  throw Error({file.string()}, "is not an environment: it has no channels R, G, B");
}

// Colours that are all finite.
Image read_colors(const fs::path& file, std::uint64_t max_pixels) {
  Image image = read_image(file, ColorEncoding::automatic, max_pixels);
  const std::array<std::size_t, 3> channels = color_channels(image, file);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (const std::size_t c : channels)
        if (!std::isfinite(image.at(x, y, c)))
          throw Error({file.string()}, "cannot be an environment: " + not_finite(x, y));
  return image;
}

void copy_face(const Image& from, const std::array<std::size_t, 3>& channels, const FacePlace& place, int face,
               Image& strip) {
  const int n = strip.height;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const int column = place.column * n + (place.turned ? n - 1 - x : x);
      const int row = place.row * n + (place.turned ? n - 1 - y : y);
      for (std::size_t c = 0; c < 3; ++c) strip.at(face * n + x, y, c) = from.at(column, row, channels[c]);
    }
}

bool has_face(const CubePicture& picture, int column, int row) {
  return std::any_of(picture.places.begin(), picture.places.end(),
                     [&](const FacePlace& place) { return place.column == column && place.row == row; });
}

// A cross has nothing beside its faces, unlike a photograph of the same shape. In each empty position, all pixels must
// be equal.
bool is_empty_beside_faces(const Image& image, const std::array<std::size_t, 3>& channels, const CubePicture& picture,
                           int size) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const int column = x / size, row = y / size;
      if (has_face(picture, column, row)) continue;
      for (const std::size_t c : channels)
        if (image.at(x, y, c) != image.at(column * size, row * size, c)) return false;
    }
  return true;
}

Image read_faces(const std::vector<fs::path>& files, std::uint64_t max_pixels) {
  Image strip;
  for (int face = 0; face < cube_faces; ++face) {
    const fs::path& file = files[static_cast<std::size_t>(face)];
    const Image image = read_colors(file, max_pixels);
    if (image.width != image.height || image.width < 1)
      throw Error({file.string()},
                  fmt::format("is {} x {} pixels; a face of a cube must be square", image.width, image.height));
    if (face == 0) strip = empty_strip(image.height, file);
    if (image.height != strip.height)
      throw Error({file.string()},
                  fmt::format("is {0} x {0} pixels, but {1} is {2} x {2}; all faces must have one size", image.height,
                              files.front().string(), strip.height));
    copy_face(image, color_channels(image, file), {0, 0}, face, strip);
  }
  return strip;
}

Image read_layout(const std::vector<fs::path>& files, std::uint64_t max_pixels) {
  if (files.size() == cube_faces) return read_faces(files, max_pixels);
  if (files.size() != 1)
    throw Error(fmt::format("an environment is one image, or the six faces of a cube (+X -X +Y -Y +Z -Z), not {} files",
                            files.size()));
  const fs::path& file = files.front();
  Image image = read_colors(file, max_pixels);
  const std::array<std::size_t, 3> channels = color_channels(image, file);
  for (const CubePicture& picture : cube_pictures) {
    const int size = image.height / picture.rows;
    if (size < 1 || image.width != picture.columns * size || image.height != picture.rows * size) continue;
    if (!is_empty_beside_faces(image, channels, picture, size)) continue;
    Image strip = empty_strip(size, file);
    for (int face = 0; face < cube_faces; ++face)
      copy_face(image, channels, picture.places[static_cast<std::size_t>(face)], face, strip);
    return strip;
  }
  if (!layout_of(image))
    throw Error({file.string()},
                fmt::format("is not an environment: it is {} x {} pixels; expected 2:1 (equirectangular), square "
                            "(octahedral), a cube of 6:1, 1:6, or a cross of 4:3 or 3:4 with nothing beside its faces",
                            image.width, image.height));
  return image;
}

}  // namespace

Image read_environment(const std::vector<fs::path>& files, std::uint64_t max_pixels) {
  Image image = read_layout(files, max_pixels);
  const std::array<std::size_t, 3> channels = color_channels(image, files.front());
  for (std::size_t pixel = 0; pixel < image.pixels.size(); pixel += image.channels.size())
    for (const std::size_t c : channels)
      if (const float x = image.pixels[pixel + c]; x > 0 && x <= largest_environment_radiance) return image;
  throw Error({files.front().string()},
              fmt::format("is not an environment: it holds no light, that is, no number above 0 and up to {:g}",
                          largest_environment_radiance));
}

}  // namespace lanthorn
