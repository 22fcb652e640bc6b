// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "denoise/layer.h"

#include <cmath>
#include <utility>

#include "math/lanes.h"

namespace lanthorn::denoising {

namespace {

constexpr int tile_size = 32;
constexpr std::size_t size(int count) { return static_cast<std::size_t>(count); }
constexpr std::size_t group = 3;        // features that share a scale
constexpr std::size_t most_terms = 10;  // the constant and the features
constexpr std::size_t columns = 2 * Lanes::width;
constexpr int span = static_cast<int>(columns);  // weights in a row of a neighbourhood; unused ones are 0
static_assert(most_terms + color_channels <= columns);

// The constant, the features and the light at a pixel.
using Observation = std::array<float, columns>;

// A plane with a mirrored border.
class PaddedPlane {
 public:
  PaddedPlane() = default;
  PaddedPlane(const Plane& plane, int border)
      : border_(border), plane_(plane.width() + 2 * border, plane.height() + 2 * border) {
    const auto inside = [](int i, int count) {
      const int period = 2 * count, at = ((i % period) + period) % period;
      return at < count ? at : period - 1 - at;
    };
    const int width = plane.width(), right = border + width;
    plane_.for_each_row([&](int y) {
      const float* from = plane.row(inside(y - border, plane.height()));
      float* to = plane_.row(y);
      for (int x = 0; x < border; ++x) to[x] = from[inside(x - border, width)];
      std::copy_n(from, width, to + border);
      for (int x = right; x < plane_.width(); ++x) to[x] = from[inside(x - border, width)];
    });
  }
  const float* at(int x, int y) const { return plane_.row(y + border_) + x + border_; }
  float* at(int x, int y) { return plane_.row(y + border_) + x + border_; }

 private:
  int border_ = 0;
  Plane plane_;
};

// Weighted sums of products of observations, relative to the centre's features.
struct Moments {
  std::array<std::array<float, columns>, most_terms> sums;
};

struct LanePair {
  Lanes low{0}, high{0};

  static LanePair load(const float* from) {
    std::array<float, Lanes::width> low, high;
    std::copy_n(from, Lanes::width, low.begin());
    std::copy_n(from + Lanes::width, Lanes::width, high.begin());
    return {Lanes(low), Lanes(high)};
  }
  void store(float* to) const {
    const std::array<float, Lanes::width> first = low.stored(), second = high.stored();
    std::copy(second.begin(), second.end(), std::copy(first.begin(), first.end(), to));
  }
  friend LanePair operator+(const LanePair& a, const LanePair& b) { return {a.low + b.low, a.high + b.high}; }
  friend LanePair operator-(const LanePair& a, const LanePair& b) { return {a.low - b.low, a.high - b.high}; }
  friend LanePair operator*(const LanePair& a, const LanePair& b) { return {a.low * b.low, a.high * b.high}; }
};
LanePair all_lanes(float x) { return {Lanes(x), Lanes(x)}; }

using Coefficients = std::array<std::array<float, color_channels>, most_terms>;

// Calls `body(x, y)` for the corners of all tiles. Tiles that run at the same time are so far apart that their
// neighbourhoods do not overlap: a pixel's sums are accumulated in the same order for any number of threads.
template <class Body>
void for_each_tile(int width, int height, Body&& body) {
  const int across = (width + tile_size - 1) / tile_size, down = (height + tile_size - 1) / tile_size;
  for (const auto& [first_x, first_y] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
    std::vector<std::pair<int, int>> tiles;
    for (int y = first_y; y < down; y += 2)
      for (int x = first_x; x < across; x += 2) tiles.emplace_back(x * tile_size, y * tile_size);
    parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t i) { body(tiles[i].first, tiles[i].second); });
  }
}

// exp(-y) for y >= 0, to a tenth of its value up to 7, and 0 from 256 on: (1 - y / 256)^256.
Lanes falling(const Lanes& y) {
  Lanes x = max(Lanes(0.0f), Lanes(1.0f) - y * (1.0f / 256));
  for (int i = 0; i < 8; ++i) x = x * x;
  return x;
}

// The weights of the neighbourhoods of a tile's centres.
class Weights {
 public:
  Weights(const Guide& guide, const RegressionSettings& settings)
      : settings_(settings),
        width_(guide.variance.width()),
        height_(guide.variance.height()),
        side_(2 * settings.window + 1),
        points_(tile_size / settings.stride),
        variance_(guide.variance, border()) {
    for (const Plane& plane : guide.color) color_.emplace_back(plane, border());
  }

