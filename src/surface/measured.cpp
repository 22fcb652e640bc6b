// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Dupuy & Jakob 2018, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", §3 and §4.
#include "surface/measured.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "math/frame.h"
#include "spectrum/curve.h"

namespace lanthorn {
namespace {

/// Lower bound of the sampling density, as a share of the mean luminance: every reflecting direction can be sampled.
constexpr float least_luminance = 0.01f;
constexpr float smallest_alpha = 1e-3f;

float elevation(const Vec3& w) { return std::atan2(std::hypot(w.x, w.y), w.z); }
float azimuth_of(const Vec3& w) { return std::atan2(w.y, w.x); }

Vec2 to_square(float theta, float phi) {
  const float y = (phi + pi) / (2 * pi);
  return {std::sqrt(std::max(theta, 0.0f) * (2 / pi)), y - std::floor(y)};
}
Vec3 direction(float theta, float phi) {
  const float sin = std::sin(theta);
  return {sin * std::cos(phi), sin * std::sin(phi), std::cos(theta)};
}
// Solid angle per unit area of the square of normals.
float solid_angle(const Vec2& normal, const Vec3& m) { return 2 * sqr(pi) * normal.x * std::hypot(m.x, m.y); }

float bilinear(const NodeGrids& grids, std::size_t grid, const GridCell& cell) {
  const auto [column, row] = cell.node;
  const float* at = &grids.values[grid * grids.size_of_grid() + row * grids.width + column];
  const float* above = at + grids.width;
  return lerp(cell.t.y, lerp(cell.t.x, at[0], at[1]), lerp(cell.t.x, above[0], above[1]));
}
float bilinear(const NodeGrids& grids, const Vec2& at) {
  return bilinear(grids, 0, GridCell::find(at, grids.width, grids.height));
}

struct Interval {
  std::size_t below = 0, above = 0;
  float t = 0;
};
// Interval between ascending nodes that contains x; outside the nodes, the first or last node.
Interval find_interval(const std::vector<float>& nodes, float x) {
  const auto next = static_cast<std::size_t>(std::upper_bound(nodes.begin(), nodes.end(), x) - nodes.begin());
  if (next == 0) return {0, 0, 0};
  if (next == nodes.size()) return {next - 1, next - 1, 0};
  return {next - 1, next, (x - nodes[next - 1]) / (nodes[next] - nodes[next - 1])};
}

std::vector<float> raised_luminance(const NodeGrids& luminance) {
  std::vector<float> values = luminance.values;
  const std::size_t size = luminance.size_of_grid();
  for (std::size_t first = 0; first < values.size(); first += size) {
    double sum = 0;
    for (std::size_t i = first; i < first + size; ++i) sum += static_cast<double>(std::max(values[i], 0.0f));
    const float least = sum > 0 ? least_luminance * static_cast<float>(sum / static_cast<double>(size)) : 1.0f;
    for (std::size_t i = first; i < first + size; ++i) values[i] = std::max(values[i], least);
  }
  return values;
}

// Converts groups of `shares.size()` grids to groups of three.
std::vector<float> to_rgb(const std::vector<float>& values, std::size_t size_of_grid, const std::vector<Rgb>& shares) {
  const std::size_t groups = values.size() / (shares.size() * size_of_grid);
  std::vector<float> rgb(groups * 3 * size_of_grid);
  for (std::size_t k = 0; k < groups * shares.size(); ++k) {
    const Rgb& share = shares[k % shares.size()];
    float* to = &rgb[k / shares.size() * 3 * size_of_grid];
    for (const float s : {share.r, share.g, share.b})
      for (std::size_t n = 0; n < size_of_grid; ++n) *to++ += s * values[k * size_of_grid + n];
  }
  return rgb;
}

Spectrum upsampled(const Rgb& c, const Wavelengths& w) {
  const float largest = std::max(1.0f, max_component(c));
  return largest * evaluate_albedo((1 / largest) * c, w);
}

// Signs that map a direction to the measured range of azimuths; the light's direction is multiplied by them too.
Vec3 symmetry_signs(const Vec3& view, int symmetry) {
  const auto negative = [](float x) { return x > 0 ? -1.0f : 1.0f; };
  if (symmetry == 2) return {negative(view.y), negative(view.y), 1};
  if (symmetry == 4) return {negative(view.x), negative(view.y), 1};
  return {1, 1, 1};
}

}  // namespace

struct MeasuredBrdf::Place {
  Blend blend;         // weights of the incident directions
  Vec2 normal;         // position in the square of normals
  Vec2 warped;         // position in the measurement's warped square
  float vndf_pdf = 0;  // per area of the square of normals
  Vec3 m;
};

MeasuredBrdf::MeasuredBrdf(const MeasuredData& data, int albedo_side)
    : data_(&data),
      vndf_(data.vndf.values, data.vndf.width, data.vndf.height),
      luminance_(raised_luminance(data.luminance), data.luminance.width, data.luminance.height) {
  assert(data.reflectance.count() == data.incidence_count() * data.channel_count());
  albedo_ = mean_weights(albedo_side);
  alpha_ = equivalent_alpha();
  if (data.wavelengths.empty()) return;
  const std::vector<Rgb> shares = rgb_shares(data.wavelengths);
  rgb_ = {data.reflectance.width, data.reflectance.height,
          to_rgb(data.reflectance.values, data.reflectance.size_of_grid(), shares)};
  rgb_albedo_ = to_rgb(albedo_, 1, shares);
}

Blend MeasuredBrdf::incidence(const Vec3& view) const {
  // For a full turn, the measured azimuths may start at any angle.
  float azimuth_in_grid = azimuth_of(view);
  const float begin = data_->phi.front();
  if (!data_->is_isotropic() && data_->symmetry == 1)
    azimuth_in_grid -= 2 * pi * std::floor((azimuth_in_grid - begin) / (2 * pi));
  const Interval p = find_interval(data_->phi, azimuth_in_grid), t = find_interval(data_->theta, elevation(view));
  const auto index = [&](std::size_t phi, std::size_t theta) {
    return static_cast<std::uint32_t>(phi * data_->theta.size() + theta);
  };
  return {{index(p.below, t.below), index(p.below, t.above), index(p.above, t.below), index(p.above, t.above)},
          {(1 - p.t) * (1 - t.t), (1 - p.t) * t.t, p.t * (1 - t.t), p.t * t.t}};
}

Vec2 MeasuredBrdf::normal_in_square(const Vec3& m, const Vec3& view) const {
  const float phi = azimuth_of(m);
  return to_square(elevation(m), data_->is_isotropic() ? phi - azimuth_of(view) : phi);
}

std::optional<MeasuredBrdf::Place> MeasuredBrdf::find(const Vec3& view, const Vec3& light) const {
  if (!(view.z > 0 && light.z > 0)) return std::nullopt;
  Place place;
  place.m = normalize(view + light);
  place.blend = incidence(view);
  place.normal = normal_in_square(place.m, view);
  const BilinearDistributions::Sample warped = vndf_.invert(place.normal, place.blend);
  place.warped = warped.at;
  place.vndf_pdf = warped.pdf;
  return place;
}

// Ratio of f cos(theta) to the stored reflectance.
float MeasuredBrdf::factor(const Vec3& view, const Place& place) const {
  if (!data_->weighted) return 1;
  const float sigma = bilinear(data_->sigma, to_square(elevation(view), azimuth_of(view)));
  return sigma > 0 ? std::max(0.0f, bilinear(data_->ndf, place.normal)) / (4 * sigma) : 0.0f;
}

// `lookup(rgb, channel)`: value of a channel as measured, or of one of the three Rec.709 channels.
template <class Lookup>
Spectrum MeasuredBrdf::in_colour_mode(const Wavelengths& w, const Lookup& lookup) const {
  if (w.mode == ColorMode::rgb || data_->wavelengths.empty()) {
    const auto channel = [&](std::size_t k) { return std::max(0.0f, lookup(true, k)); };
    const Rgb c{channel(0), channel(1), channel(2)};
    return w.mode == ColorMode::rgb ? Spectrum(c.r, c.g, c.b, 0) : upsampled(c, w);
  }
  Spectrum s;
  for (std::size_t i = 0; i < 4; ++i) {
    const Interval at = find_interval(data_->wavelengths, w.lambda[i]);
    const float below = lookup(false, at.below);
    s.v[i] = std::max(0.0f, at.t > 0 ? lerp(at.t, below, lookup(false, at.above)) : below);
  }
  return s;
}

Spectrum MeasuredBrdf::reflectance(const Place& place, const Wavelengths& w) const {
  const NodeGrids& measured = data_->reflectance;
  const GridCell cell = GridCell::find(place.warped, measured.width, measured.height);
  return in_colour_mode(w, [&](bool rgb, std::size_t channel) {
    const bool converted = rgb && !data_->wavelengths.empty();
    const NodeGrids& grids = converted ? rgb_ : measured;
    const std::size_t channels = converted ? 3 : data_->channel_count();
    float sum = 0;
    for (std::size_t i = 0; i < place.blend.index.size(); ++i)
      if (place.blend.weight[i] > 0)
        sum += place.blend.weight[i] * bilinear(grids, place.blend.index[i] * channels + channel, cell);
    return sum;
  });
}

float MeasuredBrdf::sampling_pdf(const Vec3& view, const Place& place) const {
  const float p = place.vndf_pdf * luminance_.pdf(place.warped, place.blend);
  const float jacobian = 4 * dot(view, place.m) * solid_angle(place.normal, place.m);
  return p > 0 && jacobian > 0 ? p / jacobian : 0.0f;
}

BsdfValue MeasuredBrdf::evaluate(const Vec3& any_view, const Vec3& any_light, const Wavelengths& w,
                                 BsdfParts parts) const {
  BsdfValue value;
  if (!parts.f && !parts.pdf) return value;
  const Vec3 signs = symmetry_signs(any_view, data_->symmetry);
  const Vec3 view = signs * any_view, light = signs * any_light;
  const std::optional<Place> place = find(view, light);
  if (!place) return value;
  if (parts.f) value.f = reflectance(*place, w) * (factor(view, *place) / light.z);
  if (parts.pdf) value.pdf = sampling_pdf(view, *place);
  return value;
}

std::optional<MeasuredBrdf::Place> MeasuredBrdf::draw(const Vec3& view, const Vec2& u) const {
  Place place;
  place.blend = incidence(view);
  place.warped = luminance_.sample(u, place.blend).at;
  const BilinearDistributions::Sample normal = vndf_.sample(place.warped, place.blend);
  if (!(normal.pdf > 0)) return std::nullopt;
  place.normal = normal.at;
  place.vndf_pdf = normal.pdf;
  const float phi = (2 * normal.at.y - 1) * pi;
  place.m = direction(sqr(normal.at.x) * (pi / 2), data_->is_isotropic() ? phi + azimuth_of(view) : phi);
  return dot(view, place.m) > 0 ? std::optional(place) : std::nullopt;
}

std::optional<Vec3> MeasuredBrdf::sample(const Vec3& any_view, const Vec2& u) const {
  const Vec3 signs = symmetry_signs(any_view, data_->symmetry);
  const Vec3 view = signs * any_view;
  const std::optional<Place> place = draw(view, u);
  if (!place) return std::nullopt;
  const Vec3 light = normalize(2 * dot(view, place->m) * place->m - view);
  return light.z > 0 ? std::optional(signs * light) : std::nullopt;
}

Spectrum MeasuredBrdf::albedo(const Vec3& view, const Wavelengths& w) const {
  const Blend blend = incidence(symmetry_signs(view, data_->symmetry) * view);
  const Spectrum sum = in_colour_mode(w, [&](bool rgb, std::size_t channel) {
    const bool converted = rgb && !data_->wavelengths.empty();
    const std::vector<float>& table = converted ? rgb_albedo_ : albedo_;
    const std::size_t channels = converted ? 3 : data_->channel_count();
    float mean = 0;
    for (std::size_t i = 0; i < blend.index.size(); ++i)
      mean += blend.weight[i] * table[blend.index[i] * channels + channel];
    return mean;
  });
  return map(sum, [](float x) { return std::min(x, 1.0f); });
}

// Mean sample weight for each incident direction and channel, over samples spread evenly over the square.
std::vector<float> MeasuredBrdf::mean_weights(int side) const {
  const auto samples = static_cast<float>(side * side);
  const std::size_t channels = data_->channel_count();
  std::vector<float> means(data_->incidence_count() * channels);
  for (std::size_t i = 0; i < data_->incidence_count(); ++i) {
    const float theta = std::min(data_->theta[i % data_->theta.size()], 1.57f);
    const Vec3 view = direction(theta, data_->phi[i / data_->theta.size()]);
    for (int n = 0; n < side * side; ++n) {
      const int column = n % side, row = n / side;
      const Vec2 u =
          (Vec2(static_cast<float>(column), static_cast<float>(row)) + Vec2(0.5f)) / static_cast<float>(side);
      const std::optional<Place> place = draw(view, u);
      if (!place || !(2 * dot(view, place->m) * place->m.z - view.z > 0)) continue;
      const float density = sampling_pdf(view, *place);
      if (!(density > 0)) continue;
      const float weight = factor(view, *place) / (density * samples);
      const GridCell cell = GridCell::find(place->warped, data_->reflectance.width, data_->reflectance.height);
      for (std::size_t k = 0; k < channels; ++k)
        means[i * channels + k] += weight * bilinear(data_->reflectance, i * channels + k, cell);
    }
  }
  return means;
}

float MeasuredBrdf::equivalent_alpha() const {
  const NodeGrids& ndf = data_->ndf;
  double area = 0;
  float peak = 0;
  for (std::size_t i = 0; i < ndf.size_of_grid(); ++i) {
    const std::size_t column = i % ndf.width, row = i / ndf.width;
    const Vec2 at(static_cast<float>(column) / static_cast<float>(ndf.width - 1),
                  static_cast<float>(row) / static_cast<float>(ndf.height - 1));
    const Vec3 m = direction(sqr(at.x) * (pi / 2), 0);
    area += static_cast<double>(ndf.values[i] * m.z * solid_angle(at, m));
    peak = std::max(peak, ndf.values[i]);
  }
  area /= static_cast<double>((ndf.width - 1) * (ndf.height - 1));
  if (!(area > 0) || !(peak > 0)) return 1;
  return std::clamp(std::sqrt(static_cast<float>(area) / (pi * peak)), smallest_alpha, 1.0f);
}

namespace {

// The measurement covers one side; the other side is its point reflection.
float side_of(const Vec3& w) { return std::copysign(1.0f, w.z); }

}  // namespace

BsdfValue evaluate(const Measured& m, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts) {
  if (transport == Transport::importance) return reversed(evaluate(m, wo, wi, Transport::radiance, reversed(parts)));
  const Vec3 i = side_of(wi) * wi, o = side_of(wi) * wo;
  BsdfValue value = m.brdf->evaluate(i, o, m.wavelengths, parts);
  value.pdf_reverse = m.brdf->evaluate(o, i, m.wavelengths, {.pdf = parts.pdf_reverse}).pdf;
  return value;
}

std::optional<BsdfSample> sample(const Measured& m, const Vec3& wi, float /*u_lobe: one lobe*/, const Vec2& u,
                                 Transport transport) {
  if (wi.z == 0) return std::nullopt;
  const float side = side_of(wi);
  const std::optional<Vec3> drawn = m.brdf->sample(side * wi, u);
  if (!drawn) return std::nullopt;
  const Vec3 wo = side * *drawn;
  return sample_of_all(wo, abs_cos_theta(wo), evaluate(m, wi, wo, transport, {.f = true, .pdf = true}));
}

Spectrum albedo(const Measured& m, const Vec3& wi) { return m.brdf->albedo(side_of(wi) * wi, m.wavelengths); }

}  // namespace lanthorn
