// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// From a scene and a user's wishes to something that `render` can run: the scene file's own choices where the user has
// none, defaults where neither has.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "description/scene_description.h"
#include "integrators/integrator.h"
#include "render/render.h"
#include "render/state.h"
#include "scene/scene.h"

namespace lanthorn {

/// What the user asked for; whatever is empty is taken from the scene file or has a default.
struct RenderOptions {
  std::optional<std::string> integrator;
  std::optional<std::uint64_t> passes;
  std::optional<double> seconds;
  std::optional<PassRange> pass_range;  ///< for shards; excludes `passes`
  std::optional<std::uint64_t> seed;
  std::optional<ColorMode> color;
  std::optional<std::array<int, 2>> resolution;  ///< width, height, pixels
  std::optional<std::array<int, 4>> crop;        ///< x0, y0, x1, y1, pixels; end exclusive
  std::optional<std::uint64_t> photons;          ///< light paths per pass
  std::optional<int> max_depth;
  std::optional<std::uint64_t> memory;     ///< bytes, see `plan_memory`
  std::map<std::string, std::string> set;  ///< the integrator's parameters
};

/// Puts the options that decide how the scene is built (resolution) into the description. Throws Error.
void apply_to_description(const RenderOptions& options, SceneDescription& description);

/// Everything that `render` needs but the scene.
struct Session {
  const IntegratorInfo* info = nullptr;
  std::unique_ptr<Integrator> integrator;
  RenderSettings settings;
  StopRule stop;
  RenderState state;  ///< empty film, nothing done, settings filled in
};

/// Resolves options against the scene. Throws Error for unknown integrators or parameters and values out of range.
Session open_session(const Scene& scene, const RenderOptions& options);

/// The name of our integrator for pbrt's, e.g. "light" for "lightpath"; empty for names that are not known.
std::string integrator_for_pbrt(const std::string& name);

}  // namespace lanthorn
