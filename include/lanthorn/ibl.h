// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Image-based lighting: the tables that real-time engines look up instead of integrating over an environment
// (docs/methods/ibl.md). Maps are normalised: a white environment of radiance 1 gives 1.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lanthorn/color.h"
#include "lanthorn/file_access.h"
#include "lanthorn/image.h"

namespace lanthorn {

/// How an image covers the sphere of directions; y is up. A cube map's texel stores the light from the direction for
/// which OpenGL looks it up.
enum class EnvironmentLayout : std::uint8_t {
  equirectangular,  ///< 2:1; the top row is +y, the centre +x, +z a quarter of the width to its right
  octahedral,       ///< square, equal-area, as in pbrt-v4 but y-up: pbrt's (x, y, z) is our (x, z, -y)
  cube,             ///< 6:1, faces +X -X +Y -Y +Z -Z, rows from the top
};
const char* layout_name(EnvironmentLayout layout);
/// Layout by the image's aspect ratio; nullopt if none fits.
std::optional<EnvironmentLayout> layout_of(const Image& image);

/// Radiance of an environment. Sums over the sphere could overflow for larger values.
inline constexpr float largest_environment_radiance = 1e30f;

/// Reads an environment from one image, or from six square ones, the faces of a cube. Other cube layouts (1:6, 4:3 or
/// 3:4 cross) are converted to 6:1. Throws Error, naming the file, if it cannot be read, has no colours, has an unknown
/// shape, holds a value that is not finite, or none in (0, `largest_environment_radiance`].
Image read_environment(const std::vector<std::filesystem::path>& files,
                       std::uint64_t max_pixels = FileAccess::default_max_pixels);

/// Roughness of each level of the specular map; x = level / last level.
enum class RoughnessMapping : std::uint8_t {
  square,    ///< roughness = x; alpha = roughness²
  linear,    ///< alpha = x
  filament,  ///< x = roughness (2 - roughness), Filament's mapping; alpha = roughness²
};

/// Weight of the light within the lobe of the specular map.
enum class LobeWeight : std::uint8_t {
  cosine,   ///< n·l (Karis 2013): what engines expect
  masking,  ///< Smith's G2 / G1, the exact weight for n = v = r
};

struct IblSettings {
  bool irradiance = true, specular = true, sh = true;  ///< which maps to bake
  int irradiance_size = 32;                            ///< texels along an edge of a face
  int specular_size = 256, smallest_size = 16;         ///< of the first and the last level, powers of two
  int samples = 4096;                                  ///< per texel of the specular map's last level
  RoughnessMapping mapping = RoughnessMapping::square;
  LobeWeight weight = LobeWeight::cosine;
  bool windowed = false;  ///< windows the spherical harmonics to suppress ringing
  int checks = 8;         ///< texels of each map that are compared with brute-force integration
  /// Called during the work with the completed fraction, in [0,1].
  std::function<void(double)> progress = [](double) {};
};

/// Real spherical harmonics with y up; (l, m) is at index l² + l + m. No Condon-Shortley phase.
template <std::size_t bands>
using ShCoefficients = std::array<Rgb, bands * bands>;

struct ShMaps {
  ShCoefficients<4> radiance{};  ///< projection of the environment, order 3
  /// Projection of the irradiance divided by pi, order 3; the first nine are equal to those for order 2. Band 3 is 0
  /// for every environment.
  ShCoefficients<4> irradiance{};
  double window = 0;  ///< lambda of the window 1 / (1 + lambda l² (l + 1)²) in `irradiance`; 0 for none
};
/// Irradiance divided by pi on a surface with this unit normal; `order` is 2 or 3.
Rgb irradiance_at(const ShMaps& sh, const std::array<float, 3>& normal, std::size_t order);

/// Differences from brute-force integration, relative to the root mean square of the exact values at all checked
/// texels.
struct MapError {
  double rms = 0, max = 0;
  int checks = 0;
};

struct SpecularLevel {
  Image faces;  ///< six side by side; R, G, B
  float roughness = 0, alpha = 0;
  int samples = 0;
  std::optional<MapError> error;
};

struct Ibl {
  EnvironmentLayout layout = EnvironmentLayout::equirectangular;
  int width = 0, height = 0;
  std::uint64_t unusable_values = 0;  ///< negative, non-finite or above `largest_environment_radiance`; count as 0
  Rgb mean;                           ///< mean radiance over the sphere
  std::uint64_t sun_texels = 0;       ///< texels whose excess over `sun_threshold` is integrated exactly
  float sun_threshold = 0;            ///< luminance above which light is excess
  Rgb sun_share;                      ///< share of the excess in the flux

  std::optional<Image> irradiance;  ///< six faces side by side; R, G, B
  std::optional<MapError> irradiance_error;
  std::vector<SpecularLevel> specular;
  std::optional<ShMaps> sh;
  std::optional<MapError> sh_error;  ///< of the irradiance by order 2, which omits the bands from 4 on
};

/// Throws Error for sizes that are not powers of two, and if memory does not suffice. The result does not depend on the
/// number of threads.
Ibl bake_ibl(const Image& environment, const IblSettings& settings);

/// Table of the split-sum approximation: the reflection of a white environment by GGX with Schlick's Fresnel term is F0
/// R + G. Columns are n·v, rows roughness (alpha = roughness²), both at (i + ½) / size. B is the albedo of Charlie
/// sheen of the same alpha, or 0. Multiple scattering (Fdez-Agüera 2019) needs only R and G.
Image brdf_table(int size, bool sheen);
/// Error of R and G at `checks` entries against integration over all microfacet normals.
MapError brdf_table_error(const Image& table, int checks);

/// Formats of texels in texture files.
enum class TexelFormat : std::uint8_t {
  half,    ///< R16G16B16A16F
  rgb9e5,  ///< three mantissas of nine bits and one exponent
};

/// A texture: levels from the largest on, each half as wide as the one before; a cube's are six faces side by side.
struct Texture {
  std::vector<const Image*> levels;
  bool cube = true;
  TexelFormat format = TexelFormat::half;
};
/// Files in memory. Values beyond the format's range are clamped to it.
std::string encode_ktx2(const Texture& texture, const std::map<std::string, std::string>& key_values);
std::string encode_dds(const Texture& texture);

/// All maps to look at, in linear colours.
Image contact_sheet(const Ibl& ibl);

}  // namespace lanthorn
