// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "film/error_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "film/plane.h"
#include "lanthorn/text.h"

namespace lanthorn {

namespace {

constexpr int window_radius = 3;       // pixels; windows are squares
constexpr double dark = 0.01;          // times the squared mean, in the denominator of relative errors
constexpr double confidence_z = 1.28;  // 90th percentile of the normal distribution

// A plane whose numbers take part in sums as doubles.
class Numbers : public Plane {
 public:
  using Plane::Plane;
  Numbers(Plane plane) : Plane(std::move(plane)) {}
  template <class Value>
  static Numbers of(int width, int height, Value&& value) {
    return Plane::of(width, height, value);
  }
  static Numbers of(const Image& image, std::size_t channel) {
    const std::size_t stride = image.channel_count();
    return Plane::of(image.width, image.height, [&](std::size_t i) { return image.pixels[i * stride + channel]; });
  }

  double operator[](std::size_t i) const { return static_cast<double>(Plane::operator[](i)); }
  void set(std::size_t i, double value) { Plane::operator[](i) = static_cast<float>(value); }
  void add(std::size_t i, double value) { set(i, (*this)[i] + value); }

  /// The sum of `value(i)` over all pixels, in an order that does not depend on threads.
  template <class Value>
  double sum(Value&& value) const {
    std::vector<double> rows(static_cast<std::size_t>(height()));
    for_each_row(
        [&](int y) { for_each_in_row(y, [&](std::size_t i) { rows[static_cast<std::size_t>(y)] += value(i); }); });
    return std::accumulate(rows.begin(), rows.end(), 0.0);
  }
  template <class Value>
  double mean(Value&& value) const {
    return sum(value) / static_cast<double>(size());
  }

  /// The middle rows, at most `rows` of them.
  Numbers middle(int rows) const {
    const int count = std::min(rows, height());
    const float* const first = row((height() - count) / 2);
    return Plane::of(width(), count, [&](std::size_t i) { return first[i]; });
  }
  /// Means over windows around each pixel.
  Numbers smoothed(int radius = window_radius) const { return box_filtered(*this, radius); }
  /// Means over squares of (window_radius + 1)² pixels that start at each pixel; at the right and lower border they
  /// start earlier.
  Numbers corners() const {
    const int extent = window_radius + 1, across = std::min(extent, width()), down = std::min(extent, height());
    Plane rows(width(), height()), out(width(), height());
    for_each_row([&](int y) {
      for (int x = 0; x < width(); ++x) {
        const float* first = row(y) + std::min(x, width() - across);
        for (int k = 0; k < across; ++k) rows.row(y)[x] += first[k];
      }
    });
    const float share = 1 / static_cast<float>(across * down);
    for_each_row([&](int y) {
      const int first = std::min(y, height() - down);
      for (int k = first; k < first + down; ++k)
        for (int x = 0; x < width(); ++x) out.row(y)[x] += share * rows.row(k)[x];
    });
    return out;
  }
};

constexpr double square(double x) { return x * x; }

// Mean and variance of the noise around each pixel: over its window or, at an edge, over its most uniform corner
// (Kuwahara's filter). A pixel is at an edge if the means of both differ by more than noise would make them.
struct Surroundings {
  Numbers mean, variance;
  std::vector<std::uint8_t> is_edge;

