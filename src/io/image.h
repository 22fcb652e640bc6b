// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Image files: multi-layer OpenEXR and PNG out; EXR, PNG, HDR, PFM and what else OpenImageIO knows in.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "film/image.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// How linear colours become display values in [0,1].
enum class ToneCurve : std::uint8_t {
  none,    ///< clamp
  filmic,  ///< a film-like shoulder and toe (Narkowicz 2015, fit of the ACES curve)
};

struct DisplaySettings {
  float exposure = 0;  ///< stops: colours are multiplied by 2^exposure
  ToneCurve curve = ToneCurve::none;
};

/// sRGB's transfer function (IEC 61966-2-1) and its inverse, for x in [0,1].
float srgb_from_linear(float x);
float linear_from_srgb(float x);

/// Linear colour to sRGB-encoded display values in [0,1]: exposure, curve, clamp, transfer.
Rgb to_display(const Rgb& linear, const DisplaySettings& display);

/// Writes all channels as 32-bit floats (ZIP compression), `image.window` as data and display window. `metadata`: a
/// JSON object; each member becomes an attribute "lanthorn:NAME" (numbers and strings as such, all else as JSON text).
/// Same input, same bytes. `lanthorn::Error` if the file cannot be written; no partial file is left.
void write_exr(const std::filesystem::path& path, const Image& image,
               const nlohmann::json& metadata = nlohmann::json::object());

/// Writes the layer `color` as 8-bit sRGB. `lanthorn::Error` as in `write_exr`.
void write_png(const std::filesystem::path& path, const Image& image, const DisplaySettings& display = {},
               const nlohmann::json& metadata = nlohmann::json::object());

/// Writes EXR or PNG by the extension of `path`; `lanthorn::Error` for others.
void write_image(const std::filesystem::path& path, const Image& image, const DisplaySettings& display,
                 const nlohmann::json& metadata);

enum class ColorEncoding : std::uint8_t {
  automatic,  ///< integer formats hold sRGB, float formats linear values
  linear,     ///< values as they are; integers divided by their maximum
  srgb,       ///< decode sRGB whatever the format
};

/// Reads the first part of an image file as linear floats; alpha is never decoded. `lanthorn::Error` if it cannot be
/// read or is larger than 2^28 values.
Image read_image(const std::filesystem::path& path, ColorEncoding encoding = ColorEncoding::automatic);

/// The attributes that `write_exr` or `write_png` wrote ("lanthorn:NAME"), by name without prefix.
nlohmann::json read_image_metadata(const std::filesystem::path& path);

}  // namespace lanthorn
