// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Measures how a method converges: noise and bias as functions of the number of passes, from many renders that differ
// only in their seeds (Knaus & Zwicker 2011, figs. 2 and 4).
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

/// Errors of the picture after `passes` passes, in the picture's unit: root mean squares over pixels and channels.
struct ConvergencePoint {
  std::uint64_t passes = 0;
  double deviation = 0;         ///< standard deviation of a pixel between renders
  std::optional<double> bias;   ///< mean of all renders minus the reference; 0 if noise hides it
  std::optional<double> error;  ///< of a single render against the reference
};

struct Convergence {
  std::uint64_t runs = 0;                ///< complete renders; `points` is empty if there are fewer than 2
  std::vector<ConvergencePoint> points;  ///< at 1, 2, 4, ... passes
  /// Exponent p of the power law passes^p, fitted by least squares in log-log to the points from `fit_from` passes on.
  std::optional<double> variance_slope, bias_slope;
};

struct ConvergenceSettings {
  std::uint64_t runs = 50;      ///< at least 2; render i uses the options' seed + i
  std::uint64_t fit_from = 16;  ///< passes
  /// Called after each pass with the number of complete renders and of passes in the current one.
  std::function<void(std::uint64_t runs, std::uint64_t passes)> progress = [](std::uint64_t, std::uint64_t) {};
  /// Once any thread or signal handler sets it, the current render is abandoned and the result covers the complete
  /// renders only.
  const std::atomic<bool>* stop = nullptr;
};

/// Renders `options.passes` passes `runs` times. The optional `reference` has channels R, G, B and the size of the
/// renders. Throws Error if `Session` rejects the options, if the reference has another size, or if there are fewer
/// than 2 runs.
Convergence measure_convergence(const Scene& scene, const ViewDescription& view, const RenderOptions& options,
                                const ConvergenceSettings& settings, const std::optional<Image>& reference);

}  // namespace lanthorn
