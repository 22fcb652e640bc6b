// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "denoise/layer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lanthorn::denoising {

namespace {

// The estimated variance of the mean over all passes.
Plane variance_of_mean(const Halves& light, std::size_t channel, const Shares& shares) {
  const Plane &a = light[0][channel], &b = light[1][channel];
  return Plane::of(a.width(), a.height(), [&](std::size_t i) { return shares[0] * shares[1] * sqr(a[i] - b[i]); });
}
// As above, summed over channels and smoothed.
Plane variance_of_mean(const Halves& light, const Shares& shares, int radius) {
  Plane sum = variance_of_mean(light, 0, shares);
  for (std::size_t c = 1; c < color_channels; ++c) {
    const Plane other = variance_of_mean(light, c, shares);
    sum.fill([&](std::size_t i) { return sum[i] + other[i]; });
  }
  return box_filtered(sum, radius);
}

bool is_noisy(const Halves& light) {
  for (std::size_t c = 0; c < color_channels; ++c)
    for (std::size_t i = 0; i < light[0][c].size(); ++i)
      if (light[0][c][i] != light[1][c][i]) return true;
  return false;
}

Halves halved(const Halves& light) {
  Halves out;
  for (std::size_t h = 0; h < 2; ++h)
    for (std::size_t c = 0; c < color_channels; ++c) out[h][c] = halved(light[h][c]);
  return out;
}

// `fine` with its low frequencies replaced by those of `coarse`, which has half its resolution.
Halves joined(const Halves& fine, const Halves& coarse) {
  Halves out = fine;
  for (std::size_t h = 0; h < 2; ++h)
    for (std::size_t c = 0; c < color_channels; ++c) {
      Plane difference = halved(fine[h][c]);
      difference.fill([&](std::size_t i) { return coarse[h][c][i] - difference[i]; });
      difference = doubled(difference, fine[h][c].width(), fine[h][c].height());
      out[h][c].fill([&](std::size_t i) { return out[h][c][i] + difference[i]; });
    }
  return out;
}

// A variance far below any visible one, for guides that are black and without noise.
float least_variance(const ColorPlanes& light) {
  constexpr double part = 1e-6, tiny = 1e-30;
  double sum = 0;
  for (const Plane& plane : light)
    for (std::size_t i = 0; i < plane.size(); ++i) sum += std::fabs(static_cast<double>(plane[i]));
  const double mean = sum / static_cast<double>(light[0].size());
  return static_cast<float>(part * mean * mean + tiny);
}

Halves demodulated(const Halves& light, const ColorPlanes& factors) {
  Halves out = light;
  for (ColorPlanes& half : out)
    for (std::size_t c = 0; c < color_channels; ++c)
      half[c].fill([&](std::size_t i) { return half[c][i] * factors[c][i]; });
  return out;
}

// Each half is guided by the other half of `compared`, whose noise is independent of its own.
Halves regress_crosswise(const Halves& light, const Halves& compared, const std::array<FeaturePlanes, 2>& features,
                         const Shares& shares, int variance_radius, const RegressionSettings& settings) {
  Halves result = light;
  for (std::size_t h = 0; h < 2; ++h) {
    const ColorPlanes& other = compared[1 - h];
    Guide guide{other, variance_of_mean(compared, shares, variance_radius)};
    const float least = least_variance(other);
    guide.variance.fill([&](std::size_t i) { return guide.variance[i] / shares[1 - h] + least; });
    result[h] = regress(light[h], guide, features[h], settings);
  }
  return result;
}

// Both halves are guided by the mean of their first results.
Halves regress_again(const Halves& light, const Halves& before, const Shares& shares, const Surroundings& around,
                     const RegressionSettings& settings) {
  constexpr int variance_radius = 2;
  constexpr float unseen = 3e-5f;  // relative to the square of the light
  Guide guide{{}, variance_of_mean(before, shares, variance_radius)};
  for (std::size_t c = 0; c < color_channels; ++c) guide.color[c] = mean_of(before, c, shares);
  guide.variance.fill([&](std::size_t i) { return guide.variance[i] + unseen * around.scale.light2[i]; });
  return regress(light, guide, around.features, settings);
}

// Adds the results of `filter(level)` at the first level: alone, with low frequencies from the second level, from the
// second and third, and so on.
template <class Filter>
void add_pyramid(std::size_t levels, Filter&& filter, std::vector<Halves>& candidates) {
  std::vector<Halves> filtered;
  for (std::size_t level = 0; level < levels; ++level) filtered.push_back(filter(level));
  for (std::size_t deepest = 0; deepest < levels; ++deepest) {
    Halves sum = filtered[deepest];
    for (std::size_t level = deepest; level-- > 0;) sum = joined(filtered[level], sum);
    candidates.push_back(std::move(sum));
  }
}

// Estimated errors of the candidates around each pixel, by each half of their results.
std::vector<std::array<Plane, 2>> errors_of(const Halves& light, const std::vector<Halves>& candidates,
                                            const Shares& shares, const ErrorScale& scale) {
  constexpr int radius = 4;  // pixels
  std::vector<std::array<Plane, 2>> errors;
  errors.reserve(candidates.size());
  for (const Halves& candidate : candidates) {
    errors.push_back(squared_errors(light, candidate, shares, scale));
    for (Plane& error : errors.back()) error = box_filtered(box_filtered(error, radius), radius);
  }
  return errors;
}

struct Selection {
  std::size_t best = 0;  ///< the candidate with the least error around a pixel
  float optimism = 0;    ///< see DenoisedLayer
};

// The first candidate is the unfiltered light. It is left out where optimism is measured: where one half alone has a
// firefly, the other half alone would select it, though both halves together do not.
Selection select(const std::vector<std::array<Plane, 2>>& errors, const Shares& shares, std::size_t pixel) {
  const auto all = [&](std::size_t k) { return shares[0] * errors[k][0][pixel] + shares[1] * errors[k][1][pixel]; };
  Selection selected;
  std::array<std::size_t, 2> best_of{1, 1};  // by each half alone
  for (std::size_t k = 1; k < errors.size(); ++k) {
    if (all(k) < all(selected.best)) selected.best = k;
    for (std::size_t h = 0; h < 2; ++h)
      if (errors[k][h][pixel] < errors[best_of[h]][h][pixel]) best_of[h] = k;
  }
  if (selected.best != 0)
    selected.optimism =
        shares[0] * errors[best_of[1]][0][pixel] + shares[1] * errors[best_of[0]][1][pixel] - all(selected.best);
  return selected;
}

DenoisedLayer choose(const Halves& light, const std::vector<Halves>& candidates, const Shares& shares,
                     const ErrorScale& scale) {
  constexpr int border_radius = 2;  // pixels
  const std::vector<std::array<Plane, 2>> errors = errors_of(light, candidates, shares, scale);
  std::vector<Plane> parts(candidates.size(), Plane(scale.light2.width(), scale.light2.height()));
  DenoisedLayer result{light, parts[0]};
  result.optimism.fill([&](std::size_t i) {
    const Selection selected = select(errors, shares, i);
    parts[selected.best][i] = 1;
    return selected.optimism;
  });
  for (Plane& part : parts) part = box_filtered(part, border_radius);
  for (std::size_t h = 0; h < 2; ++h)
    for (std::size_t c = 0; c < color_channels; ++c)
      result.light[h][c].fill([&](std::size_t i) {
        float sum = 0;
        for (std::size_t k = 0; k < candidates.size(); ++k) sum += parts[k][i] * candidates[k][h][c][i];
        return sum;
      });
  return result;
}

std::vector<Halves> pyramid_of(const Halves& light, std::size_t levels) {
  std::vector<Halves> pyramid{light};
  while (pyramid.size() < levels) pyramid.push_back(halved(pyramid.back()));
  return pyramid;
}

Halves midpoint(const Halves& a, const Halves& b) {
  Halves out = a;
  for (std::size_t h = 0; h < 2; ++h)
    for (std::size_t c = 0; c < color_channels; ++c)
      out[h][c].fill([&](std::size_t i) { return (a[h][c][i] + b[h][c][i]) / 2; });
  return out;
}

// The best result of the first regressions.
Halves regress_once(const Halves& light, const Shares& shares, const std::vector<Surroundings>& levels,
                    const RegressionSettings& settings) {
  constexpr int variance_radius = 3;
  const std::vector<Halves> of_level = pyramid_of(light, levels.size());
  std::vector<Halves> candidates{light};
  add_pyramid(
      levels.size(),
      [&](std::size_t k) {
        return regress_crosswise(of_level[k], demodulated(of_level[k], levels[k].demodulation), levels[k].features,
                                 shares, variance_radius, settings);
      },
      candidates);
  return choose(light, candidates, shares, levels[0].scale).light;
}

}  // namespace

