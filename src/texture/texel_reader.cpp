// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "texture/texel_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "film/display.h"
#include "lanthorn/text.h"
#include "spectrum/curve.h"

namespace lanthorn {

namespace {

using description::Encoding;

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

// 8-bit files, and PNG of any depth, hold sRGB values; all other files are linear.
Encoding automatic_encoding(bool is_8_bit, bool is_integer, std::string_view format) {
  return is_8_bit || (is_integer && format == "png") ? Encoding::srgb : Encoding::linear;
}

}  // namespace

TexelReader::TexelReader(const ImageSource& source, const FileAccess& access, const TexelColours& colours, bool whole,
                         const SourceLocation& location)
    : what_("image \"" + printable(source.name()) + "\""), location_(location), colours_(colours) {
  std::shared_ptr<std::FILE> stream;
  try {
    if (source.bytes() == nullptr && whole) bytes_ = access.read(source.name());
    if (source.bytes() == nullptr && !whole) stream = access.open(source.name());
  } catch (const Error& problem) {
    throw Error(location, "cannot read " + what_ + ": " + problem.message);
  }
  if (stream)
    file_.emplace(stream, what_, location, access.max_pixels);
  else
    file_.emplace(source.bytes() != nullptr ? *source.bytes() : bytes_, what_, location, access.max_pixels);
  if (file_->states_colours()) colours_.space = ColorSpace::srgb;
  const ImageHeader& header = file_->header();
  format_.width = header.width;
  format_.height = header.height;
  const std::size_t stored = header.channels.size();
  // The fourth channel of OpenEXR files may be a depth, for example.
  const bool may_have_alpha = file_->format() != "openexr" || header.alpha_channel == 3;
  const bool is_grey_with_alpha = stored == 2 && header.alpha_channel == 1;
  format_.channels = stored >= 4 && may_have_alpha ? 4 : stored >= 3 ? 3 : is_grey_with_alpha ? 2 : 1;
  const bool is_8_bit = header.samples == SampleType::uint8;
  read_as_ = is_8_bit ? SampleType::uint8 : SampleType::float32;
  is_integer_ = is_8_bit || header.samples == SampleType::uint16;
  if (colours_.encoding == Encoding::automatic)
    colours_.encoding = automatic_encoding(is_8_bit, is_integer_, file_->format());
  if (is_8_bit)
    for (unsigned i = 0; i < 256; ++i)
      format_.decode[i] = decode(static_cast<float>(i) / 255.0f, colours_.encoding, colours_.gamma);
  format_.is_8_bit = is_8_bit && !(colours_.space != ColorSpace::srgb && format_.channels >= 3);
}

bool TexelReader::is_converted() const {
  return (is_integer_ && read_as_ == SampleType::float32) ||
         (colours_.space != ColorSpace::srgb && format_.channels >= 3);
}

// Linear sRGB of samples as they were read. `out` may be `read`, if both are floats.
void TexelReader::convert(const std::byte* read, std::size_t texels, std::byte* out) const {
  const auto stride = static_cast<std::size_t>(format_.channels);
  const bool is_8_bit = read_as_ == SampleType::uint8;
  std::array<float, 4> v{};
  for (std::size_t i = 0; i < texels; ++i) {
    for (std::size_t c = 0; c < stride; ++c) {
      if (is_8_bit) {
        v[c] = format_.value_8_bit(static_cast<std::uint8_t>(read[i * stride + c]), static_cast<int>(c));
        continue;
      }
      std::memcpy(&v[c], read + (i * stride + c) * sizeof(float), sizeof(float));
      if (is_integer_ && !format_.is_alpha(static_cast<int>(c))) v[c] = decode(v[c], colours_.encoding, colours_.gamma);
    }
    if (colours_.space != ColorSpace::srgb && stride >= 3) {
      const Rgb there{std::fmax(0.0f, v[0]), std::fmax(0.0f, v[1]), std::fmax(0.0f, v[2])};
      const Rgb here = SpectrumCurve::unbounded(there, colours_.space).rgb;
      v[0] = here.r, v[1] = here.g, v[2] = here.b;
    }
    std::memcpy(out + i * stride * sizeof(float), v.data(), stride * sizeof(float));
  }
}

// Throws Error if a row of floats, as they were read, has a texel that is not finite or would not be as a colour.
void TexelReader::check_finite(const std::byte* samples, int row) const {
  const auto stride = static_cast<std::size_t>(format_.channels), width = static_cast<std::size_t>(format_.width);
  std::array<float, 4> v{};
  for (std::size_t x = 0; x < width; ++x) {
    std::memcpy(v.data(), samples + x * stride * sizeof(float), stride * sizeof(float));
    bool is_finite = std::all_of(v.begin(), v.end(), [](float value) { return std::isfinite(value); });
    if (to_rec709() && stride >= 3) {
      const Rgb colour = *to_rec709() * Rgb{v[0], v[1], v[2]};
      is_finite = is_finite && std::isfinite(colour.r) && std::isfinite(colour.g) && std::isfinite(colour.b);
    }
    if (!is_finite) throw Error(location_, what_ + " cannot be used: " + not_finite(static_cast<std::int64_t>(x), row));
  }
}

void TexelReader::read(std::byte* texels) {
  const std::size_t count = static_cast<std::size_t>(format_.width) * static_cast<std::size_t>(format_.height);
  if (read_as_ == SampleType::float32) {
    file_->read(format_.channels, reinterpret_cast<float*>(texels));
    for (int y = 0; y < format_.height; ++y)
      check_finite(texels + static_cast<std::size_t>(y) * format_.row_bytes(), y);
    if (is_converted()) convert(texels, count, texels);
  } else if (format_.is_8_bit) {
    file_->read(format_.channels, reinterpret_cast<std::uint8_t*>(texels));
  } else {
    std::vector<std::byte> samples(count * static_cast<std::size_t>(format_.channels));
    file_->read(format_.channels, reinterpret_cast<std::uint8_t*>(samples.data()));
    convert(samples.data(), count, texels);
  }
}

void TexelReader::read_rows(const std::function<void(const std::byte* row)>& take) {
  const auto width = static_cast<std::size_t>(format_.width);
  const int step = file_->header().row_step;
  constexpr int usual_band = 256;  // the most rows that a block of OpenEXR has
  const int band = file_->has_rows() ? (usual_band + step - 1) / step * step : format_.height;
  const std::size_t sample_bytes = read_as_ == SampleType::uint8 ? 1 : sizeof(float);
  const std::size_t row_read = width * static_cast<std::size_t>(format_.channels) * sample_bytes;
  std::vector<std::byte> rows(row_read * static_cast<std::size_t>(std::min(band, format_.height)));
  std::vector<std::byte> converted(is_converted() ? format_.row_bytes() : 0);
  for (int first = 0; first < format_.height; first += band) {
    const int end = std::min(first + band, format_.height);
    if (file_->has_rows())
      file_->read_rows(first, end, format_.channels, read_as_, rows.data());
    else
      file_->read(format_.channels, reinterpret_cast<float*>(rows.data()));  // a Radiance picture
    for (std::size_t y = 0; y < static_cast<std::size_t>(end - first); ++y) {
      const std::byte* row = rows.data() + y * row_read;
      if (read_as_ == SampleType::float32) check_finite(row, first + static_cast<int>(y));
      if (is_converted()) convert(row, width, converted.data());
      take(is_converted() ? converted.data() : row);
    }
  }
}

}  // namespace lanthorn
