// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "film/error_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/parallel.h"
#include "lanthorn/number_text.h"

namespace lanthorn {

namespace {

constexpr std::size_t window_radius = 3;  // pixels; windows are squares
constexpr std::size_t rows_per_task = 16;
constexpr double dark = 0.01;          // times the squared mean, in the denominator of relative errors
constexpr double confidence_z = 1.28;  // 90th percentile of the normal distribution

// A number for each pixel.
class PixelPlane {
 public:
  PixelPlane(std::size_t width, std::size_t height) : width_(width), height_(height), values_(width * height) {}
  template <class Value>
  static PixelPlane of(std::size_t width, std::size_t height, Value&& value) {
    PixelPlane plane(width, height);
    plane.for_each_row([&](std::size_t y) {
      for (std::size_t i = y * width; i < (y + 1) * width; ++i) plane.set(i, value(i));
    });
    return plane;
  }
  static PixelPlane of(const Image& image, std::size_t channel) {
    const std::size_t stride = image.channel_count();
    return of(static_cast<std::size_t>(image.width), static_cast<std::size_t>(image.height),
              [&](std::size_t i) { return static_cast<double>(image.pixels[i * stride + channel]); });
  }

  double operator[](std::size_t i) const { return static_cast<double>(values_[i]); }
  void set(std::size_t i, double value) { values_[i] = static_cast<float>(value); }
  void add(std::size_t i, double value) { set(i, (*this)[i] + value); }
  std::size_t width() const { return width_; }
  std::size_t height() const { return height_; }
  std::size_t size() const { return values_.size(); }

  template <class Body>
  void for_each_row(Body&& body) const {
    parallel_chunks(height_, rows_per_task, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) body(y);
    });
  }
  /// The sum of `value(i)` over all pixels, in an order that does not depend on threads.
  template <class Value>
  double sum(Value&& value) const {
    std::vector<double> rows(height_);
    for_each_row([&](std::size_t y) {
      for (std::size_t i = y * width_; i < (y + 1) * width_; ++i) rows[y] += value(i);
    });
    double all = 0;
    for (const double row : rows) all += row;
    return all;
  }
  template <class Value>
  double mean(Value&& value) const {
    return sum(value) / static_cast<double>(size());
  }

  /// The middle rows, at most `rows` of them.
  PixelPlane middle(std::size_t rows) const {
    const std::size_t count = std::min(rows, height_), first = (height_ - count) / 2 * width_;
    return of(width_, count, [&](std::size_t i) { return (*this)[first + i]; });
  }

  /// Means over squares of (2 radius + 1)² pixels around each pixel, clipped to the picture.
  PixelPlane smoothed(std::size_t radius = window_radius) const { return along_rows(radius).along_columns(radius); }

  /// Means over squares of (window_radius + 1)² pixels that start at each pixel; at the right and lower border they
  /// start earlier.
  PixelPlane corners() const {
    constexpr std::size_t extent = window_radius + 1;
    const std::size_t across = std::min(extent, width_), down = std::min(extent, height_);
    PixelPlane rows(width_, height_), out(width_, height_);
    for_each_row([&](std::size_t y) {
      for (std::size_t x = 0; x < width_; ++x) {
        const float* first = &values_[y * width_ + std::min(x, width_ - across)];
        for (std::size_t k = 0; k < across; ++k) rows.values_[y * width_ + x] += first[k];
      }
    });
    const float share = 1 / static_cast<float>(across * down);
    for_each_row([&](std::size_t y) {
      const std::size_t first = std::min(y, height_ - down);
      for (std::size_t row = first; row < first + down; ++row)
        for (std::size_t x = 0; x < width_; ++x) out.values_[y * width_ + x] += share * rows.values_[row * width_ + x];
    });
    return out;
  }
  /// Among the four such squares with this pixel in a corner, the one with the least `value`.
  template <class Value>
  std::size_t choose_corner(std::size_t x, std::size_t y, Value&& value) const {
    const std::size_t left = x - std::min(x, window_radius), up = y - std::min(y, window_radius);
    std::size_t best = y * width_ + x;
    for (const std::size_t other : {y * width_ + left, up * width_ + x, up * width_ + left})
      if (value(other) < value(best)) best = other;
    return best;
  }