Plane mean_of(const Halves& light, std::size_t channel, const Shares& shares) {
  const Plane &a = light[0][channel], &b = light[1][channel];
  return Plane::of(a.width(), a.height(), [&](std::size_t i) { return shares[0] * a[i] + shares[1] * b[i]; });
}

std::array<Plane, 2> squared_errors(const Halves& light, const Halves& result, const Shares& shares,
                                    const ErrorScale& scale) {
  const float wa = shares[0], wb = shares[1];
  const auto seen = [&](const Plane& plane, std::size_t i) { return std::min(plane[i], scale.white); };
  Plane of_a(scale.light2.width(), scale.light2.height()), of_b = of_a;
  of_a.for_each_row([&](int y) {
    const auto w = static_cast<std::size_t>(of_a.width());
    for (std::size_t i = static_cast<std::size_t>(y) * w, end = i + w; i < end; ++i) {
      float sum_a = 0, sum_b = 0;
      for (std::size_t c = 0; c < color_channels; ++c) {
        const float a = seen(light[0][c], i), b = seen(light[1][c], i), da = seen(result[0][c], i),
                    db = seen(result[1][c], i);
        const float noise = sqr(a - b);  // weighted by wa it is the variance of b, by wb that of a
        const float averaged = wa * wb * sqr(da - db);
        sum_a += sqr(da - b) - wa * noise - averaged;
        sum_b += sqr(db - a) - wb * noise - averaged;
      }
      const float share = 1 / (static_cast<float>(color_channels) * scale.light2[i]);
      of_a[i] = sum_a * share;
      of_b[i] = sum_b * share;
    }
  });
  return {std::move(of_a), std::move(of_b)};
}

