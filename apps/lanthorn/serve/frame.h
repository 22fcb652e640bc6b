// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A picture as the page gets it: linear half floats, so that exposure and tone curve are the page's own.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "http_message.h"
#include "lanthorn/image.h"

namespace lanthorn::program {

/// A picture of a running render, and what the page says about it. Threads may share it.
class PageFrame {
 public:
  /// The page shows the layers of `denoised`, which may be null, instead of those of `image`. `about`: goes to the page
  /// as it is, with the frame's number, size and layers. `metadata`: as for `encode_exr`.
  PageFrame(std::uint64_t number, std::shared_ptr<const Image> image, std::shared_ptr<const Image> denoised,
            nlohmann::json about, std::string metadata);

  std::uint64_t number() const { return number_; }
  const std::shared_ptr<const Image>& image() const { return image_; }
  const nlohmann::json& about() const { return about_; }
  const std::string& metadata() const { return metadata_; }
  /// As it is shown; nothing if there is none of this name.
  std::optional<Image> layer(const std::string& name) const;

  /// Little-endian: the length of the JSON text in 32 bits; the text, padded with spaces to a multiple of 4 bytes; the
  /// pixels of a layer ("color" if there is none of this name) as half floats, rows from the top, as many channels as
  /// the text says. `measured`: the text has `measured_exposure` of the picture, too. Made once for each layer.
  SharedBytes encoded(const std::string& layer, bool measured) const;

 private:
  std::string encode(const std::string& layer, const Image& pixels, bool measured) const;

  std::uint64_t number_;
  std::shared_ptr<const Image> image_, denoised_;
  nlohmann::json about_;
  std::string metadata_;
  mutable std::mutex mutex_;  // of what is made on demand
  mutable std::map<std::pair<std::string, bool>, SharedBytes> encoded_;
};

}  // namespace lanthorn::program
