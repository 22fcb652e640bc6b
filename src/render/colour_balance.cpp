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

// The data that determine the wavelengths of a render's passes.
struct WavelengthSets {
  std::uint64_t seed = 0, per_pass = 1;
  bool disperses = false;
};

// None if every path draws its own. Settings may come from a file: nothing is taken for granted.
std::optional<WavelengthSets> wavelength_sets(const nlohmann::json& settings) {
  const auto identity = settings.find("identity");
  if (identity == settings.end() || !identity->is_object()) return {};
  const auto seed = identity->find("seed"), sets = identity->find("plateau_wavelength_sets");
  if (seed == identity->end() || !seed->is_number_unsigned()) return {};
  if (sets == identity->end() || !sets->is_number_unsigned()) return {};
  const WavelengthSets found{seed->get<std::uint64_t>(), sets->get<std::uint64_t>(),
                             identity->contains("heroes_of_paths")};
  constexpr std::uint64_t most_sets = 16;
  return found.per_pass > 0 && found.per_pass <= most_sets ? std::optional(found) : std::nullopt;
}

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
  const std::optional<WavelengthSets> sets = wavelength_sets(nlohmann::json::parse(state.settings));
  std::uint64_t count = 0;
  for (const PassRange& range : passes) count += range.end - range.begin;
  if (!sets || count == 0 || count > many) return {1, 1, 1};
  std::array<double, 3> sum{};
  for (const PassRange& range : passes)
    for (std::uint64_t set = range.begin * sets->per_pass; set < range.end * sets->per_pass; ++set) {
      const PlaceInHalf place =
          place_in_half(static_cast<std::uint32_t>(set), static_cast<std::uint32_t>(sets->per_pass));
      const Rgb white = white_of(wavelengths_of_pass(sets->seed, ColorMode::spectral, place, sets->disperses));
      sum[0] += static_cast<double>(white.r);
      sum[1] += static_cast<double>(white.g);
      sum[2] += static_cast<double>(white.b);
    }
  const auto all = static_cast<double>(count * sets->per_pass);
  const auto factor = [&](double channel) {
    constexpr double largest = 100;  // bound for wavelengths that all miss a channel
    return static_cast<float>(channel * largest > all ? all / channel : 1.0);
  };
  return {factor(sum[0]), factor(sum[1]), factor(sum[2])};
}

}  // namespace lanthorn
