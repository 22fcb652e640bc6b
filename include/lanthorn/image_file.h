// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Image files. Writes multi-layer OpenEXR, PNG, JPEG and TIFF; reads these, Radiance pictures, and all other formats of
// OpenImageIO.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/file_access.h"
#include "lanthorn/image.h"

namespace lanthorn {

/// View transform from linear colours to display values in [0,1].
enum class ToneCurve : std::uint8_t {
  none,    ///< clamp
  filmic,  ///< a film-like shoulder and toe (Narkowicz 2015, fit of the ACES curve)
  agx,     ///< bright colours desaturate, as on film (Sobotka's AgX)
  /// Unchanged up to 70 % of white; brighter components are compressed logarithmically, so that the brightest part of
  /// the picture becomes white. A picture that is nowhere brighter than white does not change.
  highlights,
};

/// A view of an OpenColorIO configuration.
struct OcioView {
  std::string config;         ///< its file
  std::string display, view;  ///< empty: the configuration's defaults
  friend bool operator==(const OcioView&, const OcioView&) = default;
};

struct DisplaySettings {
  static constexpr float largest_exposure = 64;
  float exposure = 0;  ///< stops: colours are scaled by 2^exposure
  ToneCurve curve = ToneCurve::none;
  std::optional<float> brightest{};  ///< for ToneCurve::highlights; nullopt: `brightest_level` of the picture
  std::optional<OcioView> ocio{};    ///< instead of the curve
  bool display_emission = false;     ///< show the layer `emission` unchanged: without exposure, curve and view
};

/// A picture of one layer, such as `select_layer` returns, with its channels renamed so that it is the layer `color`.
Image as_color(Image layer);

/// The layer `color`, or the only layer of a picture, ready for a display: R, G, B in [0,1], encoded as sRGB or by the
/// OpenColorIO view. Throws Error if the picture has several layers without `color`, or the view is not available.
Image displayed(const Image& image, const DisplaySettings& display = {});

/// Exposure in stops, a multiple of 0.1, at which the picture is neither too dark nor washed out: a white surface is
/// displayed as white under the illumination that 10 % of the lit pixels exceed. Illumination is the sum of the layers
/// direct, indirect and caustic divided by the albedo, as an incident light meter measures it: white and black objects
/// get the same exposure, and visible lights and skies do not affect it. If less than 1 % of the pixels show lit
/// surfaces or layers are missing, the 90 % quantile of the brightest component of all pixels that are not black
/// becomes white. 0 for black pictures.
float measured_exposure(const Image& image);

/// The radiance that a thousandth of the pixels' brightest components exceed, in the layer `color` or the only layer; 0
/// for other pictures.
float brightest_level(const Image& image);

/// An EXR file of all channels as 32-bit floats, except noise channels as 16-bit floats (ZIP compression), with
/// `image.window` as data and display window. The channel depth.Z is stored as Z, as other programs expect it, and is
/// depth.Z again in `read_image`. `metadata`: text of a JSON object, or empty; each member becomes an attribute
/// "lanthorn:NAME" (numbers and strings as such, all other types as JSON text). Equal input gives equal bytes.
std::vector<unsigned char> encode_exr(const Image& image, const std::string& metadata = {});

/// A PNG file of the result of `displayed` as 8-bit sRGB; all metadata is stored as text. Throws Error as `displayed`
/// does.
std::vector<unsigned char> encode_png(const Image& image, const DisplaySettings& display = {},
                                      const std::string& metadata = {});

/// Throws Error if the file cannot be written; leaves no partial file.
void write_exr(const std::filesystem::path& path, const Image& image, const std::string& metadata = {});

/// Throws Error as `write_exr` does.
void write_png(const std::filesystem::path& path, const Image& image, const DisplaySettings& display = {},
               const std::string& metadata = {});

/// Extensions that `write_image` supports: .exr, .png, ...
const std::vector<std::string>& picture_extensions();

/// Writes EXR, PNG, JPEG (quality 95) or TIFF (16 bits, display values as in a PNG), chosen by the extension of `path`.
/// Throws Error for other extensions.
void write_image(const std::filesystem::path& path, const Image& image, const DisplaySettings& display = {},
                 const std::string& metadata = {});

enum class ColorEncoding : std::uint8_t {
  automatic,  ///< integer formats hold sRGB, float formats linear values
  linear,     ///< values as they are; integers divided by their maximum
  srgb,       ///< decode sRGB whatever the format
};

/// Reads the first part of an image file as linear floats; alpha is never decoded. Colours, the layers of channels R, G
/// and B, become linear Rec.709 if the file states other chromaticities (OpenEXR's attribute, Radiance's PRIMARIES);
/// its white becomes (1,1,1). Values that are not finite stay. Throws Error if the file is not a readable image, has
/// more than `max_pixels` pixels, or does not fit into memory.
Image read_image(const std::filesystem::path& path, ColorEncoding encoding = ColorEncoding::automatic,
                 std::uint64_t max_pixels = FileAccess::default_max_pixels);

/// The attributes that `write_image` wrote ("lanthorn:NAME"), by name without prefix, as the text of a JSON object.
std::string read_image_metadata(const std::filesystem::path& path);

}  // namespace lanthorn