  Surroundings(const Numbers& light, const Numbers& noise)
      : mean(light.smoothed()), variance(noise.smoothed()), is_edge(light.size()) {
    const Numbers means = light.corners(), noises = noise.corners();
    const Numbers squares =
        Numbers::of(light.width(), light.height(), [&](std::size_t i) { return square(light[i]); }).corners();
    const auto spread = [&](std::size_t corner) { return std::max(0.0, squares[corner] - square(means[corner])); };
    constexpr double corner_pixels = square(window_radius + 1), significant = square(3);
    light.for_each_row([&](int y) {
      const int up = std::max(0, y - window_radius);
      for (int x = 0; x < light.width(); ++x) {
        const int left = std::max(0, x - window_radius);
        const std::size_t i = light.index(x, y);
        const std::array corners{i, light.index(left, y), light.index(x, up), light.index(left, up)};
        const std::size_t corner = *std::ranges::min_element(corners, {}, spread);
        if (square(means[corner] - mean[i]) <= significant * variance[i] / corner_pixels) continue;
        is_edge[i] = 1;
        mean.set(i, means[corner]);
        variance.set(i, noises[corner]);
      }
    });
  }
};

// Factor by which correlation between pixels increases the variance of a sum of squares of this plane: normal variables
// with correlation ρ have squares with correlation ρ². Assumes the same correlation along rows and columns.
double correlation_factor(const Numbers& all_noise) {
  constexpr int farthest = 24, enough = 1 << 16;  // pixels
  const Numbers noise = all_noise.middle(std::max(1, enough / all_noise.width()));
  const double all = noise.mean([&](std::size_t i) { return square(noise[i]); });
  if (!(all > 0)) return 1;
  const auto sum_along = [&](std::size_t extent, std::size_t step, auto&& position) {
    double sum = 1;
    for (std::size_t lag = 1; lag < std::min<std::size_t>(farthest, extent / 2); ++lag) {
      const double product =
          noise.sum([&](std::size_t i) { return position(i) + lag < extent ? noise[i] * noise[i + lag * step] : 0.0; });
      const double pairs =
          static_cast<double>(noise.size()) * static_cast<double>(extent - lag) / static_cast<double>(extent);
      // The square of an estimated correlation is biased upwards by the variance of the estimate.
      sum += 2 * std::max(0.0, square(product / (pairs * all)) - 1 / pairs);
    }
    return sum;
  };
  const auto width = static_cast<std::size_t>(noise.width()), height = static_cast<std::size_t>(noise.height());
  return sum_along(width, 1, [&](std::size_t i) { return i % width; }) *
         sum_along(height, width, [&](std::size_t i) { return i / width; });
}

// Sums over channels, per pixel.
struct PictureSums {
  Numbers noise, bias;  // relative variance and squared bias, at most 1
  double spikes = 0, light = 0;
  double correlation = 1;

  PictureSums(int width, int height) : noise(width, height), bias(width, height) {}
};

class ErrorMeasurement {
 public:
  explicit ErrorMeasurement(const PictureHalves& pictures)
      : pictures_(pictures), sums_(pictures.picture.width, pictures.picture.height) {
    result_.standard_error = result_.bias =
        Image(pictures.picture.width, pictures.picture.height, pictures.picture.channels);
    const auto n1 = static_cast<double>(pictures.passes[0]), n2 = static_cast<double>(pictures.passes[1]);
    share_ = n1 * n2 / square(n1 + n2);
    weights_ = {n1 / (n1 + n2), n2 / (n1 + n2)};
    double sum = 0;
    for (std::size_t c = 0; c < channels; ++c) {
      const Numbers light = Numbers::of(pictures.picture, c);
      sum += light.mean([&](std::size_t i) { return light[i]; });
    }
    dark2_ = dark * square(sum / static_cast<double>(channels));
  }

  MeasuredError measure() {
    for (std::size_t c = 0; c < channels; ++c) add_channel(c);
    estimate();
    return std::move(result_);
  }

 private:
  static constexpr std::size_t channels = 3;

  Numbers make(auto&& value) const { return Numbers::of(pictures_.picture.width, pictures_.picture.height, value); }

  // A square relative to the true value, regularised by the picture's mean; at most 1.
  double over(double squared, double truth) const {
    const double scale = square(truth) + dark2_;
    return scale > 0 ? std::min(1.0, squared / scale) : 0.0;
  }

  // A pixel's own estimate of the true value. A bright path in one half makes the pixel too bright, and the halves
  // differ by as much, so that the difference would look small relative to the pixel. Where one half has more than
  // twice the other's light, the median of the halves and the surroundings excludes such a path.
  static double own_truth(double light, double first, double second, double around) {
    const auto [least, most] = std::minmax(first, second);
    return most > 2 * least ? std::clamp(around, least, most) : light;
  }

