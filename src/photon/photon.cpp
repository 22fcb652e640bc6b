// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/photon.h"

#include <algorithm>
#include <cmath>

namespace lanthorn {

float power_unit(float largest_power) {
  int exponent = 0;
  if (!(largest_power > 0) || !std::isfinite(largest_power)) return 1;
  std::frexp(largest_power, &exponent);
  return std::ldexp(1.0f, std::max(exponent - 15, -126));
}

float flight_unit(float longest_flight) {
  if (!(longest_flight > 0) || !std::isfinite(longest_flight)) return 1;
  constexpr int octaves = static_cast<int>(PackedPhoton::flight_codes * PackedPhoton::octaves_of_code);
  return std::ldexp(1.0f, std::max(std::ilogb(longest_flight) + 1 - octaves, -126));
}

PackedPhoton PackedPhoton::pack(const Photon& photon, ColorMode mode, const PhotonUnits& units) {
  const auto eye_scatterings =
      static_cast<std::uint32_t>(std::clamp(photon.flags.eye_scatterings, 0, PhotonFlags::most_eye_scatterings));
  const std::uint32_t wi = encode_octahedral<direction_bits>(photon.wi);
  const std::uint32_t flags = photon.flags.bits();
  const std::uint32_t path = wi | eye_scatterings << 24 | (flags & 3u) << 30;
  const Spectrum power = photon.gained_power() * (1 / units.power);
  // The rounded direction must not lift the start of a grazing flight off a sheet that is parallel to the surface.
  const float exact = std::fabs(dot(photon.wi, photon.normal));
  const float rounded = std::fabs(dot(decode_octahedral<direction_bits>(wi), photon.normal));
  const float length = photon.flight * (rounded > exact ? exact / rounded : 1.0f) / units.flight;
  const std::uint32_t octaves = (std::bit_cast<std::uint32_t>(std::max(1.0f, length)) >> 23) - 127;
  const std::uint32_t rest = std::min(octaves / octaves_of_code, flight_codes - 1) | (flags & 4u) << 1;
  if (mode == ColorMode::rgb)
    return {{path, encode_rgb9e5(power[0], power[1], power[2]), encode_octahedral<12>(photon.normal) | rest << 24}};
  const auto half = [&](int i) {
    const std::uint32_t magnitude = encode_half(std::clamp(power[i], 0.0f, largest_half));
    return magnitude | (rest >> i & 1u) << 15;
  };
  return {{path, half(0) | half(1) << 16, half(2) | half(3) << 16}};
}

}  // namespace lanthorn