Plane squared_error(const Halves& light, const Halves& result, const Shares& shares, const ErrorScale& scale) {
  std::array<Plane, 2> errors = squared_errors(light, result, shares, scale);
  errors[0].fill([&](std::size_t i) { return shares[0] * errors[0][i] + shares[1] * errors[1][i]; });
  return std::move(errors[0]);
}

Surroundings halved(const Surroundings& surroundings) {
  Surroundings out{
      .features = {}, .demodulation = {}, .scale = {halved(surroundings.scale.light2), surroundings.scale.white}};
  for (std::size_t c = 0; c < color_channels; ++c) out.demodulation[c] = halved(surroundings.demodulation[c]);
  for (std::size_t h = 0; h < 2; ++h) {
    for (const Plane& plane : surroundings.features[h].values) out.features[h].values.push_back(halved(plane));
    for (const Plane& plane : surroundings.features[h].variances) out.features[h].variances.push_back(halved(plane));
  }
  return out;
}

void add_noisy_features(const Halves& halves, const Shares& shares, std::array<FeaturePlanes, 2>& features) {
  constexpr int variance_radius = 1;
  for (std::size_t h = 0; h < 2; ++h)
    for (std::size_t c = 0; c < color_channels; ++c) {
      features[h].values.push_back(halves[h][c]);
      Plane variance = box_filtered(variance_of_mean(halves, c, shares), variance_radius);
      variance.fill([&](std::size_t i) { return variance[i] / shares[h]; });
      features[h].variances.push_back(std::move(variance));
    }
}

void add_features(const Halves& halves, const Shares& shares, std::array<FeaturePlanes, 2>& features) {
  constexpr RegressionSettings settings{.window = 5, .patch = 1, .stride = 4, .strength = 0.7f};
  constexpr int variance_radius = 1;
  if (!is_noisy(halves)) return add_noisy_features(halves, shares, features);
  const Halves smooth =
      choose(halves, {halves, regress_crosswise(halves, halves, {}, shares, variance_radius, settings)}, shares,
             {.light2 = Plane(halves[0][0].width(), halves[0][0].height(), 1)})
          .light;
  add_noisy_features(smooth, shares, features);
}

Halves preview_layer(const Halves& light, const Shares& shares, const std::vector<Surroundings>& levels) {
  constexpr RegressionSettings settings{.window = 3, .patch = 1, .stride = 2, .strength = 0.7f};
  return is_noisy(light) ? regress_once(light, shares, levels, settings) : light;
}

DenoisedLayer denoise_layer(const Halves& light, const Shares& shares, const std::vector<Surroundings>& levels) {
  constexpr RegressionSettings crosswise{.window = 7, .patch = 3, .stride = 4, .strength = 0.5f},
      again{.window = 7, .patch = 1, .stride = 2, .strength = 1};
  if (!is_noisy(light)) return {light, Plane(light[0][0].width(), light[0][0].height())};
  const std::vector<Halves> of_level = pyramid_of(light, levels.size()),
                            before = pyramid_of(regress_once(light, shares, levels, crosswise), levels.size());
  std::vector<Halves> candidates{light, before[0]};
  add_pyramid(
      levels.size(), [&](std::size_t k) { return regress_again(of_level[k], before[k], shares, levels[k], again); },
      candidates);
  candidates.push_back(midpoint(before[0], candidates.back()));  // their errors differ
  return choose(light, candidates, shares, levels[0].scale);
}

}  // namespace lanthorn::denoising
