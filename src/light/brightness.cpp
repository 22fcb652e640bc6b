// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/brightness.h"

#include <algorithm>

#include "spectrum/wavelengths.h"

namespace lanthorn {

float largest_value(const SpectrumCurve& curve) {
  float largest = std::max(max_component(curve.rgb), curve.at(lambda_min));
  if (!curve.varies()) return largest;
  for (int nm = static_cast<int>(lambda_min); nm <= static_cast<int>(lambda_max); ++nm)
    largest = std::max(largest, curve.at(static_cast<float>(nm)));
  return largest;
}

float largest_value(const LightTexels& texels) {
  Rgb brightest;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const Rgb texel = texels[i];
    brightest.r = std::max(brightest.r, texel.r);
    brightest.g = std::max(brightest.g, texel.g);
    brightest.b = std::max(brightest.b, texel.b);
  }
  return largest_value(SpectrumCurve::illuminant(brightest));
}

}  // namespace lanthorn
