// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Pearson's chi-squared test of a sampler of directions against its pdf. The sphere is cut into cells that hold about
// equally many of some pilot samples, so that lobes of any width are resolved; the pdf is integrated over each cell by
// adaptive quadrature and compared with the counts of fresh samples.
//
//   DirectionSampler lambert{[](float, const Vec2& u) { return std::optional(sample_cosine_hemisphere(u)); },
//                            [](const Vec3& w) { return w.z > 0 ? pdf_cosine_hemisphere(w.z) : 0.0f; }};
//   EXPECT_TRUE(chi2_test(lambert));
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "math/hash.h"
#include "math/vec.h"
#include "support/statistics.h"

namespace lanthorn::test {

/// Interface of samplers: `sample(u1, u2)` returns an optional unit direction from three uniform numbers (empty: no
/// sample); `pdf(direction)` returns its density per solid angle, whose integral is the probability of a sample.
template <class Sample, class Pdf>
struct DirectionSampler {
  Sample sample;
  Pdf pdf;
};
template <class Sample, class Pdf>
DirectionSampler(Sample, Pdf) -> DirectionSampler<Sample, Pdf>;

struct Chi2Options {
  int samples = 100000;
  int cells_log2 = 8;                      ///< cells per sphere: 2^this
  double significance = false_alarm_rate;  ///< of all `tests` together
  int tests = 1;                           ///< how many tests share that rate (Šidák's correction)
  std::uint64_t seed = test::seed(1);
};

/// Probability that a chi-squared variable of `dof` >= 3 degrees of freedom is larger (Wilson & Hilferty 1931). In the
/// tails that tests use, about 1e-8, it is too large: by 6 % for 254 degrees of freedom, 60 % for 20, 4 times for 4.
inline double chi2_upper_tail(double statistic, int dof) {
  const double v = 2.0 / (9.0 * dof);
  const double z = (std::cbrt(statistic / dof) - (1 - v)) / std::sqrt(v);
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

namespace detail {

/// A direction as (theta, phi) in double precision: narrow lobes about the pole keep their shape.
using Angles = std::array<double, 2>;

inline Angles to_angles(const Vec3& w) {
  const double x = w.x;
  const double y = w.y;
  return {std::atan2(std::sqrt(x * x + y * y), static_cast<double>(w.z)), std::atan2(y, x)};
}
inline Vec3 to_direction(double theta, double phi) {
  return {static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::sin(theta) * std::sin(phi)),
          static_cast<float>(std::cos(theta))};
}

struct Cell {
  Angles min;
  Angles max;
  Angles pilot_min;  ///< bounds of the pilot samples, with a margin: what is narrow in a wide cell is there
  Angles pilot_max;
  double expected = 0;
  double observed = 0;
};

/// Integral of pdf over a rectangle of angles: 4x4 Gauss-Legendre points, halved both ways until that changes nothing.
template <class Pdf>
class Quadrature {
 public:
  explicit Quadrature(const Pdf& pdf) : pdf_(pdf) {}

  /// The part that contains the pilot samples, and the four strips around it.
  double integrate(const Cell& c) const {
    const Angles& a = c.pilot_min;
    const Angles& b = c.pilot_max;
    return panel(a, b) + panel(c.min, {a[0], c.max[1]}) + panel({b[0], c.min[1]}, c.max) +
           panel({a[0], c.min[1]}, {b[0], a[1]}) + panel({a[0], b[1]}, {b[0], c.max[1]});
  }

 private:
  double panel(const Angles& min, const Angles& max) const {
    if (min[0] >= max[0] || min[1] >= max[1]) return 0;
    // Large panels are always divided, so that their points do not all miss a feature.
    const double size = std::max(max[0] - min[0], max[1] - min[1]);
    return refine(min, max, once(min, max), 1e-6, size > 0.4 ? 2 : 0, 9);
  }

  double once(const Angles& min, const Angles& max) const {
    static constexpr std::array<double, 4> x{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                             0.8611363115940526};
    static constexpr std::array<double, 4> w{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                             0.3478548451374538};
    const double half_theta = 0.5 * (max[0] - min[0]);
    const double half_phi = 0.5 * (max[1] - min[1]);
    double sum = 0;
    for (unsigned i = 0; i < 4; ++i) {
      const double theta = min[0] + half_theta * (1 + x[i]);
      for (unsigned j = 0; j < 4; ++j) {
        const double phi = min[1] + half_phi * (1 + x[j]);
        sum += w[i] * w[j] * std::sin(theta) * static_cast<double>(pdf_(to_direction(theta, phi)));
      }
    }
    return sum * half_theta * half_phi;
  }

  double refine(const Angles& min, const Angles& max, double coarse, double tolerance, int forced, int depth) const {
    const Angles mid{0.5 * (min[0] + max[0]), 0.5 * (min[1] + max[1])};
    const std::array<std::pair<Angles, Angles>, 4> parts{
        {{min, mid}, {{mid[0], min[1]}, {max[0], mid[1]}}, {{min[0], mid[1]}, {mid[0], max[1]}}, {mid, max}}};
    std::array<double, 4> fine{};
    double sum = 0;
    for (unsigned i = 0; i < 4; ++i) sum += fine[i] = once(parts[i].first, parts[i].second);
    if (depth == 0 || (forced <= 0 && std::fabs(sum - coarse) < tolerance)) return sum;
    double refined = 0;
    for (unsigned i = 0; i < 4; ++i)
      refined += refine(parts[i].first, parts[i].second, fine[i], 0.5 * tolerance, forced - 1, depth - 1);
    return refined;
  }

  const Pdf& pdf_;
};

/// A binary tree of cuts over the sphere, and its leaves.
class Partition {
 public:
  /// Cuts at the medians of the pilot directions; the first cut is the horizon, where pdfs jump.
  Partition(std::vector<Angles> pilot, int levels) {
    const double p = 3.14159265358979323846;
    nodes_.push_back({0, 0.5 * p, 0, 0, 0});
    const auto middle = std::partition(pilot.begin(), pilot.end(), [&](const Angles& a) { return a[0] < 0.5 * p; });
    nodes_[0].below = build({pilot.begin(), middle}, {0, -p}, {0.5 * p, p}, levels - 1);
    nodes_[0].above = build({middle, pilot.end()}, {0.5 * p, -p}, {p, p}, levels - 1);
  }

  std::vector<Cell>& cells() { return cells_; }
  Cell& find(const Angles& a) {
    int n = 0;
    while (nodes_[static_cast<std::size_t>(n)].axis >= 0) {
      const Node& node = nodes_[static_cast<std::size_t>(n)];
      n = a[static_cast<std::size_t>(node.axis)] < node.at ? node.below : node.above;
    }
    return cells_[static_cast<std::size_t>(nodes_[static_cast<std::size_t>(n)].cell)];
  }

 private:
  struct Node {
    int axis;  ///< -1: a leaf
    double at;
    int below, above, cell;
  };

  int build(std::vector<Angles> pilot, const Angles& min, const Angles& max, int levels) {
    const int index = static_cast<int>(nodes_.size());
    if (levels == 0 || pilot.size() < 16) {
      nodes_.push_back({-1, 0, 0, 0, static_cast<int>(cells_.size())});
      cells_.push_back(leaf(pilot, min, max));
      return index;
    }
    const int axis = wider_axis(pilot);
    const auto a = static_cast<std::size_t>(axis);
    const auto middle = pilot.begin() + static_cast<std::ptrdiff_t>(pilot.size() / 2);
    std::nth_element(pilot.begin(), middle, pilot.end(), [a](const Angles& l, const Angles& r) { return l[a] < r[a]; });
    const double at = (*middle)[a];
    nodes_.push_back({axis, at, 0, 0, 0});
    Angles below_max = max;
    Angles above_min = min;
    below_max[a] = above_min[a] = at;
    const int below = build({pilot.begin(), middle}, min, below_max, levels - 1);
    const int above = build({middle, pilot.end()}, above_min, max, levels - 1);
    nodes_[static_cast<std::size_t>(index)].below = below;
    nodes_[static_cast<std::size_t>(index)].above = above;
    return index;
  }

  static Cell leaf(const std::vector<Angles>& pilot, const Angles& min, const Angles& max) {
    Cell c{min, max, max, min};
    for (unsigned i = 0; i < 2; ++i) {
      for (const Angles& a : pilot) {
        c.pilot_min[i] = std::min(c.pilot_min[i], a[i]);
        c.pilot_max[i] = std::max(c.pilot_max[i], a[i]);
      }
      const double margin = pilot.size() < 16 ? 2.0 : 0.3;
      const double extent = c.pilot_max[i] - c.pilot_min[i];
      c.pilot_min[i] = std::max(min[i], c.pilot_min[i] - margin * extent);
      c.pilot_max[i] = std::min(max[i], c.pilot_max[i] + margin * extent);
    }
    if (pilot.size() < 2) c.pilot_min = c.pilot_max = min;
    return c;
  }

  /// The axis along which the samples extend farther, as lengths on the sphere.
  static int wider_axis(const std::vector<Angles>& pilot) {
    double sum_sin = 0;
    std::array<double, 2> mean{};
    std::array<double, 2> square{};
    for (const Angles& a : pilot) {
      sum_sin += std::sin(a[0]);
      for (unsigned i = 0; i < 2; ++i) mean[i] += a[i], square[i] += a[i] * a[i];
    }
    const double n = static_cast<double>(pilot.size());
    const auto variance = [&](unsigned i) { return square[i] / n - (mean[i] / n) * (mean[i] / n); };
    const double scale = sum_sin / n;
    return variance(0) > variance(1) * scale * scale ? 0 : 1;
  }

  std::vector<Node> nodes_;
  std::vector<Cell> cells_;
};

/// The statistic over all cells. Cells that expect fewer than five counts are pooled.
inline ::testing::AssertionResult judge(const std::vector<Cell>& cells, const Chi2Options& options) {
  double statistic = 0;
  int terms = 0;
  double total = 0;
  Cell pool{};
  const auto add = [&](const Cell& c) {
    const double difference = c.observed - c.expected;
    statistic += difference * difference / c.expected;
    ++terms;
  };
  for (const Cell& c : cells) {
    total += c.expected;
    if (c.expected >= 5) {
      add(c);
    } else {
      pool.expected += c.expected;
      pool.observed += c.observed;
    }
  }
  if (pool.expected >= 5) {
    add(pool);
  } else if (pool.observed > 25) {  // Poisson's tail beyond it is below 1e-11
    return ::testing::AssertionFailure() << pool.observed << " samples where the pdf expects " << pool.expected;
  }
  if (terms < 4) return ::testing::AssertionFailure() << "only " << terms << " cells: nothing to test";
  const double p = chi2_upper_tail(statistic, terms - 1);
  const double limit = sidak(options.significance, options.tests);
  return not_below(p, limit) << ", chi2 = " << statistic << " with " << terms - 1
                             << " degrees of freedom, integral of the pdf " << total / options.samples;
}

}  // namespace detail

/// True if the samples follow the pdf. Failed draws form a cell of their own, whose expectation is 1 minus the integral
/// of the pdf.
template <class Sampler>
::testing::AssertionResult chi2_test(const Sampler& sampler, const Chi2Options& options = {}) {
  HashRng rng(options.seed);
  const auto draw = [&] {
    const float u1 = rng.next();
    return sampler.sample(u1, rng.next2());
  };
  std::vector<detail::Angles> pilot;
  for (int i = 0; i < 64 << options.cells_log2; ++i)
    if (const auto w = draw()) pilot.push_back(detail::to_angles(*w));
  detail::Partition partition(std::move(pilot), options.cells_log2);

  detail::Cell failed{};
  for (int i = 0; i < options.samples; ++i) {
    const auto w = draw();
    ++(w ? partition.find(detail::to_angles(*w)) : failed).observed;
  }
  const detail::Quadrature quadrature(sampler.pdf);
  double integral = 0;
  for (detail::Cell& c : partition.cells()) {
    const double mass = quadrature.integrate(c);
    integral += mass;
    c.expected = options.samples * mass;
  }
  if (integral > 1 + 2e-3) return ::testing::AssertionFailure() << "the pdf integrates to " << integral;
  failed.expected = options.samples * std::max(0.0, 1 - integral);
  std::vector<detail::Cell> cells = std::move(partition.cells());
  cells.push_back(failed);
  return detail::judge(cells, options);
}

}  // namespace lanthorn::test
