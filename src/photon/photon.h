// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photons as light paths produce them, and as maps store them (12 bytes besides the position).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>

#include "math/packed_float.h"
#include "math/vec.h"
#include "photon/incidence.h"
#include "spectrum/spectrum.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Properties of a photon's light path.
struct PhotonFlags {
  static constexpr int most_eye_scatterings = 63;
  /// Number of scatterings that an eye path may have before it uses the photon, by the depth limit of the whole path.
  /// Stored values are capped at most_eye_scatterings, so that no path exceeds the limit.
  int eye_scatterings = 0;
  bool caustic = false;           ///< at least one delta scattering and no other between the light and this vertex
  bool dispersed = false;         ///< the path met a dispersive interface: see `Wavelengths::dispersed`
  bool from_delta_light = false;  ///< caustic, and emitted at a point or in one direction
  bool direct = false;            ///< straight from the light; never caustic

  constexpr std::uint32_t bits() const {
    return std::uint32_t{caustic} | std::uint32_t{caustic ? from_delta_light : direct} << 1 |
           std::uint32_t{dispersed} << 2;
  }
  static constexpr PhotonFlags from_bits(int eye_scatterings, std::uint32_t b) {
    const bool caustic = (b & 1) != 0, straight = (b & 2) != 0;
    return {eye_scatterings, caustic, (b & 4) != 0, caustic && straight, !caustic && straight};
  }
  friend bool operator==(const PhotonFlags&, const PhotonFlags&) = default;
};

/// A photon at a vertex of a light walk.
struct Photon {
  Spectrum power;  ///< W, >= 0, divided by the number of emitted photons; without a cosine at this vertex
  Point position;  ///< m, world
  Direction wi;    ///< towards the previous vertex of the light path, world
  Normal normal;   ///< of the surface, world
  PhotonFlags flags;
  float flight = 0;  ///< length of the last segment of the light path, m; used on surfaces only

  /// Power times grazing_gain, as maps store it.
  Spectrum gained_power() const { return power * grazing_gain(std::fabs(dot(wi, normal))); }
};

/// Unit vector as two signed normalised integers of `bits` bits each in the low 2·bits bits: the octahedral map
/// (Cigolle et al. 2014), rounded to nearest; the six axes are exact.
template <int bits>
std::uint32_t encode_octahedral(const Vec3& v) {
  constexpr float levels = static_cast<float>((1 << (bits - 1)) - 1);
  const float inv = 1.0f / (std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z));
  float x = v.x * inv, y = v.y * inv;
  if (v.z < 0) {
    const float folded = std::copysign(1.0f - std::fabs(y), x);
    y = std::copysign(1.0f - std::fabs(x), y);
    x = folded;
  }
  constexpr std::uint32_t mask = (1u << bits) - 1;
  const auto quantised = [](float t) { return static_cast<std::uint32_t>(std::lrint(t * levels)) & mask; };
  return quantised(x) | quantised(y) << bits;
}

/// Unit vector of the low 2·bits bits of `code`.
template <int bits>
Vec3 decode_octahedral(std::uint32_t code) {
  constexpr float levels = static_cast<float>((1 << (bits - 1)) - 1);
  const auto coordinate = [](std::uint32_t c) {
    return static_cast<float>(static_cast<std::int32_t>(c << (32 - bits)) >> (32 - bits)) * (1.0f / levels);
  };
  float x = coordinate(code), y = coordinate(code >> bits);
  const float z = 1.0f - std::fabs(x) - std::fabs(y);
  const float fold = std::max(0.0f, -z);
  x -= std::copysign(fold, x);
  y -= std::copysign(fold, y);
  return Vec3(x, y, z) * (1.0f / std::sqrt(x * x + y * y + z * z));
}

/// The power of two (W) in whose units a map stores powers. It brings the largest power into [2^14, 2^15), inside the
/// range of half floats and RGB9E5. Powers down to 2^-28 of the largest keep the full precision of half floats.
float power_unit(float largest_power);

/// The power of two (m) in whose units a map codes the lengths of flights, so that the longest one fits.
float flight_unit(float longest_flight);

