// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Ways to draw the light of a frame that is not direct, as plug-ins: each is a folder with its TechniqueInfo, its
// shaders and a class whose `draw` adds the light.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gl/program.h"
#include "path/light_layers.h"
#include "path/lobe_split.h"
#include "path/render_job.h"
#include "path/walk.h"
#include "realtime/scene/gpu_scene.h"
#include "realtime/techniques/technique_info.h"
#include "scene/scene.h"

namespace lanthorn {

struct FrameContext;
struct FrameSettings;
class TechniqueChoice;

/// Adds the light that a technique knows at a vertex of an eye path, as far as the split leaves it to the technique.
/// `max_depth`: scattering events of a path from light to eye. Called by several threads at once.
using VertexLight =
    std::function<void(const SurfaceVertex& vertex, const LobeSplit& split, int max_depth, LightLayers& layers)>;

/// A technique keeps data made of scene and GPU between frames. The picture of a frame is a function of its context
/// alone.
class Technique {
 public:
  virtual ~Technique() = default;

  /// Called after the lights' maps are drawn and before the G-buffer, which the GPU may draw while the CPU waits for
  /// the work begun here.
  virtual void prepare(const FrameContext& /*frame*/) {}
  /// Adds the technique's light to the layers of the frame. G-buffer and direct light are drawn.
  virtual void draw(const FrameContext& frame) = 0;
  /// The technique's light at vertices of eye paths; empty: none. Called after `draw`, if there are eye paths.
  virtual VertexLight light_at_vertices(const FrameContext& /*frame*/) { return {}; }
};

/// The sources of a technique's shader programs.
struct TechniqueShaders {
  const gl::ShaderFiles& files;
  const std::string& surfaces;  ///< lines for shaders that include bsdf.glsl (`closure_defines`)
};

/// A technique's requirements on the rest of the frame.
struct FramePlan {
  EyePaths eye_paths = all_eye_paths;
  EyePaths eye_paths_in_motion = needed_eye_paths;  ///< with FrameSettings::has_stand_ins
  bool eye_paths_find_indirect = false;             ///< they go on from the first vertex that scatters
  std::uint32_t photons = 0;                        ///< that start in the lights' maps
  /// Below this GGX width, lobes show infinite lights by the technique instead of by views of these lights.
  float least_sky_alpha = 0;
};

using ParameterValues = std::map<std::string, std::string>;

/// An entry of the registry.
struct TechniqueInfo {
  TechniqueDescription description;
  std::unique_ptr<Technique> (*make)(const TechniqueShaders& shaders) = nullptr;
  FramePlan (*plan)(const FrameSettings& settings) = [](const FrameSettings&) { return FramePlan{}; };
  /// Values for parameters that are "auto", chosen for a view; null: the technique has no such parameters.
  ParameterValues (*fit_view)(const Scene& scene, const View& view) = nullptr;
  /// The same for a render, which may measure them.
  ParameterValues (*fit_render)(const RenderJob& job) = nullptr;
  /// Throws Error for values that do not go together.
  void (*check)(const TechniqueChoice& choice) = nullptr;
  /// Differences from the offline methods in this scene, as text for the user. `gpu_scene`: null before there is one.
  std::vector<std::string> (*limitations)(const Scene& scene, const GpuScene* gpu_scene) = nullptr;
};

/// The techniques that techniques/CMakeLists.txt lists.
std::vector<TechniqueInfo> built_in_techniques();
/// All techniques, in the order of the viewer's list.
std::vector<const TechniqueInfo*> technique_registry();
/// Adds a technique. Throws Error if its name is taken. Call it before any frame: not thread-safe.
void add_technique(TechniqueInfo info);
/// Null if there is none of this name.
const TechniqueInfo* find_technique(const std::string& name);

/// A technique with values of its parameters.
class TechniqueChoice {
 public:
  /// Parameters that are not set have the defaults of `render`. Throws Error for unknown names of technique or
  /// parameters, and for values that a parameter does not take.
  explicit TechniqueChoice(const std::string& name = "direct", const ParameterValues& set = {});

  const TechniqueInfo& info() const { return *info_; }
  const std::string& text(const std::string& parameter) const { return values_.at(parameter); }
  bool is_auto(const std::string& parameter) const { return text(parameter) == "auto"; }
  double number(const std::string& parameter) const;
  int whole(const std::string& parameter) const { return static_cast<int>(number(parameter)); }
  /// Number of a word among TechniqueParameter::words.
  std::size_t word(const std::string& parameter) const;

 private:
  const TechniqueParameter& parameter(const std::string& name) const;

  const TechniqueInfo* info_;
  ParameterValues values_;
};

}  // namespace lanthorn
