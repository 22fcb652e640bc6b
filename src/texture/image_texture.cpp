// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "texture/image_texture.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "film/display.h"
#include "image/image_file.h"
#include "lanthorn/text.h"
#include "spectrum/curve.h"

namespace lanthorn {

namespace {

using description::Encoding;
using description::ImageFilter;
using description::Wrap;

float decode(float x, Encoding encoding, float gamma) {
  switch (encoding) {
    case Encoding::srgb:
      return linear_from_srgb(x);
    case Encoding::gamma:
      return std::pow(x, gamma);
    default:
      return x;
  }
}

struct Texel {
  bool inside = true;
  int column = 0, row = 0;
};

int modulo(int i, int size) {
  const int m = i % size;
  return m < 0 ? m + size : m;
}

int mirrored(int i, int size) {
  const int m = modulo(i, 2 * size);
  return m < size ? m : 2 * size - 1 - m;
}

// Wraps texel indices of an octahedral map. The square folds along its edges: a texel beyond an edge is the texel of
// the other half of the same edge (Clarberg 2008).
Texel octahedral_texel(int column, int row, int width, int height) {
  int x = modulo(column, 2 * width), y = row;
  if (x >= width) {
    x = 2 * width - 1 - x;
    y = height - 1 - y;
  }
  y = modulo(y, 2 * height);
  if (y >= height) {
    x = width - 1 - x;
    y = 2 * height - 1 - y;
  }
  return {true, x, y};
}

struct TexelIndex {
  bool inside = true;
  int at = 0;
};
TexelIndex wrapped(int i, int size, Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat:
      return {true, modulo(i, size)};
    case Wrap::mirror:
      return {true, mirrored(i, size)};
    case Wrap::clamp:
      return {true, std::clamp(i, 0, size - 1)};
    default:
      return {i >= 0 && i < size, std::clamp(i, 0, size - 1)};
  }
}

Texel wrapped(int column, int row, int width, int height, const WrapModes& wrap) {
  if (wrap.s == Wrap::octahedral_sphere) return octahedral_texel(column, row, width, height);
  const TexelIndex x = wrapped(column, width, wrap.s), y = wrapped(row, height, wrap.t);
  return {x.inside && y.inside, x.at, y.at};
}

// Limits texture coordinates, which may be arbitrary, to the range of integers.
float tame(float x, int size, Wrap wrap) {
  if (!std::isfinite(x)) return 0;
  if (wrap == Wrap::repeat) x -= std::floor(x);
  if (wrap == Wrap::mirror || wrap == Wrap::octahedral_sphere) x -= 2 * std::floor(x / 2);
  return std::clamp(x, -1.0f, 2.0f) * static_cast<float>(size);
}

// 8-bit files, and PNG of any depth, hold sRGB values; all other files are linear.
Encoding automatic_encoding(bool is_8_bit, bool is_integer, std::string_view format) {
  return is_8_bit || (is_integer && format == "png") ? Encoding::srgb : Encoding::linear;
}

}  // namespace

TextureImage::TextureImage(const ImageSource& source, const FileAccess& access, Encoding encoding, float gamma,
                           ColorSpace space, const SourceLocation& location) {
  const std::string what = "image \"" + printable(source.name()) + "\"";
  std::string read;
  try {
    if (source.bytes() == nullptr) read = access.read(source.name());
  } catch (const Error& problem) {
    throw Error(location, "cannot read " + what + ": " + problem.message);
  }
  const std::string& bytes = source.bytes() != nullptr ? *source.bytes() : read;
  ImageFile file(bytes, what, location, access.max_pixels);
  const ImageHeader& header = file.header();
  width_ = header.width;
  height_ = header.height;
  channels_ = header.channels.size() >= 4 ? 4 : header.channels.size() >= 3 ? 3 : 1;
  const bool is_8_bit = header.samples == SampleType::uint8;
  const bool is_integer = is_8_bit || header.samples == SampleType::uint16;
  if (encoding == Encoding::automatic) encoding = automatic_encoding(is_8_bit, is_integer, file.format());

  const std::size_t count =
      static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * static_cast<std::size_t>(channels_);
  require_memory(static_cast<double>(count) * (is_8_bit ? sizeof(std::uint8_t) : sizeof(float)), location, what);
  if (is_8_bit) {
    bytes_.resize(count);
    for (unsigned i = 0; i < 256; ++i) decode_[i] = decode(static_cast<float>(i) / 255.0f, encoding, gamma);
    file.read(channels_, bytes_.data());
  } else {
    floats_.resize(count);
    file.read(channels_, floats_.data());
    if (is_integer)
      for (std::size_t i = 0; i < count; ++i)
        if (channels_ < 4 || i % 4 != 3) floats_[i] = decode(floats_[i], encoding, gamma);
  }
  if (channels_ == 4) drop_opaque_alpha();
  if (space != ColorSpace::srgb && channels_ >= 3) convert_from(space);
}

