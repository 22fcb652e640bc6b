// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "lanthorn/color.h"

namespace lanthorn {

inline float max_component(const Rgb& c) { return std::max(c.r, std::max(c.g, c.b)); }
/// Rec.709 relative luminance.
inline float luminance(const Rgb& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

/// Four numbers whose meaning depends on the current `Wavelengths`. RGB mode: linear Rec.709 RGB and an unused fourth
/// component that stays 0. Spectral mode: values at the path's four wavelengths.
struct alignas(16) Spectrum {
  std::array<float, 4> v{};

  constexpr Spectrum() = default;
  constexpr explicit Spectrum(float x) : v{x, x, x, x} {}
  constexpr Spectrum(float a, float b, float c, float d) : v{a, b, c, d} {}

  constexpr float operator[](int i) const { return v[static_cast<unsigned>(i)]; }
  constexpr float& operator[](int i) { return v[static_cast<unsigned>(i)]; }

  constexpr Spectrum& operator+=(const Spectrum& o) {
    for (unsigned i = 0; i < 4; ++i) v[i] += o.v[i];
    return *this;
  }
  constexpr Spectrum& operator-=(const Spectrum& o) {
    for (unsigned i = 0; i < 4; ++i) v[i] -= o.v[i];
    return *this;
  }
  constexpr Spectrum& operator*=(const Spectrum& o) {
    for (unsigned i = 0; i < 4; ++i) v[i] *= o.v[i];
    return *this;
  }
  constexpr Spectrum& operator/=(const Spectrum& o) {
    for (unsigned i = 0; i < 4; ++i) v[i] /= o.v[i];
    return *this;
  }
  constexpr Spectrum& operator*=(float s) {
    for (unsigned i = 0; i < 4; ++i) v[i] *= s;
    return *this;
  }
  constexpr Spectrum& operator/=(float s) { return *this *= 1.0f / s; }

  friend constexpr Spectrum operator+(Spectrum a, const Spectrum& b) { return a += b; }
  friend constexpr Spectrum operator-(Spectrum a, const Spectrum& b) { return a -= b; }
  friend constexpr Spectrum operator*(Spectrum a, const Spectrum& b) { return a *= b; }
  friend constexpr Spectrum operator/(Spectrum a, const Spectrum& b) { return a /= b; }
  friend constexpr Spectrum operator*(Spectrum a, float s) { return a *= s; }
  friend constexpr Spectrum operator*(float s, Spectrum a) { return a *= s; }
  friend constexpr Spectrum operator/(Spectrum a, float s) { return a /= s; }
  friend constexpr bool operator==(const Spectrum&, const Spectrum&) = default;

  constexpr bool is_black() const { return v[0] == 0 && v[1] == 0 && v[2] == 0 && v[3] == 0; }
};

inline float sum_of(const Spectrum& s) { return s[0] + s[1] + s[2] + s[3]; }
inline float mean_component(const Spectrum& s) { return 0.25f * sum_of(s); }
inline float max_component(const Spectrum& s) { return std::max(std::max(s[0], s[1]), std::max(s[2], s[3])); }
inline bool is_finite(const Spectrum& s) {
  return std::isfinite(s[0]) && std::isfinite(s[1]) && std::isfinite(s[2]) && std::isfinite(s[3]);
}
template <class F>
constexpr Spectrum map(const Spectrum& s, F&& f) {
  return {f(s[0]), f(s[1]), f(s[2]), f(s[3])};
}
inline Spectrum sqrt(const Spectrum& s) {
  return map(s, [](float x) { return std::sqrt(std::max(0.0f, x)); });
}
inline Spectrum exp(const Spectrum& s) {
  return map(s, [](float x) { return std::exp(x); });
}

}  // namespace lanthorn
