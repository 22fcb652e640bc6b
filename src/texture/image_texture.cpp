// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "texture/image_texture.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/memory.h"

namespace lanthorn {

namespace {

using description::ImageFilter;
using description::Wrap;

struct WrappedTexel {
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
WrappedTexel octahedral_texel(int column, int row, int width, int height) {
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

WrappedTexel wrapped(int column, int row, int width, int height, const WrapModes& wrap) {
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

// The number of levels that an image gets.
int levels_for(const TextureFormat& format, const ImageWish& wish) {
  const std::size_t texels = static_cast<std::size_t>(format.width) * static_cast<std::size_t>(format.height);
  return wish.levels && texels >= least_texels_with_levels ? all_levels_of(format) : 1;
}

bool is_opaque_row(const TextureFormat& format, const std::byte* row) {
  const auto width = static_cast<std::size_t>(format.width), stride = static_cast<std::size_t>(format.channels);
  for (std::size_t x = 0; x < width; ++x) {
    float alpha = 1;
    const std::size_t place = stride * x + stride - 1;
    if (format.is_8_bit)
      alpha = static_cast<float>(row[place]) / 255.0f;
    else
      std::memcpy(&alpha, row + place * sizeof alpha, sizeof alpha);
    if (alpha != 1.0f) return false;
  }
  return true;
}

template <class Texel>
Rgb colour_of(const Texel& texel, int channels) {
  const float first = texel[0];
  if (channels < 3) return {first, first, first};
  return {first, texel[1], texel[2]};
}

template <class Texel>
float scalar_of(const Texel& texel, int channels, std::optional<int> channel) {
  if (channel == alpha_channel) return channels == 4 ? texel[3] : channels == 2 ? texel[1] : 1.0f;
  if (channel) return texel[channels < 3 ? 0 : *channel];
  switch (channels) {
    case 1:
    case 2:
      return texel[0];
    case 3:
      return (texel[0] + texel[1] + texel[2]) / 3.0f;
    default:
      return texel[3];
  }
}

}  // namespace

TextureImage::TextureImage(const Rgb& color) : channels_(3), floats_{color.r, color.g, color.b} {
  format_.width = format_.height = 1;
  format_.channels = 3;
}

TextureImage::Need TextureImage::need(const ImageSource& source, const FileAccess& access, const ImageWish& wish,
                                      const SourceLocation& location) {
  const TextureFormat format = TexelReader(source, access, wish.colours, false, location).format();
  const int levels = levels_for(format, wish);
  return {texels_of_levels(format.width, format.height, levels) * format.texel_bytes(),
          TextureCache::disk_bytes(format, levels)};
}

TextureImage::TextureImage(const ImageSource& source, const FileAccess& access, const ImageWish& wish,
                           const SourceLocation& location) {
  TexelReader reader(source, access, wish.colours, true, location);
  format_ = reader.format();
  to_rec709_ = reader.to_rec709();
  channels_ = format_.channels;
  const auto stride = static_cast<std::size_t>(channels_);
  const int levels = levels_for(format_, wish);
  const std::size_t all = texels_of_levels(width(), height(), levels) * stride,
                    count = texels_of_levels(width(), height(), 1) * stride;
  require_memory(static_cast<double>(all) * (format_.is_8_bit ? 1 : sizeof(float)), location, reader.what());
  if (format_.is_8_bit) {
    bytes_.reserve(all);
    bytes_.resize(count);
    reader.read(reinterpret_cast<std::byte*>(bytes_.data()));
  } else {
    floats_.reserve(all);
    floats_.resize(count);
    reader.read(reinterpret_cast<std::byte*>(floats_.data()));
  }
  if (format_.has_alpha() && is_opaque()) drop_alpha();
  levels_ = levels;
  if (levels_ > 1) make_levels();
}

TextureImage::TextureImage(const ImageSource& source, const FileAccess& access, const ImageWish& wish,
                           const SourceLocation& location, std::shared_ptr<TextureCache> cache)
    : cache_(std::move(cache)) {
  TexelReader reader(source, access, wish.colours, false, location);
  format_ = reader.format();
  to_rec709_ = reader.to_rec709();
  levels_ = levels_for(format_, wish);
  bool is_opaque = true;
  cached_ = &cache_->add(
      reader, levels_,
      [&](const std::byte* row) {
        if (format_.has_alpha()) is_opaque = is_opaque && is_opaque_row(format_, row);
      },
      location);
  channels_ = format_.has_alpha() && is_opaque ? format_.channels - 1 : format_.channels;
}

bool TextureImage::is_opaque() const {
  const auto* const texels = format_.is_8_bit ? reinterpret_cast<const std::byte*>(bytes_.data())
                                              : reinterpret_cast<const std::byte*>(floats_.data());
  for (int y = 0; y < height(); ++y)
    if (!is_opaque_row(format_, texels + static_cast<std::size_t>(y) * format_.row_bytes())) return false;
  return true;
}

void TextureImage::drop_alpha() {
  const std::size_t texels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
  const auto stride = static_cast<std::size_t>(format_.channels), left = stride - 1;
  const auto drop = [&](auto& values) {
    if (values.empty()) return;
    for (std::size_t i = 0; i < texels; ++i)
      for (std::size_t c = 0; c < left; ++c) values[left * i + c] = values[stride * i + c];
    values.resize(left * texels);
    values.shrink_to_fit();
  };
  drop(bytes_);
  drop(floats_);
  channels_ = format_.channels = static_cast<int>(left);
}

void TextureImage::make_levels() {
  const auto stride = static_cast<std::size_t>(channels_);
  std::size_t texels = 0;
  for (int level = 0; level < levels_; ++level) {
    level_begins_.push_back(texels);
    texels +=
        static_cast<std::size_t>(level_size(width(), level)) * static_cast<std::size_t>(level_size(height(), level));
  }
  const auto make = [&](auto& values) {
    values.resize(texels * stride);
    auto* const all = reinterpret_cast<std::byte*>(values.data());
    LevelMaker maker(format_, levels_, [&](int level, int y, const std::byte* row) {
      if (level > 0)
        std::memcpy(all + index_of({0, y}, level) * format_.texel_bytes(), row,
                    static_cast<std::size_t>(level_size(width(), level)) * format_.texel_bytes());
    });
    for (int y = 0; y < height(); ++y) maker.add(all + static_cast<std::size_t>(y) * format_.row_bytes());
  };
  if (format_.is_8_bit)
    make(bytes_);
  else
    make(floats_);
}

TextureImage::Taps TextureImage::taps(const Vec2& st, const WrapModes& wrap, ImageFilter filter, int level) const {
  // Texel centres lie at half-integers; t runs upwards, rows downwards. A texel of a level covers 2^level texels of the
  // image along each axis.
  const float scale = std::ldexp(1.0f, -level);
  const float x = scale * tame(st.x, width(), wrap.s) - 0.5f;
  const float y = scale * tame(1 - st.y, height(), wrap.t) - 0.5f;
  const int columns = level_size(width(), level), rows = level_size(height(), level);
  const auto tap = [&](int column, int row, float weight, TexelPlace& place) {
    const WrappedTexel t = wrapped(column, row, columns, rows, wrap);
    place = {t.column, t.row};
    return t.inside ? weight : 0.0f;
  };
  Taps taps;
  if (filter == ImageFilter::point) {
    const auto column = static_cast<int>(std::floor(x + 0.5f)), row = static_cast<int>(std::floor(y + 0.5f));
    taps.weight[0] = tap(column, row, 1.0f, taps.place[0]);
    return taps;
  }
  const float left = std::floor(x), top = std::floor(y);
  const float dx = x - left, dy = y - top;
  const int column = static_cast<int>(left), row = static_cast<int>(top);
  taps.weight[0] = tap(column, row, (1 - dx) * (1 - dy), taps.place[0]);
  taps.weight[1] = tap(column + 1, row, dx * (1 - dy), taps.place[1]);
  taps.weight[2] = tap(column, row + 1, (1 - dx) * dy, taps.place[2]);
  taps.weight[3] = tap(column + 1, row + 1, dx * dy, taps.place[3]);
  return taps;
}

template <class Sum, class Value>
Sum TextureImage::interpolated(const Taps& taps, int level, const Value& value) const {
  std::array<Sum, 4> values{};
  const auto fetch = [&](const auto* samples, const auto& sample_of) {
    for (unsigned i = 0; i < 4; ++i)
      if (taps.weight[i] != 0)
        values[i] = value(Texel<std::decay_t<decltype(*samples)>>{samples + sample_of(i), *this});
  };
  const auto stride = static_cast<std::size_t>(format_.channels);
  const auto in_memory = [&](unsigned i) { return index_of(taps.place[i], level) * stride; };
  if (!floats_.empty()) {
    fetch(floats_.data(), in_memory);
  } else if (cached_ == nullptr) {
    fetch(bytes_.data(), in_memory);
  } else {
    alignas(float) std::array<std::byte, 4 * 4 * sizeof(float)> texels;
    const std::size_t count = taps.weight[1] == 0 && taps.weight[2] == 0 && taps.weight[3] == 0 ? 1 : 4;
    cache_->read(*cached_, level, {taps.place.data(), count}, texels.data());
    const auto copied = [&](unsigned i) { return i * stride; };
    if (format_.is_8_bit)
      fetch(reinterpret_cast<const std::uint8_t*>(texels.data()), copied);
    else
      fetch(reinterpret_cast<const float*>(texels.data()), copied);
  }
  // One loop for all kinds of storage: copies of it could round differently, since the compiler may fuse the product
  // and the sum.
  Sum sum{};
  for (unsigned i = 0; i < 4; ++i) sum += taps.weight[i] * values[i];
  return sum;
}

Rgb TextureImage::texel(int x, int y) const {
  Taps one;
  one.place[0] = {x, y};
  one.weight[0] = 1;
  return interpolated<Rgb>(one, 0, [this](const auto& texel) { return colour_of(texel, channels_); });
}

LightTexels TextureImage::take_colours() && {
  if (floats_.empty()) return {std::move(bytes_), static_cast<std::size_t>(channels_), format_.decode};
  std::vector<Rgb> colours(floats_.size() / static_cast<std::size_t>(channels_));
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const Texel<float> texel{floats_.data() + i * static_cast<std::size_t>(channels_), *this};
    colours[i] = colour(colour_of(texel, channels_));
  }
  floats_ = {};
  return colours;
}

bool TextureImage::has_colours_of_normals() const {
  if (!has_colour()) return false;
  constexpr int samples = 64;
  Rgb mean;
  for (int i = 0; i < samples; ++i)
    for (int k = 0; k < samples; ++k) mean += texel(i * width() / samples, k * height() / samples);
  mean = (1.0f / sqr(samples)) * mean;
  const auto is_middle = [](float x) { return x > 0.35f && x < 0.65f; };
  return is_middle(mean.r) && is_middle(mean.g) && mean.b > std::max(mean.r, mean.g) + 0.1f;
}

Rgb TextureImage::rgb(const Vec2& st, const WrapModes& wrap, ImageFilter filter, int level) const {
  return interpolated<Rgb>(taps(st, wrap, filter, level), level,
                           [this](const auto& texel) { return colour_of(texel, channels_); });
}

float TextureImage::scalar(const Vec2& st, const WrapModes& wrap, ImageFilter filter,
                           std::optional<int> channel) const {
  return interpolated<float>(taps(st, wrap, filter, 0), 0,
                             [this, channel](const auto& texel) { return scalar_of(texel, channels_, channel); });
}

}  // namespace lanthorn
