// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/colour_balance.h"

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

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

// The seed, if all paths of a pass share their wavelengths. Settings may come from a file: nothing is taken for
// granted.
std::optional<std::uint64_t> seed_of_pass_wavelengths(const nlohmann::json& settings) {
  const auto shared = settings.find("pass_wavelengths"), identity = settings.find("identity");
  if (shared == settings.end() || *shared != true || identity == settings.end() || !identity->is_object()) return {};
  const auto seed = identity->find("seed");
  if (seed == identity->end() || !seed->is_number_unsigned()) return {};
  return seed->get<std::uint64_t>();
}

}  // namespace

Rgb colour_balance(const RenderState& state) { return colour_balance(state, state.passes); }

Rgb colour_balance(const RenderState& state, std::span<const PassRange> passes) {
  constexpr std::uint64_t many = 1 << 22;  // as good as all: the factors are 1 to seven digits
  const std::optional<std::uint64_t> seed = seed_of_pass_wavelengths(nlohmann::json::parse(state.settings));
  if (!seed || state.pass_count() > many) return {1, 1, 1};
  std::array<double, 3> sum{};
  double count = 0;
  for (const PassRange& range : passes)
    for (std::uint64_t pass = range.begin; pass < range.end; ++pass, ++count) {
      const Rgb white = white_of(wavelengths_of_pass(*seed, ColorMode::spectral, static_cast<std::uint32_t>(pass)));
      sum[0] += static_cast<double>(white.r);
      sum[1] += static_cast<double>(white.g);
      sum[2] += static_cast<double>(white.b);
    }
  const auto factor = [&](double channel) {
    constexpr double largest = 100;  // a pass whose wavelengths all miss a channel says nothing about it
    return static_cast<float>(channel * largest > count ? count / channel : 1.0);
  };
  return {factor(sum[0]), factor(sum[1]), factor(sum[2])};
}

}  // namespace lanthorn
