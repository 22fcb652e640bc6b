// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "light/brightness.h"
#include "light/profile.h"
#include "math/sampling.h"
#include "spectrum/curve.h"

namespace lanthorn {

/// The same in all directions.
struct EvenProfile {
  static constexpr const char *of_point = "point", *of_far = "infinite (constant)";

  SpectrumCurve curve;  ///< scale included

  Spectrum value(const Direction& /*all alike*/, const Wavelengths& w) const { return curve.evaluate(w); }
  std::optional<ProfileSample> sample(const Vec2& u, const Wavelengths& w) const {
    return ProfileSample{sample_uniform_sphere(u), curve.evaluate(w), pdf_uniform_sphere};
  }
  float pdf(const Direction& /*all alike*/) const { return pdf_uniform_sphere; }
  std::optional<Vec2> invert(const Direction& direction) const { return invert_uniform_sphere(direction); }
  float integral() const { return luminance(curve.rgb) * 4 * pi; }
  float largest() const { return largest_value(curve); }
  ProfileBounds bounds() const { return {{{0, 0, 1}, -1}, 0, luminance(curve.rgb)}; }
};

}  // namespace lanthorn