void TextureImage::drop_opaque_alpha() {
  const std::size_t texels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  for (std::size_t i = 0; i < texels; ++i)
    if (value(i, 3) != 1.0f) return;
  const auto drop = [&](auto& values) {
    if (values.empty()) return;
    for (std::size_t i = 0; i < texels; ++i)
      for (std::size_t c = 0; c < 3; ++c) values[3 * i + c] = values[4 * i + c];
    values.resize(3 * texels);
    values.shrink_to_fit();
  };
  drop(bytes_);
  drop(floats_);
  channels_ = 3;
}

void TextureImage::convert_from(ColorSpace space) {
  const std::size_t texels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  const auto stride = static_cast<std::size_t>(channels_);
  std::vector<float> converted(texels * stride);
  for (std::size_t i = 0; i < texels; ++i) {
    const Rgb there{std::fmax(0.0f, value(i, 0)), std::fmax(0.0f, value(i, 1)), std::fmax(0.0f, value(i, 2))};
    const Rgb here = SpectrumCurve::unbounded(there, space).rgb;
    converted[i * stride] = here.r;
    converted[i * stride + 1] = here.g;
    converted[i * stride + 2] = here.b;
    if (channels_ == 4) converted[i * stride + 3] = value(i, 3);
  }
  floats_ = std::move(converted);
  bytes_.clear();
  bytes_.shrink_to_fit();
}

TextureImage::Taps TextureImage::taps(const Vec2& st, const WrapModes& wrap, ImageFilter filter) const {
  // Texel centres lie at half-integers; t runs upwards, rows downwards.
  const float x = tame(st.x, width_, wrap.s) - 0.5f;
  const float y = tame(1 - st.y, height_, wrap.t) - 0.5f;
  const auto tap = [&](int column, int row, float weight, std::size_t& texel) {
    const Texel t = wrapped(column, row, width_, height_, wrap);
    texel = static_cast<std::size_t>(t.row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(t.column);
    return t.inside ? weight : 0.0f;
  };
  Taps taps;
  if (filter == ImageFilter::point) {
    const auto column = static_cast<int>(std::floor(x + 0.5f)), row = static_cast<int>(std::floor(y + 0.5f));
    taps.weight[0] = tap(column, row, 1.0f, taps.texel[0]);
    return taps;
  }
  const float left = std::floor(x), top = std::floor(y);
  const float dx = x - left, dy = y - top;
  const int column = static_cast<int>(left), row = static_cast<int>(top);
  taps.weight[0] = tap(column, row, (1 - dx) * (1 - dy), taps.texel[0]);
  taps.weight[1] = tap(column + 1, row, dx * (1 - dy), taps.texel[1]);
  taps.weight[2] = tap(column, row + 1, (1 - dx) * dy, taps.texel[2]);
  taps.weight[3] = tap(column + 1, row + 1, dx * dy, taps.texel[3]);
  return taps;
}

Rgb TextureImage::colour(std::size_t texel) const {
  const float first = value(texel, 0);
  if (channels_ == 1) return {first, first, first};
  return {first, value(texel, 1), value(texel, 2)};
}

Rgb TextureImage::texel(int x, int y) const {
  return colour(static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x));
}

LightTexels TextureImage::take_colours() && {
  if (floats_.empty()) return {std::move(bytes_), static_cast<std::size_t>(channels_), decode_};
  std::vector<Rgb> colours(floats_.size() / static_cast<std::size_t>(channels_));
  for (std::size_t i = 0; i < colours.size(); ++i) colours[i] = colour(i);
  floats_ = {};
  return colours;
}

bool TextureImage::has_colours_of_normals() const {
  if (!has_colour()) return false;
  constexpr int samples = 64;
  Rgb mean;
  for (int i = 0; i < samples; ++i)
    for (int k = 0; k < samples; ++k) mean += texel(i * width_ / samples, k * height_ / samples);
  mean = (1.0f / sqr(samples)) * mean;
  const auto is_middle = [](float x) { return x > 0.35f && x < 0.65f; };
  return is_middle(mean.r) && is_middle(mean.g) && mean.b > std::max(mean.r, mean.g) + 0.1f;
}

Rgb TextureImage::rgb(const Vec2& st, const WrapModes& wrap, ImageFilter filter) const {
  const Taps t = taps(st, wrap, filter);
  Rgb sum;
  for (unsigned i = 0; i < 4; ++i)
    if (t.weight[i] != 0) sum += t.weight[i] * colour(t.texel[i]);
  return sum;
}

float TextureImage::scalar(std::size_t texel, std::optional<int> channel) const {
  if (channel == alpha_channel) return has_alpha() ? value(texel, 3) : 1.0f;
  if (channel) return value(texel, channels_ == 1 ? 0 : *channel);
  switch (channels_) {
    case 1:
      return value(texel, 0);
    case 3:
      return (value(texel, 0) + value(texel, 1) + value(texel, 2)) / 3.0f;
    default:
      return value(texel, 3);
  }
}

float TextureImage::scalar(const Vec2& st, const WrapModes& wrap, ImageFilter filter,
                           std::optional<int> channel) const {
  const Taps t = taps(st, wrap, filter);
  float sum = 0;
  for (unsigned i = 0; i < 4; ++i)
    if (t.weight[i] != 0) sum += t.weight[i] * scalar(t.texel[i], channel);
  return sum;
}

}  // namespace lanthorn