  /// Centres in a row of a tile.
  int points() const { return points_; }
  /// Of the tile at (x0, y0), in the order of `index_of`.
  std::vector<float> of_tile(int x0, int y0) const {
    std::vector<float> weights(index_of(0, points_));
    for (int dy = -settings_.window; dy <= settings_.window; ++dy)
      for (int dx = -settings_.window; dx <= settings_.window; ++dx) weigh_shift(x0, y0, dx, dy, weights);
    return weights;
  }
  /// Index of the weights of a centre's neighbourhood, row by row.
  std::size_t index_of(int column, int row) const {
    return (size(row) * size(points_) + size(column)) * size(side_) * size(span);
  }

 private:
  static constexpr int most_points = tile_size / 2;

  // Covers the patches of all centres that a tile may have, inside the picture or not.
  int border() const { return settings_.window + settings_.patch + tile_size; }

  // Squared differences between pixels and those at offset (dx, dy), divided by their variance.
  void compare(int x, int y, int dx, int dy, int count, float* out) const {
    std::array<const float*, color_channels> a, b;
    for (std::size_t c = 0; c < color_channels; ++c) a[c] = color_[c].at(x, y), b[c] = color_[c].at(x + dx, y + dy);
    const float *va = variance_.at(x, y), *vb = variance_.at(x + dx, y + dy);
    for (int i = 0; i < count; ++i) {
      float sum = 0;
      for (std::size_t c = 0; c < color_channels; ++c) sum += sqr(a[c][i] - b[c][i]);
      out[i] = sum / (va[i] + vb[i]);
    }
  }

  // The weights that a tile's centres give to the pixels at offset (dx, dy).
  void weigh_shift(int x0, int y0, int dx, int dy, std::vector<float>& weights) const {
    const int patch = 2 * settings_.patch + 1, extent = settings_.stride * (points_ - 1) + patch;
    constexpr int most = tile_size + 8;
    std::array<float, most * most> differences;
    for (int j = 0; j < extent; ++j)
      compare(x0 - settings_.patch, y0 + j - settings_.patch, dx, dy, extent, &differences[size(j) * size(most)]);
    std::array<float, most> sums;
    for (int row = 0; row < points_; ++row) {
      const int y = y0 + settings_.stride * row + dy;
      if (y < 0 || y >= height_) continue;
      sums.fill(0);
      for (int k = 0; k < patch; ++k) {
        const float* in = &differences[size(settings_.stride * row + k) * size(most)];
        for (int i = 0; i < extent; ++i) sums[size(i)] += in[i];
      }
      const std::array<float, most_points> of_row = weights_of_row(sums.data());
      float* const out =
          &weights[index_of(0, row) + size(dy + settings_.window) * size(span) + size(dx + settings_.window)];
      for (int column = 0; column < points_; ++column) {
        const int x = x0 + settings_.stride * column + dx;
        if (x >= 0 && x < width_) out[index_of(column, 0)] = of_row[size(column)];
      }
    }
  }

  // Of the centres in a row of a tile. `sums`: sums of differences over the height of a patch.
  std::array<float, most_points> weights_of_row(const float* sums) const {
    const int patch = 2 * settings_.patch + 1;
    const float mean = 1 / static_cast<float>(patch * patch);
    const float scale = 1 / (settings_.strength * settings_.strength);
    std::array<float, most_points> weights{};
    for (int column = 0; column < points_; ++column)
      for (int k = 0; k < patch; ++k) weights[size(column)] += sums[settings_.stride * column + k];
    static_assert(columns == most_points);
    const LanePair all = LanePair::load(weights.data());
    const auto weigh = [&](const Lanes& sum) { return falling(max(Lanes(0.0f), sum * mean - 1.0f) * scale); };
    LanePair{weigh(all.low), weigh(all.high)}.store(weights.data());
    return weights;
  }

  RegressionSettings settings_;
  int width_, height_, side_, points_;
  PaddedPlane variance_;
  std::vector<PaddedPlane> color_;
};

class Regression {
 public:
  Regression(const ColorPlanes& light, const FeaturePlanes& features, const RegressionSettings& settings)
      : light_(light),
        features_(features),
        settings_(settings),
        width_(light[0].width()),
        height_(light[0].height()),
        terms_(1 + features.values.size()),
        weight_sums_(Plane(width_, height_), span) {
    for (const Plane& plane : features.values) values_.emplace_back(plane, span);
    observations_.resize(light[0].size());
    light[0].for_each_row([&](int y) {
      for (int x = 0; x < width_; ++x) observe(index(x, y));
    });
    sums_.fill(weight_sums_);
  }

