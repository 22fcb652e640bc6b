// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "spectrum/curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spectrum/cie.h"
#include "spectrum/sigmoid_fit.h"

namespace lanthorn {
namespace {

using Coefficients = std::array<float, 3>;

constexpr float unlimited = std::numeric_limits<float>::infinity();

/// Jakob & Hanika 2019, equations 2 and 3.
float sigmoid(const Coefficients& c, float nm) {
  const float q = (c[0] * nm + c[1]) * nm + c[2];
  return 0.5f + 0.5f * q / std::sqrt(1 + q * q);
}

Spectrum sigmoid(const Coefficients& c, const Wavelengths& w) {
  Spectrum s;
  for (unsigned i = 0; i < 4; ++i) s.v[i] = sigmoid(c, w.lambda[i]);
  return s;
}

/// Values at the nearest nanometres; the path's wavelengths must lie in the table's range.
Spectrum look_up(const DenseSpectrum& table, const Wavelengths& w) {
  Spectrum s;
  for (unsigned i = 0; i < 4; ++i) s.v[i] = table.values[static_cast<unsigned>(w.lambda[i] - lambda_min + 0.5f)];
  return s;
}

DenseSpectrum equal_energy() {
  DenseSpectrum s;
  s.values.fill(1);
  return s;
}

/// Mean of the curve, weighted by the Rec.709 response to equal energy.
Rgb mean_under_equal_energy(const DenseSpectrum& s) {
  const Tristimulus white = xyz_to_rec709 * to_xyz(equal_energy());
  const Tristimulus c = xyz_to_rec709 * to_xyz(s);
  return {static_cast<float>(c.x / white.x), static_cast<float>(c.y / white.y), static_cast<float>(c.z / white.z)};
}

/// Constant term of the quadratic for a grey reflectance g, whose curve is constant.
float grey_coefficient(float g) {
  constexpr float tiny = 1e-12f;  // keeps the coefficients finite for black and white
  return (g - 0.5f) / std::sqrt(std::max(tiny, g * (1 - g)));
}

Rgb from_tristimulus(const Tristimulus& c) {
  return {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
}
Rgb clamped(const Rgb& c, float low, float high) {
  return {std::clamp(c.r, low, high), std::clamp(c.g, low, high), std::clamp(c.b, low, high)};
}

/// Rec.709 colour of light given in another space (no chromatic adaptation: white may be tinted).
Rgb light_to_rec709(const Rgb& rgb, ColorSpace space) {
  if (space == ColorSpace::srgb) return rgb;
  const Rgb c = from_tristimulus(xyz_to_rec709 * (rgb_to_xyz(space) * Tristimulus{rgb.r, rgb.g, rgb.b}));
  return clamped(c, 0, unlimited);
}

const SigmoidFit& fit_of(ColorSpace space) {
  static const std::array<SigmoidFit, 4> fits = {SigmoidFit(ColorSpace::srgb), SigmoidFit(ColorSpace::dci_p3),
                                                 SigmoidFit(ColorSpace::rec2020), SigmoidFit(ColorSpace::aces2065_1)};
  return fits[static_cast<std::size_t>(space)];
}

Coefficients fitted(const Rgb& rgb, ColorSpace space) {
  return in_nanometres(fit_of(space).fit({rgb.r, rgb.g, rgb.b}));
}

/// Rec.709 colour of a reflectance under illuminant D65.
Rgb seen_under_d65(const SpectrumCurve& curve) {
  DenseSpectrum product;
  for (std::size_t i = 0; i < spectrum_samples; ++i)
    product.values[i] = illuminant_d65.values[i] * curve.at(lambda_min + static_cast<float>(i));
  return from_tristimulus(xyz_to_rec709 * to_xyz(product));
}

bool is_grey(const Rgb& c) { return c.r == c.g && c.g == c.b; }

/// Below this, the hue does not survive rounding, and reciprocals could overflow.
constexpr float negligible = 1e-12f;

/// Upsampled curve of a non-negative colour: with s = twice its largest component, s times the reflectance of colour /
/// s.
SpectrumCurve upsampled(const Rgb& rgb, ColorSpace space) {
  SpectrumCurve curve;
  if (is_grey(rgb) || max_component(rgb) < negligible) {
    curve.scale = rgb.r;
    return curve;
  }
  curve.scale = 2 * max_component(rgb);
  curve.shape = SpectrumCurve::Shape::sigmoid;
  curve.c = fitted((1 / curve.scale) * rgb, space);
  return curve;
}

/// A place on an axis: the node below, and the fraction of the way to the next node.
struct Cell {
  std::size_t node;
  float t;
};
/// `nodes` ascend; x is not below the first node.
Cell find_cell(const std::array<float, sigmoid_nodes>& nodes, float x) {
  std::size_t node = 0;
  for (std::size_t step = (sigmoid_nodes - 1) / 2; step > 0; step /= 2)
    node += step * static_cast<std::size_t>(nodes[node + step] <= x);  // branchless, because x is unpredictable
  return {node, (x - nodes[node]) / (nodes[node + 1] - nodes[node])};
}

template <class Function>
constexpr std::array<float, sigmoid_nodes> at_nodes(Function&& value) {
  std::array<float, sigmoid_nodes> nodes{};
  for (std::size_t i = 0; i < sigmoid_nodes; ++i) nodes[i] = static_cast<float>(value(i));
  return nodes;
}
/// Dark reflectances behave like 1 / (4 q^2) with q the quadratic. Along the largest component, the coefficients are
/// therefore interpolated linearly in its inverse square root (and extrapolated likewise below the first node).
Cell value_cell(float x) {
  static const auto nodes = at_nodes([](std::size_t i) { return -1 / std::sqrt(sigmoid_node_value(i)); });
  return find_cell(nodes, -1 / std::sqrt(x));
}
Cell ratio_cell(float x) {
  static constexpr auto nodes = at_nodes(sigmoid_node_ratio);
  return find_cell(nodes, x);
}

Coefficients mix(float t, const Coefficients& a, const Coefficients& b) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

}  // namespace

float DenseSpectrum::at(float nm) const {
  if (!(nm >= lambda_min && nm <= lambda_max)) return 0;
  return values[static_cast<std::size_t>(nm - lambda_min + 0.5f)];
}

SpectrumCurve SpectrumCurve::constant(float value) {
  SpectrumCurve curve;
  curve.scale = value;
  curve.rgb = {value, value, value};
  return curve;
}

SpectrumCurve SpectrumCurve::albedo(const Rgb& rgb, ColorSpace space) {
  const Rgb c = clamped(rgb, 0, 1);
  if (is_grey(c)) return constant(c.r);
  SpectrumCurve curve;
  curve.shape = Shape::sigmoid;
  curve.scale = 1;
  curve.c = fitted(c, space);
  curve.rgb = space == ColorSpace::srgb ? c : clamped(seen_under_d65(curve), 0, 1);
  return curve;
}

SpectrumCurve SpectrumCurve::unbounded(const Rgb& rgb, ColorSpace space) {
  const Rgb c = clamped(rgb, 0, unlimited);
  SpectrumCurve curve = upsampled(c, space);
  curve.rgb = space == ColorSpace::srgb || is_grey(c) ? c : clamped(seen_under_d65(curve), 0, unlimited);
  return curve;
}

SpectrumCurve SpectrumCurve::illuminant(const Rgb& rgb, ColorSpace space) {
  const Rgb c = clamped(rgb, 0, unlimited);
  SpectrumCurve curve = upsampled(c, space);
  curve.shape = curve.shape == Shape::constant ? Shape::table : Shape::sigmoid_times_table;
  curve.table = &illuminant_of(space);
  curve.rgb = light_to_rec709(c, space);
  return curve;
}

SpectrumCurve SpectrumCurve::tabulated(const DenseSpectrum* table) {
  const auto& values = table->values;
  if (std::all_of(values.begin(), values.end(), [&](float v) { return v == values[0]; })) return constant(values[0]);
  SpectrumCurve curve;
  curve.shape = Shape::table;
  curve.scale = 1;
  curve.table = table;
  curve.rgb = clamped(mean_under_equal_energy(*table), 0, unlimited);
  return curve;
}

SpectrumCurve SpectrumCurve::tabulated_light(const DenseSpectrum* table) {
  SpectrumCurve curve;
  curve.shape = Shape::table;
  curve.scale = 1;
  curve.table = table;
  curve.rgb = clamped(from_tristimulus(xyz_to_rec709 * to_xyz(*table)), 0, unlimited);
  return curve;
}

SpectrumCurve SpectrumCurve::scaled(float s) const {
  SpectrumCurve curve = *this;
  curve.scale *= s;
  curve.rgb = s * rgb;
  return curve;
}

float SpectrumCurve::at(float nm) const {
  switch (shape) {
    case Shape::constant:
      return scale;
    case Shape::sigmoid:
      return scale * sigmoid(c, nm);
    case Shape::table:
      return scale * table->at(nm);
    case Shape::sigmoid_times_table:
      return scale * sigmoid(c, nm) * table->at(nm);
  }
  return 0;
}

Spectrum SpectrumCurve::at_wavelengths(const Wavelengths& w) const {
  switch (shape) {
    case Shape::constant:
      return Spectrum(scale);
    case Shape::sigmoid:
      return scale * sigmoid(c, w);
    case Shape::table:
      return scale * look_up(*table, w);
    case Shape::sigmoid_times_table:
      return scale * sigmoid(c, w) * look_up(*table, w);
  }
  return {};
}

float luminance_of(const DenseSpectrum& s) { return static_cast<float>(to_xyz(s).y); }

DenseSpectrum normalized_luminance(DenseSpectrum s) {
  const double y = to_xyz(s).y;
  if (y > 0)
    for (float& v : s.values) v = static_cast<float>(double{v} / y);
  return s;
}

DenseSpectrum blackbody(float kelvin) {
  DenseSpectrum s;
  if (!(kelvin > 0)) return s;
  constexpr double c2 = 1.438776877e7;  // hc/k, nm K (CODATA 2018)
  // Logarithms, relative to the largest value of the table: nothing under- or overflows at any temperature.
  std::array<double, spectrum_samples> logs;
  for (std::size_t i = 0; i < spectrum_samples; ++i) {
    const double nm = double{lambda_min} + static_cast<double>(i);
    const double x = c2 / (nm * double{kelvin});
    logs[i] = -5 * std::log(nm) - x - std::log(-std::expm1(-x));
  }
  const double largest = *std::max_element(logs.begin(), logs.end());
  for (std::size_t i = 0; i < spectrum_samples; ++i) s.values[i] = static_cast<float>(std::exp(logs[i] - largest));
  return s;
}

DenseSpectrum resample(const float* nm, const float* values, std::size_t count, bool extend_ends) {
  DenseSpectrum s;
  if (count == 0) return s;
  const float* const end = nm + count;
  for (std::size_t i = 0; i < spectrum_samples; ++i) {
    const float x = lambda_min + static_cast<float>(i);
    if (x < nm[0] || x > nm[count - 1]) {
      if (extend_ends) s.values[i] = x < nm[0] ? values[0] : values[count - 1];
      continue;
    }
    const auto above = static_cast<std::size_t>(std::lower_bound(nm, end, x) - nm);
    if (nm[above] == x) {
      s.values[i] = values[above];
      continue;
    }
    const float t = (x - nm[above - 1]) / (nm[above] - nm[above - 1]);
    s.values[i] = values[above - 1] + t * (values[above] - values[above - 1]);
  }
  return s;
}

std::vector<Rgb> rgb_shares(std::span<const float> nm) {
  std::vector<Rgb> shares;
  std::vector<float> unit(nm.size(), 0.0f);
  for (float& one : unit) {
    one = 1;
    shares.push_back(mean_under_equal_energy(resample(nm.data(), unit.data(), nm.size(), true)));
    one = 0;
  }
  return shares;
}

std::array<float, 3> sigmoid_coefficients(const Rgb& rgb) {
  const std::array<float, 3> c = {std::clamp(rgb.r, 0.0f, 1.0f), std::clamp(rgb.g, 0.0f, 1.0f),
                                  std::clamp(rgb.b, 0.0f, 1.0f)};
  const std::size_t largest = c[0] > c[1] ? (c[0] > c[2] ? 0 : 2) : (c[1] > c[2] ? 1 : 2);
  if ((c[0] == c[1] && c[1] == c[2]) || c[largest] < negligible) return {0, 0, grey_coefficient(c[largest])};
  const float inverse_largest = 1 / c[largest];
  const Cell value = value_cell(c[largest]);
  const Cell row = ratio_cell(c[(largest + 2) % 3] * inverse_largest);
  const Cell column = ratio_cell(c[(largest + 1) % 3] * inverse_largest);
  const auto line = [&](std::size_t v, std::size_t r) {
    const std::size_t i = sigmoid_index(largest, value.node + v, row.node + r, column.node);
    return mix(column.t, sigmoid_table[i], sigmoid_table[i + 1]);
  };
  return mix(value.t, mix(row.t, line(0, 0), line(0, 1)), mix(row.t, line(1, 0), line(1, 1)));
}

Spectrum evaluate_albedo(const Rgb& rgb, const Wavelengths& w) {
  if (w.mode == ColorMode::rgb) return {rgb.r, rgb.g, rgb.b, 0};
  return sigmoid(sigmoid_coefficients(rgb), w);
}

Spectrum evaluate_illuminant(const Rgb& rgb, const Wavelengths& w) {
  if (w.mode == ColorMode::rgb) return {rgb.r, rgb.g, rgb.b, 0};
  const float scale = 2 * max_component(rgb);
  if (!(scale >= negligible)) return {};
  return scale * sigmoid(sigmoid_coefficients((1 / scale) * rgb), w) * look_up(illuminant_d65, w);
}

}  // namespace lanthorn
