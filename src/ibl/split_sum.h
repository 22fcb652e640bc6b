// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Split-sum shading with the maps of an environment (docs/methods/ibl.md).
#pragma once

#include <vector>

#include "ibl/cube_map.h"
#include "lanthorn/ibl.h"

namespace lanthorn {

/// The maps that shading needs, for an equirectangular image.
IblSettings split_sum_settings(const Image& environment);
inline constexpr int split_sum_table_size = 128;

class SplitSum {
 public:
  /// Bakes everything that shading needs from an equirectangular image.
  explicit SplitSum(const Image& environment);

  /// (1/pi) ∫ L cos dω.
  Spectrum irradiance(const Normal& n) const { return irradiance_.lookup(n); }
  /// Reflection of the environment in a rough mirror, for its direction of reflection: trilinear.
  Spectrum reflection(const Direction& r, float alpha) const;

  /// Reflection of a white environment: F0 scale + F90 bias.
  struct Brdf {
    float scale = 1, bias = 0;
  };
  Brdf brdf(float cos, float alpha) const;

  const CubeMap& irradiance_map() const { return irradiance_; }
  const std::vector<CubeMap>& levels() const { return levels_; }
  const Image& table() const { return table_; }

 private:
  CubeMap irradiance_{1};
  std::vector<CubeMap> levels_;
  Image table_;
};

/// A visible normal of the microsurface, in the space in which the microsurface is a hemisphere (Dupuy & Benyoub 2023):
/// uniform in azimuth and in the height above the lower end of the visible cap.
struct CapSample {
  float cos_phi, height;
};
/// The samples of each texel of `brdf_table`.
std::vector<CapSample> cap_samples();

}  // namespace lanthorn
