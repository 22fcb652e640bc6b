// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/metal_rgb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "spectrum/cie.h"
#include "spectrum/wavelengths.h"
#include "surface/fresnel.h"

namespace lanthorn::metal_rgb_test {
namespace {

std::array<double, 3> under_white(float cosine, const SpectrumCurve& eta, const SpectrumCurve& k) {
  std::array<double, 3> sum{};
  constexpr int steps = 2000;
  for (int i = 0; i < steps; ++i) {
    const Wavelengths w = Wavelengths::spectral((static_cast<float>(i) + 0.5f) / steps);
    Spectrum light = fresnel_conductor(cosine, eta.evaluate(w), k.evaluate(w));
    for (int c = 0; c < 4; ++c) light[c] *= illuminant_d65.at(w.lambda[static_cast<unsigned>(c)]);
    const Rgb rgb = w.to_rgb(light);
    sum[0] += static_cast<double>(rgb.r) / steps;
    sum[1] += static_cast<double>(rgb.g) / steps;
    sum[2] += static_cast<double>(rgb.b) / steps;
  }
  return sum;
}

// A metal in RGB mode has the colour of its spectrum under white light, at every angle. Gold's red exceeds what a
// channel can reflect: it stays nearly 1 at grazing angles, where the spectrum's red dips by 1.5 %.
TEST(MetalRgb, ReflectsLikeItsSpectrum) {
  for (const char* const metal : {"Ag", "Al", "Au", "Cu", "CuZn"}) {
    const auto curve = [&](const char* quantity) {
      return SpectrumCurve::tabulated(named_spectrum((std::string("metal-") + metal + quantity).c_str()));
    };
    SpectrumCurve eta = curve("-eta"), k = curve("-k");
    fit_metal_rgb(eta, k);
    const std::array<double, 3> facing = under_white(1, eta, k);
    for (const float cosine : {1.0f, 0.8f, 0.5f, 0.3f, 0.15f, 0.05f}) {
      const std::array<double, 3> expected = under_white(cosine, eta, k);
      const Spectrum rgb = fresnel_conductor(cosine, Spectrum(eta.rgb.r, eta.rgb.g, eta.rgb.b, 0),
                                             Spectrum(k.rgb.r, k.rgb.g, k.rgb.b, 0));
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(static_cast<double>(rgb.v[c]), std::min(expected[c], 1.0), facing[c] > 1 ? 0.02 : 0.006)
            << metal << " cos " << cosine << " channel " << c;
    }
  }
}

}  // namespace
}  // namespace lanthorn::metal_rgb_test
