// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Independent renders and t-tests of them. The noise of a single render is unknown; the spread of several measures it,
// so that the limit is right for any noise.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "lanthorn/metrics.h"
#include "support/render_scene.h"
#include "support/statistics.h"

namespace lanthorn::test {

/// Renders with consecutive seeds from seed(first), all layers.
inline std::vector<Image> independent_renders(const Scene& scene, RenderOptions options, std::uint64_t runs,
                                              std::uint64_t first) {
  std::vector<Image> images;
  for (std::uint64_t run = 0; run < runs; ++run) {
    options.seed = seed(first + run);
    images.push_back(render_image(scene, options));
  }
  return images;
}

inline std::vector<Image> select_layers(const std::vector<Image>& images, const std::string& layer) {
  std::vector<Image> selected;
  for (const Image& image : images) selected.push_back(*select_layer(image, layer));
  return selected;
}

/// Mean over pixels and channels.
inline double mean_of(const Image& image) {
  const double sum = std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0);
  return sum / static_cast<double>(image.pixels.size());
}

/// Mean of the pictures' means.
inline Mean mean_of_means(const std::vector<Image>& images) {
  Mean mean;
  for (const Image& image : images) mean.add(mean_of(image));
  return mean;
}

/// For two sets of renders with equal seeds, and therefore equal photons, pair by pair: 1 + difference of a pair's
/// means divided by the mean of all of `expected`. Noise that both share cancels.
inline Mean paired_ratio(const std::vector<Image>& found, const std::vector<Image>& expected) {
  const double mean = mean_of_means(expected).mean();
  Mean ratio;
  for (std::size_t run = 0; run < found.size(); ++run)
    ratio.add(1 + (mean_of(found[run]) - mean_of(expected[run])) / mean);
  return ratio;
}

/// The value that |t| of Student's distribution exceeds at this rate: for 1e-6 and 7, 15 or 30 degrees of freedom 13.2,
/// 7.5, 6.1.
inline double t_limit(double rate, double degrees) {
  double low = 0, high = 1e5;
  for (int i = 0; i < 80; ++i) {
    const double t = 0.5 * (low + high);
    (student_t_p_value(t, degrees) > rate ? low : high) = t;
  }
  return high;
}

/// t-test: the mean of at least two numbers is within `slack` of `expected` (relative) plus what their spread allows at
/// this rate. This allowance must not exceed `noise` (relative), so that the test is meaningful. Of n runs, the
/// measured spread is more than twice the true one with probability 1e-6 for n = 12, 1e-8 for n = 16: `noise` is at
/// least three times the mean allowance.
inline ::testing::AssertionResult runs_agree(const Mean& mean, double expected, double slack, double noise,
                                             double rate = false_alarm_rate) {
  const double allowed = t_limit(rate, mean.count() - 1) * mean.error();
  note_share_of_noise(allowed / (noise * std::fabs(expected)));
  if (!(allowed <= noise * std::fabs(expected)))
    return ::testing::AssertionFailure() << "too noisy to tell: " << mean.mean() << " +- " << mean.error();
  return within(mean.mean(), expected, slack * std::fabs(expected) + allowed) << ", standard error " << mean.error();
}

/// Welch's t-test of two means, likewise.
inline ::testing::AssertionResult runs_agree(const Mean& a, const Mean& b, double slack, double noise,
                                             double rate = false_alarm_rate) {
  const double va = a.squared_error(), vb = b.squared_error(), error = std::sqrt(va + vb);
  const double degrees = (va + vb) * (va + vb) / (va * va / (a.count() - 1) + vb * vb / (b.count() - 1));
  const double allowed = error > 0 ? t_limit(rate, degrees) * error : 0;
  note_share_of_noise(allowed / (noise * std::fabs(b.mean())));
  if (!(allowed <= noise * std::fabs(b.mean())))
    return ::testing::AssertionFailure() << "too noisy to tell: " << a.mean() << " +- " << a.error() << ", " << b.mean()
                                         << " +- " << b.error();
  return within(a.mean(), b.mean(), slack * std::fabs(b.mean()) + allowed) << ", standard error " << error;
}

/// Welch's t-test of each tile of two sets of renders, with this false-alarm rate for all tiles together.
inline ::testing::AssertionResult tiles_agree(const std::vector<Image>& a, const std::vector<Image>& b,
                                              double rate = false_alarm_rate) {
  const Comparison result = welch_tile_test(a, b);
  return not_below(result.p, rate) << ", tile (" << result.tile_x << ", " << result.tile_y << "), channel "
                                   << result.channel;
}

}  // namespace lanthorn::test
