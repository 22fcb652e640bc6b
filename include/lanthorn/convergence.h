// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// How fast a method's picture converges: its noise and its systematic error against the number of passes, from many
// renders that differ in their seeds alone (Knaus & Zwicker 2011, figs. 2 and 4).
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "lanthorn/image.h"
#include "lanthorn/render_options.h"
#include "lanthorn/scene.h"

namespace lanthorn {

/// Of the means over so many passes; all in the picture's unit, root mean squares over pixels and channels.
struct ConvergencePoint {
  std::uint64_t passes = 0;
  double deviation = 0;         ///< standard deviation of a pixel over the renders
  std::optional<double> bias;   ///< mean of the renders less the reference; 0 where noise hides it
  std::optional<double> error;  ///< of one render against the reference
};

struct Convergence {
  std::uint64_t runs = 0;                ///< complete renders; with fewer than 2 there are no points
  std::vector<ConvergencePoint> points;  ///< at 1, 2, 4, ... passes
  /// Exponents of the number of passes: least squares in log-log over the points from `fit_from` passes on.
  std::optional<double> variance_slope, bias_slope;
};

struct ConvergenceSettings {
  std::uint64_t runs = 50;      ///< at least 2; their seeds count up from the options'
  std::uint64_t fit_from = 16;  ///< passes
  /// Called after each pass: renders that are complete, and passes of the running one.
  std::function<void(std::uint64_t runs, std::uint64_t passes)> progress = [](std::uint64_t, std::uint64_t) {};
  /// Once it is set (by any thread or signal handler), the running render is given up at once, and what the complete
  /// ones say is returned.
  const std::atomic<bool>* stop = nullptr;
};

/// Renders `options.passes` passes `runs` times. `reference`, if given, has channels R, G, B and the renders' size.
/// Throws Error for what `Session` refuses, a reference of another size, and fewer than 2 runs.
Convergence measure_convergence(const Scene& scene, const ViewDescription& view, const RenderOptions& options,
                                const ConvergenceSettings& settings, const std::optional<Image>& reference);

}  // namespace lanthorn
