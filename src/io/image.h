// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Image files: writes multi-layer OpenEXR and PNG, reads the formats of `ImageFile`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/file_access.h"
#include "film/display.h"
#include "lanthorn/image.h"

namespace lanthorn {

/// Writes all channels as 32-bit floats (ZIP compression), `image.window` as data and display window. `metadata`: a
/// JSON object; each member becomes an attribute "lanthorn:NAME" (numbers and strings as such, all else as JSON text).
/// Same input, same bytes. `lanthorn::Error` if the file cannot be written; no partial file is left.
void write_exr(const std::filesystem::path& path, const Image& image,
               const nlohmann::json& metadata = nlohmann::json::object());

/// Writes the layer `color` as 8-bit sRGB; metadata all as text. `lanthorn::Error` as in `write_exr`.
void write_png(const std::filesystem::path& path, const Image& image, const DisplaySettings& display = {},
               const nlohmann::json& metadata = nlohmann::json::object());

/// Writes EXR or PNG by the extension of `path`; `lanthorn::Error` for others.
void write_image(const std::filesystem::path& path, const Image& image, const DisplaySettings& display,
                 const nlohmann::json& metadata);

enum class ColorEncoding : std::uint8_t {
  automatic,  ///< integer formats hold sRGB, float formats linear values
  linear,     ///< values as they are; integers divided by their maximum
  srgb,       ///< decode sRGB for all formats
};

/// Reads the first part of an image file as linear floats; alpha is never decoded. `lanthorn::Error` as of `ImageFile`,
/// or if memory cannot hold it.
Image read_image(const std::filesystem::path& path, ColorEncoding encoding = ColorEncoding::automatic,
                 std::uint64_t max_pixels = FileAccess::default_max_pixels);

/// The attributes that `write_exr` or `write_png` wrote ("lanthorn:NAME"), by name without prefix.
nlohmann::json read_image_metadata(const std::filesystem::path& path);

}  // namespace lanthorn
