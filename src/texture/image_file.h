// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Opening images that nobody vouches for: every image that Lanthorn reads comes through here.
#pragma once

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "lanthorn/error.h"

namespace lanthorn {

/// An image file in memory, open for reading its first part. Its first bytes say of what kind it is, not its name, and
/// only kinds that are images are known: OpenImageIO would also take films, which may name other files, and raw data.
class ImageFile {
 public:
  /// `bytes`: the whole file, which must outlive this; `what`: names it in messages ('image "a.png"'). Throws Error
  /// with `where` if it is of no known kind, damaged, deep, a volume, has more than `max_pixels`, or announces more
  /// than its bytes can hold: 256 MiB and 4096 times their number.
  ImageFile(std::string_view bytes, std::string what, SourceLocation where, std::uint64_t max_pixels);

  const OIIO::ImageSpec& spec() const { return input_->spec(); }
  std::string_view format() const { return input_->format_name(); }
  /// Reads the first `channels` of all pixels, converted to `type`. Throws Error if the file is damaged.
  void read(int channels, OIIO::TypeDesc type, void* pixels);

 private:
  void check_pixels(std::uint64_t pixels, std::uint64_t pixel_bytes, std::uint64_t max_pixels) const;
  void check_spec(std::uint64_t max_pixels) const;
  /// Calls it; whatever a library throws leaves as an Error of this file.
  void guarded(const std::function<void()>& body) const;
  [[noreturn]] void fail(const std::string& problem) const;

  std::size_t file_size_;
  std::string what_;
  SourceLocation where_;
  OIIO::Filesystem::IOMemReader memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
};

}  // namespace lanthorn
