// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Image files, turned into texels as textures store them.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/image_file.h"
#include "lanthorn/error.h"
#include "lanthorn/file_access.h"
#include "lanthorn/scene_description.h"
#include "texture/texture_format.h"

namespace lanthorn {

/// Location of an image file's bytes: on disk, or embedded in the scene file. Refers to its argument.
class ImageSource {
 public:
  ImageSource(const std::string& filename) : name_(&filename) {}
  ImageSource(const description::EmbeddedImage& image) : name_(&image.name), bytes_(&image.bytes) {}

  const std::string& name() const { return *name_; }
  /// Null for a file on disk.
  const std::string* bytes() const { return bytes_; }

 private:
  const std::string* name_;
  const std::string* bytes_ = nullptr;
};

/// How the samples of a file become linear colours.
struct TexelColours {
  description::Encoding encoding = description::Encoding::automatic;
  float gamma = 1;                      ///< for Encoding::gamma
  ColorSpace space = ColorSpace::srgb;  ///< of files that do not state their own chromaticities
};

/// An image that is read as texels of a format that follows from the file.
class TexelReader {
 public:
  /// `whole`: true if `read` will be called, for which the file is read into memory first; false if `read_rows` will
  /// be. Throws Error with `location` if the file cannot be read, subject to `access`.
  TexelReader(const ImageSource& source, const FileAccess& access, const TexelColours& colours, bool whole,
              const SourceLocation& location);

  const TextureFormat& format() const { return format_; }
  /// Maps texels that are colours to linear Rec.709 (`ImageFile::to_rec709`). Not applied here, because texels can be
  /// other quantities, such as normals or roughnesses.
  const std::optional<RgbMatrix>& to_rec709() const { return file_->to_rec709(); }
  /// The name in messages: image "a.png".
  const std::string& what() const { return what_; }
  /// All texels, format().row_bytes() times height bytes. Throws Error if the file is damaged, or has a texel that is
  /// not finite, or would not be as a colour.
  void read(std::byte* texels);
  /// Calls `take(row)` for each row from the top. Throws Error as `read` does.
  void read_rows(const std::function<void(const std::byte* row)>& take);

 private:
  void convert(const std::byte* read, std::size_t texels, std::byte* out) const;
  bool is_converted() const;
  void check_finite(const std::byte* samples, int row) const;

  std::string what_;
  SourceLocation location_;
  std::string bytes_;
  std::optional<ImageFile> file_;
  TextureFormat format_;
  TexelColours colours_;
  SampleType read_as_{};  // uint8 or float32
  bool is_integer_ = false;
};

}  // namespace lanthorn
