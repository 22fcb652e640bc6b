// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// From a scene and a user's wishes to something that `render` can run: the scene file's own choices where the user has
// none, defaults where neither has.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "description/scene_description.h"
#include "integrators/integrator.h"
#include "render/render.h"
#include "render/state.h"
#include "scene/scene.h"

namespace lanthorn {

/// What the user asked for; whatever is empty is taken from the scene file or has a default.
struct RenderOptions : ViewOptions {
  std::optional<std::string> integrator;
  std::optional<std::uint64_t> passes;
  std::optional<double> seconds;
  std::optional<PassRange> pass_range;  ///< for shards; excludes `passes`
  std::optional<std::uint64_t> seed;
  std::optional<ColorMode> color;
  std::optional<std::uint64_t> photons;  ///< light paths per pass
  std::optional<int> max_depth;
  std::optional<std::uint64_t> memory;     ///< bytes, see `plan_memory`
  std::map<std::string, std::string> set;  ///< the integrator's parameters
};

/// Everything that `render` needs but the scene.
struct Session {
  View view;
  const IntegratorInfo* info = nullptr;
  std::unique_ptr<Integrator> integrator;
  RenderSettings settings;
  StopRule stop;
  RenderState state;  ///< empty film, nothing done, settings filled in

  RenderJob job(const Scene& scene) const { return {scene, view, settings}; }
};

/// Resolves options against scene and view. Throws Error for unknown integrators or parameters and values out of range.
Session open_session(const Scene& scene, View view, const RenderOptions& options);

/// Renders what the session asks for; its state has then moved into the result.
RenderState render(const Scene& scene, Session& session, const Observer& observer, RenderStatistics& statistics);

/// The name of our integrator for pbrt's, e.g. "light" for "lightpath"; empty for names that are not known.
std::string integrator_for_pbrt(const std::string& name);

}  // namespace lanthorn
