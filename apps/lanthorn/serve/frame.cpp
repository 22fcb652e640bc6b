// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "../json_text.h"
#include "lanthorn/image_file.h"

namespace lanthorn {

std::uint16_t half_from_float(float value) {
  constexpr float largest = 65504, least_normal = 0x1p-14f;
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>(bits >> 16 & 0x8000);
  const float size = std::fabs(value);
  if (!(size > 0)) return 0;  // NaN and both zeros
  if (size >= largest) return sign | 0x7bff;
  if (size < least_normal)  // multiples of 2^-24; 1024 of them are the least normal number
    return sign | static_cast<std::uint16_t>(std::lrint(size * 0x1p24f));
  // 13 bits of the fraction go: half of their last place is added, less one where that would round a tie up to odd.
  const std::uint32_t fraction_and_exponent = (bits & 0x7fffffff) - (112u << 23);
  const std::uint32_t rounded = fraction_and_exponent + 0xfff + (fraction_and_exponent >> 13 & 1);
  return sign | static_cast<std::uint16_t>(std::min(rounded >> 13, 0x7bffu));
}

PageFrame::PageFrame(std::uint64_t number, std::shared_ptr<const Image> image, nlohmann::json about,
                     std::string metadata)
    : number_(number), image_(std::move(image)), about_(std::move(about)), metadata_(std::move(metadata)) {
  about_["number"] = number_;
  about_["layers"] = layer_names(*image_);
}

SharedBytes PageFrame::encoded(const std::string& layer, bool measured) const {
  const std::lock_guard lock(mutex_);
  std::optional<Image> pixels = select_layer(*image_, layer);
  const std::string name = pixels ? layer : "color";
  SharedBytes& bytes = encoded_[{name, measured}];
  if (!bytes) bytes = share(encode(name, pixels ? *pixels : select_layer(*image_, name).value_or(Image()), measured));
  return bytes;
}

std::string PageFrame::encode(const std::string& layer, const Image& pixels, bool measured) const {
  nlohmann::json about = about_;
  about["layer"] = layer;
  about["width"] = pixels.width;
  about["height"] = pixels.height;
  about["channels"] = pixels.channels;
  if (measured) about["measured_exposure"] = measured_exposure(*image_);
  std::string text = json_text(about, one_line);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string bytes(4, '\0');
  for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(text.size() >> (8 * i) & 0xff);
  bytes += text;
  std::size_t at = bytes.size();
  bytes.resize(at + 2 * pixels.pixels.size());
  for (const float value : pixels.pixels) {
    const std::uint16_t half = half_from_float(value);
    bytes[at++] = static_cast<char>(half & 0xff);
    bytes[at++] = static_cast<char>(half >> 8);
  }
  return bytes;
}

}  // namespace lanthorn
