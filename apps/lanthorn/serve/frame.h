// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A picture in the form that the page receives: linear half floats, so that the page applies exposure and tone curve.
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

/// A picture of a running render and its description for the page. Threads may share it.
class PageFrame {
 public:
  /// The page shows the layers of `denoised`, which may be null, instead of those of `image`. `about` is sent to the
  /// page unchanged, together with the frame's number, size and layers. `metadata`: as for `encode_exr`.
  PageFrame(std::uint64_t number, std::shared_ptr<const Image> image, std::shared_ptr<const Image> denoised,
            nlohmann::json about, std::string metadata);

  std::uint64_t number() const { return number_; }
  const std::shared_ptr<const Image>& image() const { return image_; }
  const nlohmann::json& about() const { return about_; }
  const std::string& metadata() const { return metadata_; }
  /// The layer as it is shown; nullopt if none has this name.
  std::optional<Image> layer(const std::string& name) const;

  /// The encoded frame, little-endian: the length of the JSON text in 32 bits; the text, padded with spaces to a
  /// multiple of 4 bytes; the pixels of a layer ("color" if none has this name) as half floats, rows from the top, with
  /// as many channels as the text says. `measured`: the text includes the picture's `measured_exposure`. Computed once
  /// for each layer.
  SharedBytes encoded(const std::string& layer, bool measured) const;

 private:
  std::string encode(const std::string& layer, const Image& pixels, bool measured) const;

  std::uint64_t number_;
  std::shared_ptr<const Image> image_, denoised_;
  nlohmann::json about_;
  std::string metadata_;
  mutable std::mutex mutex_;  // guards what is computed on demand
  mutable std::map<std::pair<std::string, bool>, SharedBytes> encoded_;
};

}  // namespace lanthorn::program
