// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Opens untrusted images. Every image that Lanthorn reads is opened here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "image/image_codec.h"
#include "lanthorn/error.h"
#include "spectrum/rgb_matrix.h"

namespace lanthorn {

/// An image file, open for reading its first part. Its first bytes, not its name, determine the format, and only image
/// formats are accepted: OpenImageIO would also open films, which may refer to other files, and raw data.
class ImageFile {
 public:
  /// `bytes`: the whole file, which must outlive this object. `what`: its name in messages ('image "a.png"'). Throws
  /// Error with `where` if the format is unknown, if the file is damaged, deep or a volume, if its chromaticities are
  /// impossible, if it has more than `max_pixels`, or if it announces more data than 256 MiB plus 4096 times its size.
  ImageFile(std::string_view bytes, std::string what, SourceLocation where, std::uint64_t max_pixels);
  /// Like the first constructor, for a file on disk, positioned at its start. The file is not read into memory as a
  /// whole (except Radiance pictures).
  ImageFile(const std::shared_ptr<std::FILE>& file, std::string what, SourceLocation where, std::uint64_t max_pixels);

  const ImageHeader& header() const { return image_.header; }
  /// OpenImageIO's name of the format.
  std::string_view format() const { return format_; }
  /// True if the file states the chromaticities of its colours; all 0, as Photoshop writes them, do not count.
  bool states_colours() const { return states_colours_; }
  /// Maps the file's colours to linear Rec.709. nullopt if they are linear Rec.709, as without a statement.
  const std::optional<RgbMatrix>& to_rec709() const { return to_rec709_; }
  /// Reads the first `channels` of all pixels. Throws Error if the file is damaged.
  void read(int channels, std::uint8_t* pixels) { read(channels, SampleType::uint8, pixels); }
  void read(int channels, float* pixels) { read(channels, SampleType::float32, pixels); }
  /// As `OpenImage::read_rows`, as uint8 or float32.
  void read_rows(int first, int end, int channels, SampleType as, void* pixels);
  bool has_rows() const { return image_.read_rows != nullptr; }

 private:
  void open(std::string_view first_bytes, std::uint64_t max_pixels, const std::function<OpenImage()>& open);
  void check_pixels(std::uint64_t pixels, std::uint64_t pixel_bytes, std::uint64_t max_pixels) const;
  void check_header(std::uint64_t max_pixels) const;
  void take_colours();
  void read(int channels, SampleType as, void* pixels);
  /// Calls `body`; turns a library's exceptions into an Error about this file.
  void guarded(const std::function<void()>& body) const;
  [[noreturn]] void fail(const std::string& problem) const;

  std::size_t file_size_ = 0;
  std::string bytes_;  // of a file on disk that is read as a whole
  std::string what_;
  SourceLocation where_;
  std::string_view format_;
  OpenImage image_;
  bool states_colours_ = false;
  std::optional<RgbMatrix> to_rec709_;
};

/// Says that the pixel in column x and row y, counted from the upper left corner, has a value that is not finite.
std::string not_finite(std::int64_t x, std::int64_t y);

}  // namespace lanthorn