  // True if the result is 0 in all pixels that this tile contributes to, whatever it contributes: all fits that they
  // are predicted by see no light.
  bool is_dark_around(int x0, int y0) const {
    const int reach = 3 * settings_.window;
    const int left = std::max(0, x0 - reach), right = std::min(width_, x0 + tile_size + reach);
    for (int y = std::max(0, y0 - reach); y < std::min(height_, y0 + tile_size + reach); ++y)
      for (const Plane& plane : light_) {
        const float* const row = plane.row(y);
        if (std::any_of(row + left, row + right, [](float x) { return x != 0; })) return false;
      }
    return true;
  }

  void fit_tile(int x0, int y0, const Weights& order, const std::vector<float>& weights) {
    for (int row = 0; row < order.points(); ++row)
      for (int column = 0; column < order.points(); ++column) {
        const int x = x0 + settings_.stride * column, y = y0 + settings_.stride * row;
        if (x < width_ && y < height_) fit(x, y, &weights[order.index_of(column, row)]);
      }
  }

  ColorPlanes result() const {
    constexpr float own = 1e-2f;  // weight of a pixel's own light, for pixels that resemble no others
    ColorPlanes result = light_;
    for (std::size_t c = 0; c < color_channels; ++c)
      result[c].for_each_row([&](int y) {
        float* const light = result[c].row(y);
        const float *sums = sums_[c].at(0, y), *weights = weight_sums_.at(0, y);
        for (int x = 0; x < width_; ++x) light[x] = (sums[x] + own * light[x]) / (weights[x] + own);
      });
    return result;
  }

 private:
  std::size_t index(int x, int y) const { return size(y) * size(width_) + size(x); }

  void observe(std::size_t pixel) {
    Observation& v = observations_[pixel];
    v.fill(0);
    v[0] = 1;
    for (std::size_t f = 1; f < terms_; ++f) v[f] = features_.values[f - 1][pixel];
    for (std::size_t c = 0; c < color_channels; ++c) v[most_terms + c] = light_[c][pixel];
  }

  void fit(int x, int y, const float* weights) {
    const Moments moments = terms_ == 1 ? add_up<1>(x, y, weights) : add_up<most_terms>(x, y, weights);
    predict(x, y, weights, solve(moments, index(x, y)));
  }

  template <std::size_t terms>
  Moments add_up(int x, int y, const float* weights) const {
    constexpr float least_weight = 1e-3f;
    Observation origin = observations_[index(x, y)];
    origin[0] = 0;
    std::fill(origin.begin() + most_terms, origin.end(), 0.0f);
    const LanePair from = LanePair::load(origin.data());
    std::array<LanePair, terms> sums;
    for (int dy = std::max(-settings_.window, -y); dy <= std::min(settings_.window, height_ - 1 - y); ++dy) {
      const float* row = weights + (dy + settings_.window) * span + settings_.window;
      for (int dx = std::max(-settings_.window, -x); dx <= std::min(settings_.window, width_ - 1 - x); ++dx) {
        const float w = row[dx];
        if (w < least_weight) continue;
        const Observation& v = observations_[index(x + dx, y + dy)];
        const LanePair difference = LanePair::load(v.data()) - from;
        for (std::size_t t = 0; t < terms; ++t) sums[t] = sums[t] + all_lanes(w * (v[t] - origin[t])) * difference;
      }
    }
    Moments moments;
    for (std::size_t t = 0; t < terms; ++t) sums[t].store(moments.sums[t].data());
    return moments;
  }

  // Regularisation added to a feature's sum of squares: its noise, and a small part of its group's squares, so that
  // features that hardly vary, or vary together, are not over-trusted.
  std::array<double, most_terms> ridge_of(const Moments& moments, std::size_t center) const {
    constexpr double small = 1e-4, share_of_group = 1e-3, tiny = 1e-30;
    const auto all = static_cast<double>(moments.sums[0][0]);
    std::array<double, most_terms> ridge{};
    for (std::size_t first = 1; first < terms_; first += group) {
      double spread = 0;
      for (std::size_t f = first; f < first + group; ++f) spread += static_cast<double>(moments.sums[f][f]);
      // Positions have no scale of their own.
      const double least = first + group < terms_ ? small * all : share_of_group * spread;
      for (std::size_t f = first; f < first + group; ++f)
        ridge[f] = all * static_cast<double>(features_.variances[f - 1][center]) + least + tiny;
    }
    return ridge;
  }

