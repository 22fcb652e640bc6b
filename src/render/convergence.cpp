// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/convergence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lanthorn/error.h"
#include "render/picture.h"
#include "render/plan.h"
#include "scene/scene.h"

namespace lanthorn {

namespace {

// Sums over the renders of each value after one number of passes.
struct Moments {
  std::uint64_t passes = 0;
  std::vector<double> sum, squares;
  double squared_error = 0;  // against the reference, over all values and renders

  void add(const Image& image, const std::optional<Image>& reference) {
    sum.resize(image.pixels.size());
    squares.resize(image.pixels.size());
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const auto value = static_cast<double>(image.pixels[i]);
      sum[i] += value;
      squares[i] += value * value;
      if (reference) squared_error += std::pow(value - static_cast<double>(reference->pixels[i]), 2);
    }
  }
  ConvergencePoint point(std::uint64_t runs, const std::optional<Image>& reference) const {
    const auto n = static_cast<double>(runs), values = static_cast<double>(sum.size());
    double variance = 0, bias2 = 0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const double mean = sum[i] / n;
      variance += (squares[i] / n - mean * mean) * n / (n - 1);
      if (reference) bias2 += std::pow(mean - static_cast<double>(reference->pixels[i]), 2);
    }
    ConvergencePoint point{passes, std::sqrt(std::max(0.0, variance / values)), {}, {}};
    if (!reference) return point;
    // The mean of the renders, which stands for the reference, is noisy itself.
    point.bias = std::sqrt(std::max(0.0, (bias2 - variance / n) / values));
    point.error = std::sqrt(squared_error / (n * values));
    return point;
  }
};

// Exponent of `value` against the number of passes; none from fewer than two points.
template <class Value>
std::optional<double> slope(const std::vector<ConvergencePoint>& points, std::uint64_t from, Value&& value) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const ConvergencePoint& point : points) {
    const double v = value(point);
    if (point.passes < from || !(v > 0)) continue;
    const double log_passes = std::log(static_cast<double>(point.passes)), log_value = std::log(v);
    n += 1;
    x += log_passes;
    y += log_value;
    xx += log_passes * log_passes;
    xy += log_passes * log_value;
  }
  if (n < 2) return std::nullopt;
  return (n * xy - x * y) / (n * xx - x * x);
}

// The pictures of one render after 1, 2, 4, ... passes; nothing if it was given up.
std::optional<std::vector<Image>> render_run(const Scene& scene, const ViewDescription& view,
                                             const RenderOptions& options, const ConvergenceSettings& settings,
                                             std::uint64_t runs, const std::optional<Image>& reference) {
  RenderPlan plan = plan_render(scene, view, options);
  const PixelWindow& window = plan.view.window;
  if (reference && (reference->width != window.width() || reference->height != window.height()))
    throw Error(fmt::format("the reference is {} x {} pixels, but the picture is {} x {}", reference->width,
                            reference->height, window.width(), window.height()));
  plan.stop.drop = settings.stop;
  plan.stop.undo = Undo::never;
  plan.coarse = nullptr;  // whole passes are measured
  std::vector<Image> images;
  Observer observer;
  observer.progress = [&](const RenderState& state, const RenderStatistics&) {
    settings.progress(runs, state.pass_count());
  };
  const PassRange asked = plan.stop.passes;
  for (std::uint64_t passes = 1; plan.state.pass_count() < asked.end - asked.begin; passes *= 2) {
    plan.stop.passes.end = std::min(asked.end, asked.begin + passes);
    render(scene, plan, plan.stop, observer);
    if (settings.stop && settings.stop->load() && !plan.state.has_pass(plan.stop.passes.end - 1)) return {};
    if (plan.state.pass_count() == passes)
      images.push_back(plan.state.film.resolve_color(passes, colour_balance(plan.state)));
  }
  return images;
}

}  // namespace

Convergence measure_convergence(const Scene& scene, const ViewDescription& view, const RenderOptions& options,
                                const ConvergenceSettings& settings, const std::optional<Image>& reference) {
  if (settings.runs < 2) throw Error("--runs: expected 2 or more; a single render does not show its noise");
  std::vector<Moments> moments;
  Convergence result;
  while (result.runs < settings.runs) {
    RenderOptions own = options;
    own.seed = options.seed.value_or(0) + result.runs;
    const auto images = render_run(scene, view, own, settings, result.runs, reference);
    if (!images) break;
    moments.resize(images->size());
    for (std::size_t i = 0; i < images->size(); ++i) {
      moments[i].passes = std::uint64_t{1} << i;
      moments[i].add((*images)[i], reference);
    }
    ++result.runs;
  }
  if (result.runs < 2) return result;
  for (const Moments& m : moments) result.points.push_back(m.point(result.runs, reference));
  result.variance_slope =
      slope(result.points, settings.fit_from, [](const ConvergencePoint& p) { return p.deviation * p.deviation; });
  if (reference)
    result.bias_slope = slope(result.points, settings.fit_from, [](const ConvergencePoint& p) { return *p.bias; });
  return result;
}

}  // namespace lanthorn