  void add_channel(std::size_t c) {
    const Numbers light = Numbers::of(pictures_.picture, c);
    const Numbers first = Numbers::of(pictures_.halves[0].color, c), second = Numbers::of(pictures_.halves[1].color, c);
    const Numbers variance = make([&](std::size_t i) { return share_ * square(first[i] - second[i]); });
    const Surroundings around(light, variance);
    // Deviations common to both halves are structure with its own noise; deviations of a single half are noise.
    constexpr int near = 1;  // pixels
    const auto off = [&](const Numbers& half, std::size_t i) { return half[i] - around.mean[i]; };
    const Numbers both = make([&](std::size_t i) { return off(first, i) * off(second, i); }).smoothed(near);
    const Numbers all = make([&](std::size_t i) { return square(off(light, i)); }).smoothed(near);
    const Numbers structure =
        make([&](std::size_t i) { return all[i] > 0 ? std::clamp(both[i] / all[i], 0.0, 1.0) : 0.0; });
    const auto mixed = [&](const Numbers& wide, const Numbers& own) {
      return make([&](std::size_t i) { return wide[i] + structure[i] * (own[i] - wide[i]); });
    };
    const Numbers nearby = variance.smoothed(near);
    const Numbers local = make([&](std::size_t i) { return around.is_edge[i] ? around.variance[i] : nearby[i]; });
    const Numbers own = make([&](std::size_t i) { return own_truth(light[i], first[i], second[i], around.mean[i]); });
    const Numbers truth = mixed(around.mean, own), noise = mixed(local, variance);
    add_noise(light, variance, truth, around);
    if (!pictures_.halves[0].bias.pixels.empty()) add_bias(c, truth);
    const Numbers difference = make([&](std::size_t i) {
      return around.variance[i] > 0 ? (first[i] - second[i]) / std::sqrt(around.variance[i]) : 0.0;
    });
    sums_.correlation = std::max(sums_.correlation, correlation_factor(difference));
    for (std::size_t i = 0; i < noise.size(); ++i)
      result_.standard_error.pixels[i * channels + c] = static_cast<float>(std::sqrt(noise[i]));
  }

  // Uses the squares of single pixels: the limit of 1 then truncates them as it truncates the errors.
  void add_noise(const Numbers& light, const Numbers& variance, const Numbers& truth, const Surroundings& around) {
    const Numbers off = make([&](std::size_t i) { return square(light[i] - around.mean[i]); });
    const Numbers spread = off.smoothed();
    const Numbers distance = make([&](std::size_t i) { return over(off[i], around.mean[i]); }).smoothed();
    // Clamping each value to 1 removes much of the window's spread, if the spread is noise.
    const auto is_spiky = [&](std::size_t i) {
      return !around.is_edge[i] && spread[i] < 2 * around.variance[i] &&
             distance[i] < 0.5 * spread[i] / (square(around.mean[i]) + dark2_);
    };
    sums_.noise.for_each_pixel([&](std::size_t i) {
      sums_.noise.add(i, (is_spiky(i) ? distance[i] : over(variance[i], truth[i])) / channels);
    });
    sums_.spikes +=
        light.sum([&](std::size_t i) { return is_spiky(i) ? std::max(0.0, light[i] - around.mean[i]) : 0.0; });
    sums_.light += light.sum([&](std::size_t i) { return std::max(0.0, light[i]); });
  }

  void add_bias(std::size_t c, const Numbers& truth) {
    const Numbers first = Numbers::of(pictures_.halves[0].bias, c), second = Numbers::of(pictures_.halves[1].bias, c);
    const Numbers smooth =
        make([&](std::size_t i) { return weights_[0] * first[i] + weights_[1] * second[i]; }).smoothed();
    const Numbers product = make([&](std::size_t i) { return first[i] * second[i]; }).smoothed();
    sums_.bias.for_each_pixel([&](std::size_t i) {
      sums_.bias.add(i, std::copysign(over(std::fabs(product[i]), truth[i]), product[i]) / channels);
      result_.bias.pixels[i * channels + c] = static_cast<float>(smooth[i]);
    });
  }

