// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Turns a scene and the user's options into something that `render` can run. The user's options come first, then the
// scene file's settings, then defaults. Also declares the pass loop (`render`, render.cpp) and the record of a plan
// (identity.cpp).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "camera/view.h"
#include "integrators/integrator.h"
#include "lanthorn/render_options.h"
#include "lanthorn/render_record.h"
#include "lanthorn/scene_description.h"
#include "lanthorn/session.h"
#include "lanthorn/statistics.h"
#include "render/state.h"
#include "scene/scene.h"

namespace lanthorn {

/// Everything that `render` needs besides the scene.
struct RenderPlan {
  View view;
  const IntegratorInfo* info;
  Parameters parameters;  ///< of the integrator
  std::unique_ptr<Integrator> integrator = info->make(parameters);
  bool is_prepared = false;  ///< the integrator knows scene and view
  RenderSettings settings{};
  std::size_t passes_that_fit = 1;  ///< into memory, at once
  StopRule stop{};
  RenderState state{};  ///< empty film, no passes, record filled in
  /// Plans the same render with `share` times the width and height, for a stand-in (`StandIn`).
  std::function<RenderPlan(const Scene& scene, double share)> coarse{};
  std::string resumed_from{};  ///< the file of the state, for messages

  RenderJob job(const Scene& scene) const { return {scene, view, settings}; }
  /// Replaces the integrator, which may hold the state of half a pass after a pass was given up.
  void renew_integrator() {
    integrator = info->make(parameters);
    is_prepared = false;
  }
};

/// Throws Error unless the number is a bound of a picture's error, in (0, 1].
void check_error_bound(double bound);

/// Resolves options against scene and view. Throws Error for unknown integrators or parameters, values out of range,
/// and a shutter that is not the scene's although something moves.
RenderPlan plan_render(const Scene& scene, const ViewDescription& view, const RenderOptions& options);

/// `RenderState::record` of this render before its preparation.
RenderRecord record_of(const Scene& scene, const ViewDescription& view, const RenderOptions& options,
                       const RenderPlan& plan);

/// The options for a pass of a `scaled` picture. `photons`: light paths of a pass of the whole picture.
RenderOptions coarse_options(RenderOptions options, const description::Film& film, double share, double photons);

/// Renders the passes of `stop.passes` that the plan's state has not done yet, in order, into that state. Prepares the
/// integrator first if it is not prepared. If the first pass is given up, the state has no passes.
RenderStatistics render(const Scene& scene, RenderPlan& plan, const StopRule& stop, const Observer& observer = {});

}  // namespace lanthorn