 private:
  // The positions around `at` that are in the picture.
  struct Span {
    std::size_t begin, end;
    Span(std::size_t at, std::size_t radius, std::size_t extent)
        : begin(at - std::min(at, radius)), end(std::min(at + radius + 1, extent)) {}
    float share() const { return 1 / static_cast<float>(end - begin); }
  };
  PixelPlane along_rows(std::size_t radius) const {
    PixelPlane out(width_, height_);
    for_each_row([&](std::size_t y) {
      const float* in = &values_[y * width_];
      float* sums = &out.values_[y * width_];
      const std::size_t reach = std::min(radius, width_ - 1);
      std::copy_n(in, width_, sums);
      for (std::size_t step = 1; step <= reach; ++step) {
        for (std::size_t x = 0; x + step < width_; ++x) sums[x] += in[x + step];
        for (std::size_t x = step; x < width_; ++x) sums[x] += in[x - step];
      }
      for (std::size_t x = 0; x < width_; ++x) sums[x] *= Span(x, radius, width_).share();
    });
    return out;
  }
  PixelPlane along_columns(std::size_t radius) const {
    PixelPlane out(width_, height_);
    for_each_row([&](std::size_t y) {
      float* sums = &out.values_[y * width_];
      const Span rows(y, radius, height_);
      for (std::size_t row = rows.begin; row < rows.end; ++row)
        for (std::size_t x = 0; x < width_; ++x) sums[x] += values_[row * width_ + x];
      for (std::size_t x = 0; x < width_; ++x) sums[x] *= rows.share();
    });
    return out;
  }

  std::size_t width_, height_;
  std::vector<float> values_;
};

constexpr double square(double x) { return x * x; }

// Mean and variance of the noise around each pixel: over its window or, if the window contains an edge, over its most
// uniform corner (Kuwahara's filter). In pure noise, corners differ little from the window.
struct Surroundings {
  PixelPlane mean, variance;
  std::vector<std::uint8_t> is_edge;

