// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The wavelengths at which a frame's paths meet dispersive glass.
#pragma once

#include <cmath>
#include <cstdint>

#include "math/sampler.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// In RGB mode a path through dispersive glass has the colour of its one wavelength. Each path of a frame has its own
/// wavelength, so that glass shows the mean colour over all of them: wavelengths of neighbouring pixels lie far apart,
/// and so do wavelengths of a pixel in successive frames. A photon and the eye path that finds it have independent
/// wavelengths, and their colours multiply. Where both are dispersed this is right in the mean, except that light is
/// not seen through the glass at the wavelength at which it came.
class FrameHeroes {
 public:
  /// Without dispersion, glass has the index of a wavelength in the middle for all paths, and no colour.
  FrameHeroes(bool disperses, std::uint64_t seed, std::uint32_t frame)
      : disperses_(disperses),
        shift_(unit_float(second_sobol_coordinate(frame)) +
               unit_float(hash_words({seed, static_cast<std::uint64_t>(stream_of("wavelengths of a frame"))}))) {}

  /// Wavelengths of the path through a pixel.
  Wavelengths of_pixel(int x, int y) const {
    // Roberts' plane-filling sequence: the fractional parts of these multiples are even in any small block.
    return at(0.7548777 * x + 0.5698403 * y);
  }
  Wavelengths of_photon(std::size_t index) const { return at(0.6180340 * static_cast<double>(index)); }

 private:
  Wavelengths at(double place) const {
    if (!disperses_) {
      Wavelengths w = Wavelengths::rgb(0.5f);
      w.dispersed = Spectrum(1, 1, 1, 0);
      return w;
    }
    const double u = place + static_cast<double>(shift_);
    return Wavelengths::rgb(std::fmin(static_cast<float>(u - std::floor(u)), one_minus_epsilon));
  }

  bool disperses_;
  float shift_;
};

}  // namespace lanthorn
