// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lanthorn/error.h"

namespace lanthorn {
namespace {

constexpr int tile_size = 8;
constexpr double max_z = 4;
constexpr double tolerated_difference = 0.03;  // for a tile, relative to the image's mean
constexpr double tolerated_outliers = 0.03;
constexpr double tolerated_mean_difference = 0.01;

void require_same_shape(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height)
    throw Error("cannot compare pictures of different sizes: " + std::to_string(a.width) + "x" +
                std::to_string(a.height) + " and " + std::to_string(b.width) + "x" + std::to_string(b.height));
  if (a.channel_count() != b.channel_count()) throw Error("cannot compare pictures with different numbers of channels");
}

/// Means of `f(pixel value)` over whole tiles: one value per tile channel, rows of tiles from the top.
template <class F>
std::vector<double> tile_means(const Image& image, F&& f) {
  const int columns = image.width / tile_size, rows = image.height / tile_size;
  const std::size_t channels = image.channel_count();
  std::vector<double> means(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) * channels);
  for (int y = 0; y < rows * tile_size; ++y)
    for (int x = 0; x < columns * tile_size; ++x)
      for (std::size_t c = 0; c < channels; ++c) {
        const auto tile = static_cast<std::size_t>(y / tile_size) * static_cast<std::size_t>(columns) +
                          static_cast<std::size_t>(x / tile_size);
        means[tile * channels + c] += f(static_cast<double>(image.at(x, y, c))) / (tile_size * tile_size);
      }
  return means;
}
std::vector<double> tile_means(const Image& image) {
  return tile_means(image, [](double x) { return x; });
}

struct TileStatistics {
  std::vector<double> mean;
  std::vector<double> squared_error;  ///< squared standard error of the mean: sample variance / number of runs
};

TileStatistics tile_statistics(std::span<const Image> runs) {
  const double count = static_cast<double>(runs.size());
  std::vector<std::vector<double>> tiles;
  for (const Image& run : runs) tiles.push_back(tile_means(run));
  TileStatistics result{std::vector<double>(tiles[0].size()), std::vector<double>(tiles[0].size())};
  for (std::size_t i = 0; i < tiles[0].size(); ++i) {
    for (const auto& run : tiles) result.mean[i] += run[i] / count;
    double squares = 0;
    for (const auto& run : tiles) squares += (run[i] - result.mean[i]) * (run[i] - result.mean[i]);
    result.squared_error[i] = squares / (count - 1) / count;
  }
  return result;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// Continued fraction of the incomplete beta function (DLMF 8.17.22), by Lentz's method as modified by Thompson &
/// Barnett (1986).
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = 1e-300;
  const auto away_from_zero = [](double v) { return std::fabs(v) < tiny ? tiny : v; };
  double c = 1, d = 1 / away_from_zero(1 - (a + b) * x / (a + 1)), result = d;
  for (int m = 1; m < 10000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double factor = 1;
    for (const double term : {even, odd}) {
      d = 1 / away_from_zero(1 + term * d);
      c = away_from_zero(1 + term / c);
      factor = c * d;
      result *= factor;
    }
    if (std::fabs(factor - 1) < 1e-15) break;
  }
  return result;
}

/// I_x(a, b), x in [0,1].
double regularized_beta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(a, b, x) / a;
  return 1 - front * beta_fraction(b, a, 1 - x) / b;
}

}  // namespace

double student_t_p_value(double t, double degrees) {
  return regularized_beta(degrees / 2, 0.5, degrees / (degrees + t * t));
}

ImageErrors image_errors(const Image& image, const Image& reference, const ErrorOptions& options) {
  require_same_shape(image, reference);
  ImageErrors errors;
  std::size_t count = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double a = static_cast<double>(image.pixels[i]), r = static_cast<double>(reference.pixels[i]);
    if (!std::isfinite(a) || !std::isfinite(r)) {
      ++errors.non_finite;
      continue;
    }
    const double square = (a - r) * (a - r), relative = square / (r * r + options.epsilon);
    ++count;
    errors.mse += square;
    errors.rel_mse += options.rel_clamp ? std::min(relative, *options.rel_clamp) : relative;
    errors.mean_image += a;
    errors.mean_reference += r;
    errors.max_difference = std::max(errors.max_difference, std::fabs(a - r));
  }
  if (count == 0) return errors;
  for (double* sum : {&errors.mse, &errors.rel_mse, &errors.mean_image, &errors.mean_reference})
    *sum /= static_cast<double>(count);
  if (errors.mean_reference != 0) errors.mean_ratio = errors.mean_image / errors.mean_reference;
  return errors;
}

