// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/colour_balance.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "path/path_draw.h"
#include "spectrum/cie.h"

namespace lanthorn {

namespace {

// What decides the wavelengths of a render's passes.
struct WavelengthSets {
  std::uint64_t seed = 0, per_pass = 1;
};

// None if every path draws its own. Settings may come from a file: nothing is taken for granted.
std::optional<WavelengthSets> wavelength_sets(const nlohmann::json& settings) {
  const auto identity = settings.find("identity");
  if (identity == settings.end() || !identity->is_object()) return {};
  const auto seed = identity->find("seed"), sets = identity->find("wavelength_sets");
  if (seed == identity->end() || !seed->is_number_unsigned()) return {};
  if (sets == identity->end() || !sets->is_number_unsigned()) return {};
  const WavelengthSets found{seed->get<std::uint64_t>(), sets->get<std::uint64_t>()};
  constexpr std::uint64_t most_sets = 16;
  return found.per_pass > 0 && found.per_pass <= most_sets ? std::optional(found) : std::nullopt;
}

// A colour estimate as a sum over the table's wavelengths: what light of 1 at each brings.
using Response = std::array<Tristimulus, spectrum_samples>;

Tristimulus colour_of(const DenseSpectrum& spectrum, const Response& response) {
  Tristimulus sum;
  for (std::size_t i = 0; i < spectrum_samples; ++i) sum = sum + double{spectrum.values[i]} * response[i];
  return sum;
}

// The film's mean response to the wavelengths of these passes. Those between two entries of the table count as the
// nearest.
Response mean_response(const WavelengthSets& sets, std::span<const PassRange> passes) {
  Response response{};
  double count = 0;
  for (const PassRange& range : passes)
    for (std::uint64_t set = range.begin * sets.per_pass; set < range.end * sets.per_pass; ++set, ++count) {
      const Wavelengths w = wavelengths_of_pass(sets.seed, ColorMode::spectral, static_cast<std::uint32_t>(set));
      for (unsigned i = 0; i < w.lambda.size(); ++i) {
        Spectrum at_one;
        at_one.v[i] = 1;
        const Rgb rgb = w.to_rgb(at_one);
        Tristimulus& sum = response[static_cast<std::size_t>(w.lambda[i] - lambda_min + 0.5f)];
        sum = sum + Tristimulus{rgb.r, rgb.g, rgb.b};
      }
    }
  for (Tristimulus& sum : response) sum = (1 / count) * sum;
  return response;
}

struct KnownColour {
  DenseSpectrum spectrum;
  Tristimulus rgb;  ///< what the film shows in the limit
  double weight;    ///< 1 / luminance^2, bounded for what is nearly black
};

// Smooth reflectances of all colours under D65.
std::vector<KnownColour> known_colours() {
  constexpr std::array levels{0.05f, 0.35f, 0.65f, 0.9f};
  std::vector<KnownColour> colours;
  for (const float r : levels)
    for (const float g : levels)
      for (const float b : levels) {
        const SpectrumCurve reflectance = SpectrumCurve::albedo({r, g, b});
        KnownColour colour;
        for (std::size_t i = 0; i < spectrum_samples; ++i)
          colour.spectrum.values[i] = illuminant_d65.values[i] * reflectance.at(lambda_min + static_cast<float>(i));
        const Tristimulus xyz = to_xyz(colour.spectrum);
        colour.rgb = xyz_to_rec709 * xyz;
        colour.weight = 1 / (1e-3 + xyz.y * xyz.y);
        colours.push_back(colour);
      }
  return colours;
}

double dot(const Tristimulus& a, const Tristimulus& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Each row m of the map minimises  sum_k w_k (m . e_k - c_k)^2 + ridge |m - unit|^2  under the constraint  m . white =
// 1, with the estimates e_k and one channel c_k of the true colours. With  A = sum_k w_k e_k e_k^T + ridge I  and b =
// sum_k w_k c_k e_k + ridge unit, the multiplier gives  m = A^-1 (b + t white), t = (1 - white . A^-1 b) / (white .
// A^-1 white).
RgbMatrix best_map(const Response& response) {
  static const std::vector<KnownColour> colours = known_colours();
  constexpr double ridge = 1e-2;  // of sums of about 100: decides only what the colours leave open
  Matrix3 a{{{{ridge, 0, 0}, {0, ridge, 0}, {0, 0, ridge}}}};
  Matrix3 b = a;
  for (const KnownColour& known : colours) {
    const Tristimulus e = colour_of(known.spectrum, response), c = known.rgb;
    const std::array estimate{e.x, e.y, e.z}, colour{c.x, c.y, c.z};
    for (std::size_t row = 0; row < 3; ++row) {
      a.row[row] = a.row[row] + (known.weight * estimate[row]) * e;
      b.row[row] = b.row[row] + (known.weight * colour[row]) * e;
    }
  }
  const Matrix3 inverse_a = inverse(a);
  const Tristimulus white = colour_of(illuminant_d65, response), along = inverse_a * white;
  RgbMatrix map;
  for (std::size_t row = 0; row < 3; ++row) {
    const Tristimulus free = inverse_a * b.row[row];
    const Tristimulus m = free + ((1 - dot(white, free)) / dot(white, along)) * along;
    map.rows[row] = {static_cast<float>(m.x), static_cast<float>(m.y), static_cast<float>(m.z)};
  }
  return map;
}

}  // namespace

RgbMatrix colour_balance(const RenderState& state) { return colour_balance(state, state.passes); }

RgbMatrix colour_balance(const RenderState& state, std::span<const PassRange> passes) {
  constexpr std::uint64_t many = 1 << 20;  // as good as all
  const std::optional<WavelengthSets> sets = wavelength_sets(nlohmann::json::parse(state.settings));
  std::uint64_t count = 0;
  for (const PassRange& range : passes) count += range.end - range.begin;
  if (!sets || count == 0 || count > many) return {};
  return best_map(mean_response(*sets, passes));
}

}  // namespace lanthorn
