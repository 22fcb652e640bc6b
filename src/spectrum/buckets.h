// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "lanthorn/color.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

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