  void estimate() {
    const auto pixels = static_cast<double>(sums_.noise.size());
    const auto mean_of = [](const Numbers& p) { return p.mean([&](std::size_t i) { return p[i]; }); };
    const auto squares_of = [](const Numbers& p) { return p.sum([&](std::size_t i) { return square(p[i]); }); };
    const double noise2 = mean_of(sums_.noise), bias2 = std::max(0.0, mean_of(sums_.bias));
    // For a normal variable, the variance of its square is two thirds of the mean fourth power. The picture's own error
    // varies as much as the estimate of its mean.
    const double square_sum = squares_of(sums_.noise);
    const double of_noise = std::sqrt(2 * sums_.correlation * square_sum * 2 / 3) / pixels;
    const double of_bias = std::sqrt(sums_.correlation * squares_of(sums_.bias)) / pixels;
    constexpr double of_method = 2 * 0.02;  // measured with bench/error, for `path` where caustics cause its noise
    ErrorEstimate& e = result_.estimate;
    if (!(sums_.light > 0)) {
      e = error_of_black_picture();
      e.is_black = has_enough_passes();
      return;
    }
    e.noise = std::sqrt(noise2);
    e.bias = std::sqrt(bias2);
    e.error = std::sqrt(noise2 + bias2);
    e.bound = std::sqrt(noise2 + bias2 + confidence_z * std::hypot(of_noise, of_bias, of_method * noise2));
    e.doubt = doubt_of(square_sum > 0 ? 3 * square(pixels * noise2) / (sums_.correlation * square_sum) : pixels);
  }

  bool has_enough_passes() const {
    constexpr std::uint64_t fewest = 2;  // in each half
    return std::min(pictures_.passes[0], pictures_.passes[1]) >= fewest;
  }

  // `independent`: number of independent squares from which the noise is estimated.
  std::string doubt_of(double independent) const {
    constexpr double fewest_squares = 20;
    const ErrorEstimate& e = result_.estimate;
    if (!has_enough_passes()) return "there are too few passes";
    if (independent < fewest_squares) return "a few spots make all the noise";
    const double spikes = sums_.spikes / sums_.light;
    if (spikes > e.bound)
      return fmt::format("{:.1f} % of the light is in single bright pixels (clamping limits them)", 100 * spikes);
    return {};
  }

  const PictureHalves& pictures_;
  double share_ = 0, dark2_ = 0;
  std::array<double, 2> weights_{};
  PictureSums sums_;
  MeasuredError result_;
};

}  // namespace

std::string describe_error(const ErrorEstimate& estimate) {
  if (!estimate.is_known()) return fmt::format("not known: {}", estimate.doubt);
  return estimate.bound > 0 ? fmt::format("below {} %", short_number(100 * estimate.bound)) : "0 %";
}

ErrorEstimate error_of_black_picture() { return {1, 0, 1, 1, "the picture is black", true}; }

double growth_to_reach(const ErrorEstimate& estimate, double limit) {
  const double margin = estimate.error > 0 ? square(estimate.bound / estimate.error) : 1;
  const auto square_after = [&](double growth) {
    return margin * (square(estimate.noise) / growth + square(estimate.bias) / std::pow(growth, 2.0 / 3));
  };
  constexpr double most = 1e12, precision = 1e-3;
  double low = 1, high = 2;
  if (square_after(low) <= square(limit)) return 1;
  while (high < most && square_after(high) > square(limit)) high *= 2;
  low = high / 2;
  while (high > (1 + precision) * low) {
    const double middle = std::sqrt(low * high);
    (square_after(middle) > square(limit) ? low : high) = middle;
  }
  return high;
}

MeasuredError measure_error(const PictureHalves& pictures) {
  if (pictures.passes[0] == 0 || pictures.passes[1] == 0) {
    MeasuredError unknown;
    ErrorEstimate& e = unknown.estimate;
    e.noise = e.error = e.bound = 1;
    e.doubt = "there are too few passes";
    unknown.standard_error = unknown.bias =
        Image(pictures.picture.width, pictures.picture.height, pictures.picture.channels);
    return unknown;
  }
  return ErrorMeasurement(pictures).measure();
}

Image smoothed_bias(const Image& bias) {
  Image out = bias;
  const std::size_t channels = bias.channel_count();
  for (std::size_t c = 0; c < channels; ++c) {
    const Numbers smooth = Numbers::of(bias, c).smoothed();
    for (std::size_t i = 0; i < smooth.size(); ++i) out.pixels[i * channels + c] = static_cast<float>(smooth[i]);
  }
  return out;
}

}  // namespace lanthorn