  Surroundings(const PixelPlane& light, const PixelPlane& noise)
      : mean(light.smoothed()), variance(noise.smoothed()), is_edge(light.size()) {
    const PixelPlane means = light.corners(), noises = noise.corners();
    const PixelPlane squares =
        PixelPlane::of(light.width(), light.height(), [&](std::size_t i) { return square(light[i]); }).corners();
    light.for_each_row([&](std::size_t y) {
      for (std::size_t x = 0; x < light.width(); ++x) {
        const std::size_t i = y * light.width() + x;
        const std::size_t corner =
            light.choose_corner(x, y, [&](std::size_t k) { return std::max(0.0, squares[k] - square(means[k])); });
        constexpr double corner_pixels = square(window_radius + 1), significant = square(3);
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
double correlation_factor(const PixelPlane& all_noise) {
  constexpr std::size_t farthest = 24, enough = 1 << 16;  // pixels
  const PixelPlane noise = all_noise.middle(std::max<std::size_t>(1, enough / all_noise.width()));
  const double all = noise.mean([&](std::size_t i) { return square(noise[i]); });
  if (!(all > 0)) return 1;
  const auto sum_along = [&](std::size_t extent, std::size_t step, auto&& position) {
    double sum = 1;
    for (std::size_t lag = 1; lag < std::min(farthest, extent / 2); ++lag) {
      const double product =
          noise.sum([&](std::size_t i) { return position(i) + lag < extent ? noise[i] * noise[i + lag * step] : 0.0; });
      const double pairs =
          static_cast<double>(noise.size()) * static_cast<double>(extent - lag) / static_cast<double>(extent);
      // The square of an estimated correlation is biased upwards by the variance of the estimate.
      sum += 2 * std::max(0.0, square(product / (pairs * all)) - 1 / pairs);
    }
    return sum;
  };
  const std::size_t width = noise.width();
  return sum_along(width, 1, [&](std::size_t i) { return i % width; }) *
         sum_along(noise.height(), width, [&](std::size_t i) { return i / width; });
}

// Sums over channels, per pixel.
struct PictureSums {
  PixelPlane noise, bias;  // relative variance and squared bias, at most 1
  double spikes = 0, light = 0;
  double correlation = 1;

  PictureSums(std::size_t width, std::size_t height) : noise(width, height), bias(width, height) {}
};

class ErrorMeasurement {
 public:
  explicit ErrorMeasurement(const PictureHalves& pictures)
      : pictures_(pictures),
        width_(static_cast<std::size_t>(pictures.picture.width)),
        height_(static_cast<std::size_t>(pictures.picture.height)),
        sums_(width_, height_) {
    result_.standard_error = result_.bias =
        Image(pictures.picture.width, pictures.picture.height, pictures.picture.channels);
    const auto n1 = static_cast<double>(pictures.passes[0]), n2 = static_cast<double>(pictures.passes[1]);
    share_ = n1 * n2 / square(n1 + n2);
    weights_ = {n1 / (n1 + n2), n2 / (n1 + n2)};
    double sum = 0;
    for (std::size_t c = 0; c < channels; ++c) {
      const PixelPlane light = PixelPlane::of(pictures.picture, c);
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

  PixelPlane make(auto&& value) const { return PixelPlane::of(width_, height_, value); }

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
    const PixelPlane light = PixelPlane::of(pictures_.picture, c);
    const PixelPlane first = PixelPlane::of(pictures_.halves[0].color, c),
                     second = PixelPlane::of(pictures_.halves[1].color, c);
    const PixelPlane variance = make([&](std::size_t i) { return share_ * square(first[i] - second[i]); });
    const Surroundings around(light, variance);
    // Deviations common to both halves are structure with its own noise; deviations of a single half are noise.
    constexpr std::size_t near = 1;  // pixels
    const auto off = [&](const PixelPlane& half, std::size_t i) { return half[i] - around.mean[i]; };
    const PixelPlane both = make([&](std::size_t i) { return off(first, i) * off(second, i); }).smoothed(near);
    const PixelPlane all = make([&](std::size_t i) { return square(off(light, i)); }).smoothed(near);
    const PixelPlane structure =
        make([&](std::size_t i) { return all[i] > 0 ? std::clamp(both[i] / all[i], 0.0, 1.0) : 0.0; });
    const auto mixed = [&](const PixelPlane& wide, const PixelPlane& own) {
      return make([&](std::size_t i) { return wide[i] + structure[i] * (own[i] - wide[i]); });
    };
    const PixelPlane nearby = variance.smoothed(near);
    const PixelPlane local = make([&](std::size_t i) { return around.is_edge[i] ? around.variance[i] : nearby[i]; });
    const PixelPlane own =
        make([&](std::size_t i) { return own_truth(light[i], first[i], second[i], around.mean[i]); });
    const PixelPlane truth = mixed(around.mean, own), noise = mixed(local, variance);
    add_noise(light, variance, truth, around);
    if (!pictures_.halves[0].bias.pixels.empty()) add_bias(c, truth);
    const PixelPlane difference = make([&](std::size_t i) {
      return around.variance[i] > 0 ? (first[i] - second[i]) / std::sqrt(around.variance[i]) : 0.0;
    });
    sums_.correlation = std::max(sums_.correlation, correlation_factor(difference));
    for (std::size_t i = 0; i < noise.size(); ++i)
      result_.standard_error.pixels[i * channels + c] = static_cast<float>(std::sqrt(noise[i]));
  }

  // Uses the squares of single pixels: the limit of 1 then truncates them as it truncates the errors.
  void add_noise(const PixelPlane& light, const PixelPlane& variance, const PixelPlane& truth,
                 const Surroundings& around) {
    const PixelPlane off = make([&](std::size_t i) { return square(light[i] - around.mean[i]); });
    const PixelPlane spread = off.smoothed();
    const PixelPlane distance = make([&](std::size_t i) { return over(off[i], around.mean[i]); }).smoothed();
    // Clamping each value to 1 removes much of the window's spread, if the spread is noise.
    const auto is_spiky = [&](std::size_t i) {
      return !around.is_edge[i] && spread[i] < 2 * around.variance[i] &&
             distance[i] < 0.5 * spread[i] / (square(around.mean[i]) + dark2_);
    };
    sums_.noise.for_each_row([&](std::size_t y) {
      for (std::size_t i = y * width_; i < (y + 1) * width_; ++i)
        sums_.noise.add(i, (is_spiky(i) ? distance[i] : over(variance[i], truth[i])) / channels);
    });
    sums_.spikes +=
        light.sum([&](std::size_t i) { return is_spiky(i) ? std::max(0.0, light[i] - around.mean[i]) : 0.0; });
    sums_.light += light.sum([&](std::size_t i) { return std::max(0.0, light[i]); });
  }

  void add_bias(std::size_t c, const PixelPlane& truth) {
    const PixelPlane first = PixelPlane::of(pictures_.halves[0].bias, c),
                     second = PixelPlane::of(pictures_.halves[1].bias, c);
    const PixelPlane smooth =
        make([&](std::size_t i) { return weights_[0] * first[i] + weights_[1] * second[i]; }).smoothed();
    const PixelPlane product = make([&](std::size_t i) { return first[i] * second[i]; }).smoothed();
    sums_.bias.for_each_row([&](std::size_t y) {
      for (std::size_t i = y * width_; i < (y + 1) * width_; ++i) {
        sums_.bias.add(i, std::copysign(over(std::fabs(product[i]), truth[i]), product[i]) / channels);
        result_.bias.pixels[i * channels + c] = static_cast<float>(smooth[i]);
      }
    });
  }

  void estimate() {
    const auto pixels = static_cast<double>(sums_.noise.size());
    const auto mean_of = [](const PixelPlane& p) { return p.mean([&](std::size_t i) { return p[i]; }); };
    const auto squares_of = [](const PixelPlane& p) { return p.sum([&](std::size_t i) { return square(p[i]); }); };
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
  std::size_t width_, height_;
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
    const PixelPlane smooth = PixelPlane::of(bias, c).smoothed();
    for (std::size_t i = 0; i < smooth.size(); ++i) out.pixels[i * channels + c] = static_cast<float>(smooth[i]);
  }
  return out;
}

}  // namespace lanthorn