Agreement agreement_with_reference(const Image& reference, const Image& sem, std::span<const Image> runs) {
  if (runs.size() < 2) throw Error("the z-test needs at least two independent renders");
  require_same_shape(reference, sem);
  for (const Image& run : runs) require_same_shape(reference, run);
  const std::vector<double> r = tile_means(reference);
  if (r.empty()) throw Error("the z-test needs pictures of at least 8x8 pixels");
  const std::vector<double> squared_sem = tile_means(sem, [](double s) { return s * s; });
  const TileStatistics run = tile_statistics(runs);

  // Standard errors from few runs are unreliable: each is clamped to at least half their median.
  std::vector<double> run_error(r.size());
  std::transform(run.squared_error.begin(), run.squared_error.end(), run_error.begin(),
                 [](double s) { return std::sqrt(s); });
  const double least_error = 0.5 * median(run_error);

  const double reference_mean = mean(r), tiles = static_cast<double>(r.size());
  double outliers = 0, difference = 0, squared_error = 0, rel_mse = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double d = run.mean[i] - r[i], e = std::max(run_error[i], least_error);
    const double squared = squared_sem[i] / (tile_size * tile_size) + e * e + 1e-12;
    if (std::fabs(d) > max_z * std::sqrt(squared) && std::fabs(d) > tolerated_difference * reference_mean) ++outliers;
    difference += d / tiles;
    squared_error += squared;
    rel_mse += d * d / (r[i] * r[i] + 0.01 * reference_mean * reference_mean) / tiles;
  }
  Agreement result{.agrees = false,
                   .mean_difference = difference / reference_mean,
                   .mean_error = std::sqrt(squared_error) / tiles / reference_mean,
                   .outliers = outliers / tiles,
                   .rel_mse = rel_mse};
  const double off = std::fabs(result.mean_difference);
  result.agrees =
      result.outliers <= tolerated_outliers && (off <= tolerated_mean_difference || off <= max_z * result.mean_error);
  return result;
}

Comparison welch_tile_test(std::span<const Image> a, std::span<const Image> b) {
  if (a.size() < 2 || b.size() < 2) throw Error("Welch's test needs at least two independent renders on each side");
  for (const std::span<const Image> side : {a, b})
    for (const Image& image : side) require_same_shape(a[0], image);
  const TileStatistics one = tile_statistics(a), other = tile_statistics(b);
  Comparison result{.tests = one.mean.size()};
  if (one.mean.empty()) throw Error("Welch's test needs pictures of at least 8x8 pixels");
  const auto columns = static_cast<std::size_t>(a[0].width / tile_size);
  for (std::size_t i = 0; i < one.mean.size(); ++i) {
    const double va = one.squared_error[i], vb = other.squared_error[i], d = one.mean[i] - other.mean[i];
    if (d == 0) continue;
    // Welch & Satterthwaite's degrees of freedom.
    const double degrees = (va + vb) * (va + vb) /
                           (va * va / static_cast<double>(a.size() - 1) + vb * vb / static_cast<double>(b.size() - 1));
    const double p = va + vb > 0 ? student_t_p_value(d / std::sqrt(va + vb), degrees) : 0.0;
    if (!(p >= result.smallest_p)) {  // NaN counts as a difference
      result.smallest_p = std::isnan(p) ? 0 : p;
      const std::size_t tile = i / a[0].channel_count();
      result.tile_x = static_cast<int>(tile % columns);
      result.tile_y = static_cast<int>(tile / columns);
      result.channel = i % a[0].channel_count();
    }
  }
  // 1 - (1 - p)^n, computed without cancellation.
  result.p =
      result.smallest_p < 1 ? -std::expm1(static_cast<double>(result.tests) * std::log1p(-result.smallest_p)) : 1;
  return result;
}

}  // namespace lanthorn