  // Solves the normal equations by Cholesky factorisation; each term is scaled to a sum of squares of 1.
  Coefficients solve(const Moments& moments, std::size_t center) const {
    const std::array<double, most_terms> ridge = ridge_of(moments, center);
    std::array<double, most_terms> scale{};
    for (std::size_t t = 0; t < terms_; ++t)
      scale[t] = 1 / std::sqrt(static_cast<double>(moments.sums[t][t]) + ridge[t]);
    std::array<std::array<double, most_terms>, most_terms> m;
    for (std::size_t r = 0; r < terms_; ++r) {
      for (std::size_t k = 0; k < r; ++k) m[r][k] = static_cast<double>(moments.sums[r][k]) * scale[r] * scale[k];
      m[r][r] = 1;
    }
    constexpr double least = 1e-9;
    for (std::size_t k = 0; k < terms_; ++k) {
      for (std::size_t j = 0; j < k; ++j) m[k][k] -= m[k][j] * m[k][j];
      m[k][k] = std::sqrt(std::max(m[k][k], least));
      for (std::size_t r = k + 1; r < terms_; ++r) {
        for (std::size_t j = 0; j < k; ++j) m[r][k] -= m[r][j] * m[k][j];
        m[r][k] /= m[k][k];
      }
    }
    Coefficients coefficients{};
    for (std::size_t c = 0; c < color_channels; ++c) {
      std::array<double, most_terms> x{};
      for (std::size_t r = 0; r < terms_; ++r) {
        x[r] = static_cast<double>(moments.sums[r][most_terms + c]) * scale[r];
        for (std::size_t j = 0; j < r; ++j) x[r] -= m[r][j] * x[j];
        x[r] /= m[r][r];
      }
      for (std::size_t r = terms_; r-- > 0;) {
        for (std::size_t j = r + 1; j < terms_; ++j) x[r] -= m[j][r] * x[j];
        x[r] /= m[r][r];
        coefficients[r][c] = static_cast<float>(x[r] * scale[r]);
      }
    }
    return coefficients;
  }

  // Processes whole rows, with weights of 0 outside the picture.
  void predict(int x, int y, const float* weights, const Coefficients& coefficients) {
    const int left = x - settings_.window;
    const Observation& origin = observations_[index(x, y)];
    for (int dy = std::max(-settings_.window, -y); dy <= std::min(settings_.window, height_ - 1 - y); ++dy) {
      std::array<LanePair, color_channels> light;
      for (std::size_t c = 0; c < color_channels; ++c) light[c] = all_lanes(coefficients[0][c]);
      for (std::size_t t = 1; t < terms_; ++t) {
        const LanePair difference = LanePair::load(values_[t - 1].at(left, y + dy)) - all_lanes(origin[t]);
        for (std::size_t c = 0; c < color_channels; ++c)
          light[c] = light[c] + all_lanes(coefficients[t][c]) * difference;
      }
      const LanePair w = LanePair::load(weights + (dy + settings_.window) * span);
      const auto add = [&](PaddedPlane& plane, const LanePair& value) {
        float* const sums = plane.at(left, y + dy);
        (LanePair::load(sums) + value).store(sums);
      };
      add(weight_sums_, w);
      for (std::size_t c = 0; c < color_channels; ++c) add(sums_[c], w * light[c]);
    }
  }

  const ColorPlanes& light_;
  const FeaturePlanes& features_;
  RegressionSettings settings_;
  int width_, height_;
  std::size_t terms_;
  std::vector<PaddedPlane> values_;
  std::vector<Observation> observations_;
  PaddedPlane weight_sums_;
  std::array<PaddedPlane, color_channels> sums_;
};

}  // namespace

ColorPlanes regress(const ColorPlanes& light, const Guide& guide, const FeaturePlanes& features,
                    const RegressionSettings& settings) {
  const Weights weights(guide, settings);
  Regression regression(light, features, settings);
  for_each_tile(light[0].width(), light[0].height(), [&](int x, int y) {
    if (!regression.is_dark_around(x, y)) regression.fit_tile(x, y, weights, weights.of_tile(x, y));
  });
  return regression.result();
}

Halves regress(const Halves& light, const Guide& guide, const std::array<FeaturePlanes, 2>& features,
               const RegressionSettings& settings) {
  const Weights weights(guide, settings);
  std::array regressions{Regression(light[0], features[0], settings), Regression(light[1], features[1], settings)};
  for_each_tile(light[0][0].width(), light[0][0].height(), [&](int x, int y) {
    if (regressions[0].is_dark_around(x, y) && regressions[1].is_dark_around(x, y)) return;
    const std::vector<float> of_tile = weights.of_tile(x, y);
    for (Regression& regression : regressions) regression.fit_tile(x, y, weights, of_tile);
  });
  return {regressions[0].result(), regressions[1].result()};
}

}  // namespace lanthorn::denoising