/// Units in which a map stores its photons.
struct PhotonUnits {
  float power = 1;   ///< W
  float flight = 1;  ///< m
};

/// A photon without its position, in 12 bytes. The stored power includes grazing_gain.
///  both modes:    wi 2×12 bits, eye scatterings 6 bits, two flags
///  RGB mode:      power RGB9E5 | normal 2×12 bits, rest 4 bits
///  spectral mode: four half floats of power whose sign bits are the rest; no normal
/// The rest are a flag and, in three bits, the length of the flight: 1, 8, 64 ... 8^7 units, rounded down.
struct PackedPhoton {
  static constexpr int direction_bits = 12;
  static constexpr std::uint32_t flight_codes = 8, octaves_of_code = 3;
  std::array<std::uint32_t, 3> words;

  static PackedPhoton pack(const Photon& photon, ColorMode mode, const PhotonUnits& units);

  Direction wi() const { return decode_octahedral<direction_bits>(words[0]); }
  /// In the map's units.
  Spectrum power(ColorMode mode) const {
    if (mode == ColorMode::rgb) {
      const Vec3 rgb = decode_rgb9e5(words[1]);
      return {rgb.x, rgb.y, rgb.z, 0};
    }
    const auto half = [this](unsigned i) {
      return decode_half(static_cast<std::uint16_t>(words[1 + i / 2] >> (16 * (i % 2)) & 0x7fffu));
    };
    return {half(0), half(1), half(2), half(3)};
  }
  /// nullopt in spectral mode.
  std::optional<Normal> normal(ColorMode mode) const {
    if (mode == ColorMode::spectral) return std::nullopt;
    return decode_octahedral<12>(words[2]);
  }
  PhotonFlags flags(ColorMode mode) const {
    return PhotonFlags::from_bits(static_cast<int>(words[0] >> 24 & 63u), words[0] >> 30 | (rest(mode) & 8u) >> 1);
  }
  /// In the map's units.
  float flight(ColorMode mode) const { return static_cast<float>(1u << octaves_of_code * (rest(mode) & 7u)); }

 private:
  std::uint32_t rest(ColorMode mode) const {
    if (mode == ColorMode::rgb) return words[2] >> 24;
    return (words[1] >> 15 & 1) | (words[1] >> 31) << 1 | (words[2] >> 15 & 1) << 2 | (words[2] >> 31) << 3;
  }
};

/// The same at full precision, for builds with `LANTHORN_FULL_PRECISION_PHOTONS`.
struct FullPhoton {
  Spectrum scaled_power;
  Direction incident;
  Normal surface_normal;
  PhotonFlags photon_flags;
  float scaled_flight;

  static FullPhoton pack(const Photon& photon, ColorMode, const PhotonUnits& units) {
    return {photon.gained_power() * (1 / units.power), photon.wi, photon.normal, photon.flags,
            photon.flight / units.flight};
  }
  Direction wi() const { return incident; }
  Spectrum power(ColorMode) const { return scaled_power; }
  std::optional<Normal> normal(ColorMode mode) const {
    if (mode == ColorMode::spectral) return std::nullopt;
    return surface_normal;
  }
  PhotonFlags flags(ColorMode) const { return photon_flags; }
  float flight(ColorMode) const { return scaled_flight; }
};

#ifdef LANTHORN_FULL_PRECISION_PHOTONS
using StoredPhoton = FullPhoton;
#else
using StoredPhoton = PackedPhoton;
#endif

/// Records that light paths leave in scattering media.
enum class MediumRecords : std::uint8_t {
  none,
  points,  ///< photons where they scatter
  beams,   ///< their flights up to the next surface, as far as they could scatter
  /// Their flights up to where they scatter. On grids, where the probability of passing a point is unknown, as `beams`.
  short_beams
};

/// Share of a pass's light paths whose flights are kept as beams. A beam is found all along its length, so that a
/// thousand beams do the work of hundreds of thousands of points; more beams cost more than they gain.
inline float share_of_beams(std::uint64_t light_paths) {
  constexpr double wanted = 1024;
  return light_paths == 0 ? 1.0f : static_cast<float>(std::min(1.0, wanted / static_cast<double>(light_paths)));
}

}  // namespace lanthorn
