// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/volume_light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "math/hash.h"
#include "math/sampling.h"

namespace lanthorn {

namespace {

// Rows of blocks along x, so that the first number chooses x and the second y and z.
PiecewiseConstant2d rows_of(std::span<const float> values, int resolution) {
  const auto n = static_cast<std::size_t>(resolution);
  return {{values.begin(), values.end()}, n, n * n};
}

}  // namespace

EmissionTable::EmissionTable(BlockGrid emission, const MediumBox& place)
    : to_medium_(place.to_medium), density_(std::move(emission)) {
  const std::span<float> values = density_.values();
  const auto count = static_cast<double>(values.size());
  constexpr float least = 0.05f;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  for (float& value : values) value = std::max(value, least * static_cast<float>(mean));
  blocks_ = rows_of(values, density_.resolution());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<float>(static_cast<double>(blocks_.pdf_of_cell(i)) / place.volume());
}

EmissionTable::Start EmissionTable::sample(const Vec2& u) const {
  const std::optional<PiecewiseConstant2d::Sample> s = blocks_.sample(u);
  if (!s) return {};
  // Two numbers determine a block and two coordinates in it. The third coordinate is a hash of both.
  const auto n = static_cast<float>(density_.resolution());
  const float third = unit_float(hash_words({std::bit_cast<std::uint32_t>(u.x), std::bit_cast<std::uint32_t>(u.y)}));
  const Vec2 in_block(s->at.x * n - std::floor(s->at.x * n), s->at.y * n * n - std::floor(s->at.y * n * n));
  const Bounds block = density_.block(s->cell);
  const Point p = block.min + Vec3(in_block, third) * block.extent();
  return {to_medium_.inverted().point(p), density_.value(s->cell)};
}

template <class Integral>
float EmissionTable::integrate(const Point& origin, const Direction& direction, Integral&& integral) const {
  float sum = 0;
  density_.for_each_piece({to_medium_.point(origin), to_medium_.vector(direction), infinity},
                          [&](float t0, float t1, float density) {
                            sum += density * integral(t0, t1);
                            return true;
                          });
  return sum;
}

float EmissionTable::per_area(const Point& origin, const Direction& direction) const {
  return integrate(origin, direction, [](float t0, float t1) { return t1 - t0; });
}

float EmissionTable::per_solid_angle(const Point& origin, const Direction& direction) const {
  return integrate(origin, direction, [](float t0, float t1) { return (t1 - t0) * (t1 * t1 + t1 * t0 + t0 * t0) / 3; });
}

std::optional<LightSample> VolumeLight::sample_direct(const Point& from, const Vec2& u, const Wavelengths&) const {
  std::optional<LightSample> result;
  const Vec3 way = table->sample(u).position - from;
  const float distance2 = length_squared(way);
  if (!(distance2 > 0)) return result;
  LightSample& sample = result.emplace();
  sample.wi = way / std::sqrt(distance2);
  sample.position = from;
  sample.radiance = Spectrum(1);
  sample.pdf = pdf_direct(from, sample.wi);
  if (!(sample.pdf > 0)) result.reset();
  return result;
}

std::optional<EmissionSample> VolumeLight::sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                           const Wavelengths& w) const {
  std::optional<EmissionSample> result;
  const EmissionTable::Start start = table->sample(u_position);
  EmissionSample& sample = result.emplace();
  sample.origin = start.position;
  sample.direction = sample_uniform_sphere(u_direction);
  sample.flux = emission_at(*medium, start.position, w) * (4 * pi / start.density);
  sample.pdf_position = start.density;
  sample.pdf_direction = pdf_uniform_sphere;
  return result;
}

EmissionPdf VolumeLight::pdf_emission(const EmitterHit& origin, const Direction& direction) const {
  return {table->per_area(origin.position, -direction), pdf_uniform_sphere};
}

EmissionNumbers VolumeLight::invert_emission(const EmitterHit& /*anywhere on the ray*/,
                                             const Direction& direction) const {
  return {.direction = invert_uniform_sphere(direction)};
}

EmissionBounds VolumeLight::bounds() const {
  return {table->world_bounds(), {{0, 0, 1}, -1}, 0, watts / (4 * pi), false};
}

}  // namespace lanthorn
