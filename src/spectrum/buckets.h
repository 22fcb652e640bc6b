// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "spectrum/curve.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Equal intervals of a range of wavelengths.
struct SpectralBuckets {
  std::size_t count = 16;
  float low = lambda_min, high = lambda_max;  ///< nm

  float width() const { return (high - low) / static_cast<float>(count); }
  double centre(std::size_t bucket) const {
    const double share = (static_cast<double>(bucket) + 0.5) / static_cast<double>(count);
    return static_cast<double>(low) + share * (static_cast<double>(high) - static_cast<double>(low));
  }
  /// The bucket of a wavelength; nullopt outside the range.
  std::optional<std::size_t> find(float nm) const {
    if (!(nm >= low && nm <= high)) return std::nullopt;
    return std::min(static_cast<std::size_t>((nm - low) / width()), count - 1);
  }
  friend bool operator==(const SpectralBuckets&, const SpectralBuckets&) = default;
};

/// Radiance at the four wavelengths of a path.
struct SpectralRadiance {
  std::array<float, 4> radiance{};
  std::array<float, 4> lambda{};  ///< nm
  std::array<float, 4> pdf{};     ///< of each wavelength, per nm

  SpectralRadiance() = default;
  /// In spectral mode.
  SpectralRadiance(const Spectrum& s, const Wavelengths& w) : radiance(s.v), lambda(w.lambda), pdf(w.pdf) {}
};

}  // namespace lanthorn
