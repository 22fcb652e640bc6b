// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Opens untrusted images. Every image that Lanthorn reads is opened here.
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

/// An image file in memory, open for reading its first part. Its first bytes determine the format, not its name, and
/// only image formats are accepted: OpenImageIO would also open films, which may refer to other files, and raw data.
class ImageFile {
 public:
  /// `bytes`: the whole file, which must outlive this object. `what`: its name in messages ('image "a.png"'). Throws
  /// Error with `where` if the format is unknown, if the file is damaged, deep or a volume, if it has more than
  /// `max_pixels`, or if it announces more data than 256 MiB plus 4096 times its size.
  ImageFile(std::string_view bytes, std::string what, SourceLocation where, std::uint64_t max_pixels);

  const OIIO::ImageSpec& spec() const { return input_->spec(); }
  std::string_view format() const { return input_->format_name(); }
  /// Reads the first `channels` of all pixels, converted to `type`. Throws Error if the file is damaged.
  void read(int channels, OIIO::TypeDesc type, void* pixels);

 private:
  void check_pixels(std::uint64_t pixels, std::uint64_t pixel_bytes, std::uint64_t max_pixels) const;
  void check_spec(std::uint64_t max_pixels) const;
  /// Calls `body`; turns exceptions of a library into an Error of this file.
  void guarded(const std::function<void()>& body) const;
  [[noreturn]] void fail(const std::string& problem) const;

  std::size_t file_size_;
  std::string what_;
  SourceLocation where_;
  OIIO::Filesystem::IOMemReader memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
};

}  // namespace lanthorn
