// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "../report_json.h"
#include "lanthorn/image_file.h"
#include "lanthorn/packed_float.h"

namespace lanthorn::program {

namespace {

// Names of the layers that a page may show.
std::vector<std::string> shown_layers(const Image& image) {
  Image names;
  std::copy_if(image.channels.begin(), image.channels.end(), std::back_inserter(names.channels),
               [](const std::string& channel) { return !is_noise_channel(channel); });
  return layer_names(names);
}

}  // namespace

PageFrame::PageFrame(std::uint64_t number, std::shared_ptr<const Image> image, std::shared_ptr<const Image> denoised,
                     nlohmann::json about, std::string metadata)
    : number_(number),
      image_(std::move(image)),
      denoised_(std::move(denoised)),
      about_(std::move(about)),
      metadata_(std::move(metadata)) {
  about_["number"] = number_;
  about_["layers"] = shown_layers(*image_);
}

std::optional<Image> PageFrame::layer(const std::string& name) const {
  std::optional<Image> found;
  if (denoised_) found = select_layer(*denoised_, name);
  return found ? found : select_layer(*image_, name);
}

SharedBytes PageFrame::encoded(const std::string& layer, bool measured) const {
  const std::lock_guard lock(mutex_);
  std::optional<Image> pixels = this->layer(layer);
  const std::string name = pixels ? layer : "color";
  SharedBytes& bytes = encoded_[{name, measured}];
  if (!bytes) bytes = share(encode(name, pixels ? *pixels : this->layer(name).value_or(Image()), measured));
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
    const std::uint16_t half = encode_finite_half(value);
    bytes[at++] = static_cast<char>(half & 0xff);
    bytes[at++] = static_cast<char>(half >> 8);
  }
  return bytes;
}

}  // namespace lanthorn::program
