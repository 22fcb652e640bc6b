// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/colour_balance.h"

#include <array>
#include <cstdint>

#include "path/path_draw.h"
#include "spectrum/cie.h"

namespace lanthorn {

namespace {

// The film's colour of the illuminant D65, estimated with four wavelengths. Its mean over wavelengths is (1, 1, 1).
Rgb white_of(const Wavelengths& w) {
  Spectrum light;
  for (int i = 0; i < 4; ++i) light[i] = illuminant_d65.at(w.lambda[static_cast<unsigned>(i)]);
  return w.to_rgb(light);
}

}  // namespace

Rgb colour_balance(const RenderState& state) { return colour_balance(state, state.passes); }

Rgb colour_balance(const RenderState& state, std::span<const PassRange> passes) {
  constexpr std::uint64_t many = 1 << 20;  // as good as all
  const RenderIdentity& render = state.record.identity;
  std::uint64_t count = 0;
  for (const PassRange& range : passes) count += range.end - range.begin;
  if (!render.wavelength_sets || count == 0 || count > many) return {1, 1, 1};
  const std::uint32_t sets = *render.wavelength_sets;
  std::array<double, 3> sum{};
  for (const PassRange& range : passes)
    for (std::uint64_t set = range.begin * sets; set < range.end * sets; ++set) {
      const PlaceInHalf place = place_in_half(static_cast<std::uint32_t>(set), sets);
      const Rgb white = white_of(wavelengths_of_pass(render.seed, ColorMode::spectral, place, render.heroes_of_paths));
      sum[0] += static_cast<double>(white.r);
      sum[1] += static_cast<double>(white.g);
      sum[2] += static_cast<double>(white.b);
    }
  const auto all = static_cast<double>(count * sets);
  const auto factor = [&](double channel) {
    constexpr double largest = 100;  // bound for wavelengths that all miss a channel
    return static_cast<float>(channel * largest > all ? all / channel : 1.0);
  };
  return {factor(sum[0]), factor(sum[1]), factor(sum[2])};
}

}  // namespace lanthorn
