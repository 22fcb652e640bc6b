// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "texture/spectrum_store.h"

#include <algorithm>
#include <cmath>

namespace lanthorn {

namespace {

using description::SpectrumRole;

Rgb non_negative(const Rgb& c) { return {std::fmax(0.0f, c.r), std::fmax(0.0f, c.g), std::fmax(0.0f, c.b)}; }

bool is_finite(const Rgb& c) { return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b); }

void check_samples(const description::SampledSpectrum& s, const SourceLocation& location) {
  if (s.nm.empty() || s.nm.size() != s.values.size())
    throw Error(location, "a sampled spectrum needs as many values as wavelengths");
  if (std::adjacent_find(s.nm.begin(), s.nm.end(), std::greater_equal<>()) != s.nm.end())
    throw Error(location, "the wavelengths of a sampled spectrum must ascend");
  const auto are_finite = [](const std::vector<float>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](float x) { return std::isfinite(x); });
  };
  if (!are_finite(s.nm) || !are_finite(s.values))
    throw Error(location, "a sampled spectrum has a number that is infinite or not a number");
}

}  // namespace

SpectrumCurve SpectrumStore::curve(const description::SpectrumValue& value, SpectrumRole role, ColorSpace space,
                                   const SourceLocation& location) {
  const bool is_light = role == SpectrumRole::illuminant;
  const auto table = [&](const DenseSpectrum& s) {
    if (is_light) return SpectrumCurve::tabulated_light(keep(normalized_luminance(s)));
    return SpectrumCurve::tabulated(keep(s));
  };
  if (const auto* constant = std::get_if<float>(&value)) {
    if (!std::isfinite(*constant)) throw Error(location, "a spectrum is infinite or not a number");
    if (is_light) return SpectrumCurve::illuminant({*constant, *constant, *constant}, space);
    return SpectrumCurve::constant(*constant);
  }
  if (const auto* rgb = std::get_if<description::RgbSpectrum>(&value)) {
    if (!is_finite(rgb->rgb)) throw Error(location, "a colour has a component that is infinite or not a number");
    const Rgb colour = non_negative(rgb->rgb);
    switch (role) {
      case SpectrumRole::albedo:
        return SpectrumCurve::albedo(colour, rgb->space);
      case SpectrumRole::unbounded:
        return SpectrumCurve::unbounded(colour, rgb->space);
      case SpectrumRole::illuminant:
        return SpectrumCurve::illuminant(colour, rgb->space);
    }
  }
  if (const auto* black = std::get_if<description::BlackbodySpectrum>(&value)) return table(blackbody(black->kelvin));
  if (const auto* named = std::get_if<description::NamedSpectrum>(&value)) {
    const DenseSpectrum* known = named_spectrum(named->name.c_str());
    if (known == nullptr) throw Error(location, "spectrum \"" + named->name + "\" is not known");
    return is_light ? table(*known) : SpectrumCurve::tabulated(known);
  }
  const auto& samples = std::get<description::SampledSpectrum>(value);
  check_samples(samples, location);
  return table(resample(samples.nm.data(), samples.values.data(), samples.nm.size(), !is_light));
}

}  // namespace lanthorn
