// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "film/film_pass.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <type_traits>

#include "film/fixed_point.h"
#include "math/hash.h"

namespace lanthorn {

namespace {

// Contributions of fewer steps are rounded stochastically, so that systematic rounding errors do not accumulate.
constexpr double dither_below = 0x1p12;
// Slot numbers are hashed for stochastic rounding: slots of samples, then of splats, of spectral values, and of parts.
constexpr unsigned parts_slot = 64;

// Weight of the value at wavelength i in its bucket: 1 / (4 pdf width).
double bucket_share(const SpectralRadiance& value, std::size_t i, const SpectralBuckets& buckets) {
  return 0.25 / (static_cast<double>(value.pdf[i]) * static_cast<double>(buckets.width()));
}

}  // namespace

std::int64_t FilmPass::to_steps(double value, double steps_per_unit, std::uint32_t pixel, unsigned slot) const {
  const double steps = value * steps_per_unit;
  const double magnitude = std::fabs(steps);
  if (magnitude >= dither_below && magnitude <= contribution_limit) return std::llrint(steps);
  if (magnitude < dither_below) {
    if (steps == 0) return 0;
    const std::uint64_t bits = hash_words(
        {pass_, (std::uint64_t{film_.pixel_of_full_film(pixel)} << 32) | slot, std::bit_cast<std::uint64_t>(value)});
    const double rounded = std::floor(magnitude + static_cast<double>(bits >> 11) * 0x1p-53);
    return static_cast<std::int64_t>(steps < 0 ? -rounded : rounded);
  }
  if (!std::isfinite(steps)) {
    note(film_.non_finite_, pixel);
    return 0;
  }
  note(film_.too_large_, pixel);
  return static_cast<std::int64_t>(std::copysign(contribution_limit, steps));
}

void FilmPass::note(Film::Problem& problem, std::uint32_t pixel) const {
  std::atomic_ref(problem.count).fetch_add(1, std::memory_order_relaxed);
  const std::uint64_t place = std::min<std::uint64_t>(pass_, 0xffffffffu) << 32 | pixel;
  const std::atomic_ref first(problem.first);
  std::uint64_t old = first.load(std::memory_order_relaxed);
  while (place < old && !first.compare_exchange_weak(old, place, std::memory_order_relaxed)) {
  }
}

// Branches once per sample instead of once per value, so that the loops vectorise.
template <class Stride>
bool FilmPass::add_ordinary(std::int64_t* sums, const Values& values, Stride stride) const {
  constexpr double large = 0x1p50;
  constexpr std::int64_t safe_sum = sum_limit - (std::int64_t{1} << 50);
  Values steps;
  int odd = 0;
  for (std::size_t i = 0; i < stride; ++i) {
    steps[i] = values[i] * film_.sample_steps_[i];
    const double magnitude = std::fabs(steps[i]);
    odd |= static_cast<int>(!((magnitude >= dither_below) & (magnitude <= large)) & !(magnitude == 0));
    odd |= static_cast<int>((sums[i] > safe_sum) | (sums[i] < -safe_sum));
  }
  if (odd) return false;
  // Adding 1.5 * 2^52 rounds to the nearest integer and leaves it in the low bits: the result of llrint, but
  // vectorised. The products above are exact (floats times powers of two), so fusing one with this sum changes nothing.
  constexpr double shift = 0x1.8p52;
  for (std::size_t i = 0; i < stride; ++i)
    sums[i] += std::bit_cast<std::int64_t>(steps[i] + shift) - std::bit_cast<std::int64_t>(shift);
  return true;
}

// The sample's values in the order of the sums. `factor`: scales its light, by the sensor's limit.
FilmPass::Values FilmPass::values_of(const PixelSample& sample, float factor) const {
  const double hit = sample.features.is_hit() ? 1.0 : 0.0;
  Values values{};
  std::size_t slot = 0;
  const auto put = [&](float value) { values[slot++] = static_cast<double>(value); };
  const auto put_color = [&](const Rgb& color) {
    put(color.r);
    put(color.g);
    put(color.b);
  };
  const auto put_vector = [&](const Vec3& value) { put_color({value.x, value.y, value.z}); };
  const auto put_light = [&](const Rgb& value) {
    put_color(film_.sensor_.balanced(factor == 1 ? value : factor * value));
  };
  for (const Rgb& layer : std::span(sample.light).first(contents().layer_count())) put_light(layer);
  if (contents().bias) put_light(sample.bias);
  sample.features.for_each([&]<class Value>(const char*, const Value& value) {
    if constexpr (is_number<Value>)
      values[slot++] = static_cast<double>(value.value_or(0.0f)) * hit;
    else if constexpr (std::is_same_v<Value, Position>)
      put_vector(value.at);
    else if constexpr (std::is_same_v<Value, Vec3>)
      put_vector(value);
    else
      put_color(value);
  });
  values[slot++] = hit;
  values[slot] = 1;
  return values;
}

void FilmPass::add_values(std::uint32_t pixel, std::size_t filter_part, const Values& values) const {
  const std::size_t stride = film_.samples_stride();
  std::int64_t* sums = &half_.samples[filter_part][std::size_t{pixel} * stride];
  // Most methods have four light layers, photon methods also a bias; strides known at compile time let the loops
  // vectorise.
  constexpr std::integral_constant<std::size_t, 3 * 4 + Film::surface_slots> usual;
  constexpr std::integral_constant<std::size_t, 3 * 5 + Film::surface_slots> with_bias;
  if (stride == usual       ? add_ordinary(sums, values, usual)
      : stride == with_bias ? add_ordinary(sums, values, with_bias)
                            : add_ordinary(sums, values, stride))
    return;
  for (unsigned i = 0; i < stride; ++i) saturating_add(sums[i], to_steps(values[i], film_.sample_steps_[i], pixel, i));
}

void FilmPass::add(std::uint32_t pixel, const PixelSample& sample) const {
  assert(pixel < film_.pixel_count());
  const std::span<const Rgb> light = std::span(sample.light).first(contents().light.size());
  const float factor = film_.sensor_.clamp_factor(std::accumulate(light.begin() + 1, light.end(), light.front()));
  const Values values = values_of(sample, factor);
  const auto filter_part = static_cast<std::size_t>(sample.filter_part);
  assert(filter_part == 0 || contents().negative_share != 0);
  const SpinLocks::Guard guard(film_.pixel_locks_, pixel);
  if (film_.parts_stride() > 0) add_parts(pixel, sample, static_cast<double>(factor));
  if (film_.buckets() && sample.spectrum) add_spectrum(pixel, sample, static_cast<double>(factor));
  add_values(pixel, filter_part, values);
}

void FilmPass::add_parts(std::uint32_t pixel, const PixelSample& sample, double factor) const {
  std::int64_t* sums =
      &film_.parts_[static_cast<std::size_t>(sample.filter_part)][std::size_t{pixel} * film_.parts_stride()];
  unsigned slot = parts_slot;
  for (const Rgb& light : std::span(sample.parts).first(contents().decomposition.parts.size())) {
    const Rgb counted = film_.sensor_.balanced(light);
    for (const float component : {counted.r, counted.g, counted.b})
      saturating_add(*sums++, to_steps(static_cast<double>(component) * factor, film_.radiance_steps_, pixel, slot++));
  }
}

void FilmPass::splat(std::uint32_t pixel, std::size_t layer, const Rgb& value) const {
  assert(contents().splats && pixel < film_.pixel_count() && layer < contents().layer_count());
  std::int64_t* sums = &half_.splats[std::size_t{pixel} * film_.splats_stride() + 3 * layer];
  auto slot =
      static_cast<unsigned>(film_.samples_stride() + 3 * layer);  // distinct from the samples' slots in the hash
  const Rgb counted = splat_share_ * film_.sensor_.balanced(value);
  for (const float component : {counted.r, counted.g, counted.b}) {
    const std::int64_t steps = to_steps(static_cast<double>(component), film_.radiance_steps_, pixel, slot++);
    if (steps != 0) saturating_add_shared(*sums, steps);
    ++sums;
  }
}

void FilmPass::add_spectrum(std::uint32_t pixel, const PixelSample& sample, double factor) const {
  const SpectralRadiance& value = *sample.spectrum;
  std::int64_t* sums =
      &film_.spectra_[static_cast<std::size_t>(sample.filter_part)][std::size_t{pixel} * film_.spectra_stride()];
  const auto slot = static_cast<unsigned>(film_.samples_stride() + film_.splats_stride());
  for (unsigned i = 0; i < value.lambda.size(); ++i) {
    const std::optional<std::size_t> bucket = contents().buckets->find(value.lambda[i]);
    if (!bucket) continue;
    const double counted = bucket_share(value, i, *contents().buckets);
    const double light = static_cast<double>(value.radiance[i]) * factor * counted;
    saturating_add(sums[*bucket], to_steps(light, film_.radiance_steps_, pixel, slot + i));
    saturating_add(sums[contents().buckets->count + *bucket], to_steps(counted, unit_steps, pixel, slot + 4 + i));
  }
}

void FilmPass::splat_spectrum(std::uint32_t pixel, const SpectralRadiance& value, float weight) const {
  assert(contents().splats && contents().buckets && pixel < film_.pixel_count());
  std::int64_t* sums = &film_.spectral_splats_[std::size_t{pixel} * contents().buckets->count];
  const auto slot = static_cast<unsigned>(film_.samples_stride() + film_.splats_stride() + 8);
  for (unsigned i = 0; i < value.lambda.size(); ++i) {
    const std::optional<std::size_t> bucket = contents().buckets->find(value.lambda[i]);
    if (!bucket) continue;
    const double light =
        static_cast<double>(splat_share_ * weight * value.radiance[i]) * bucket_share(value, i, *contents().buckets);
    const std::int64_t steps = to_steps(light, film_.radiance_steps_, pixel, slot + i);
    if (steps != 0) saturating_add_shared(sums[*bucket], steps);
  }
}

}  // namespace lanthorn
