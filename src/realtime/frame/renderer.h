// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Frames of a scene by OpenGL. The picture of a frame is a function of scene, view and settings.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/view.h"
#include "gl/context.h"
#include "gl/program.h"
#include "gl/timer.h"
#include "lanthorn/image.h"
#include "realtime/frame/specular_light.h"
#include "realtime/lights/light_maps.h"
#include "realtime/lights/light_views.h"
#include "realtime/lights/traced_shadows.h"
#include "realtime/scene/gbuffer.h"
#include "realtime/scene/gpu_scene.h"
#include "realtime/techniques/frame_context.h"
#include "realtime/techniques/technique.h"
#include "scene/scene.h"

namespace lanthorn {

/// The stage of a frame in which the CPU follows paths from the eye.
inline constexpr const char* eye_path_stage = "eye paths (CPU)";
/// Most photons in the lights' maps of a frame.
inline constexpr std::uint64_t most_frame_photons = std::uint64_t{1} << 24;

/// The data on which the maps of lights depend, besides the scene.
struct LightKey {
  LightViewSettings views;
  std::uint32_t photons = 0;

  friend bool operator==(const LightKey&, const LightKey&) = default;
};

/// Draws frames in the context that was current when it was made, and must be current whenever it is called.
class Renderer {
 public:
  /// Throws gl::Unavailable if the context has no OpenGL 4.5, Error if a shader does not compile.
  explicit Renderer(const Scene& scene);

  /// Shows an edited scene, which shares its shapes with the last one. `scene` must outlive its frames, like the
  /// constructor's scene.
  void update(const Scene& scene);

  /// Draws the frame into layers. Throws Error with OpenGL's message if OpenGL has reported an error.
  void draw(const View& view, const FrameSettings& settings);
  /// Layers emission, direct, indirect, caustic of the last frame: channels emission.R ... caustic.B.
  Image read_layers() const;
  /// Report on the last frame; waits for the GPU.
  FrameReport report();

  const GpuScene& gpu_scene() const { return gpu_scene_; }
  const GBuffer& gbuffer() const { return gbuffer_; }
  const LightTextures& layers() const { return layers_; }
  const LightMaps& light_maps() const { return light_maps_; }
  const std::vector<LightView>& light_views() const { return views_; }
  const gl::DebugLog& log() const { return log_; }

 private:
  struct Programs {
    Programs(const gl::ShaderFiles& files, const std::string& surfaces);
    gl::Program gbuffer, light_map, background, direct;
    SpecularLight specular;
  };

  void allocate(int width, int height);
  Technique& technique(const TechniqueInfo& info);
  Mat4 eye_clip(const WindowRays& rays) const;
  void draw_light_maps(const LightKey& key);
  void draw_gbuffer(const FrameContext& frame);
  void trace_shadows(const FrameContext& frame);
  void draw_direct(const FrameContext& frame, float least_sky_alpha);
  void draw_specular(const FrameContext& frame, Technique& technique, bool find_indirect);
  void draw_stages(const FrameContext& frame, const FramePlan& plan);

  gl::DebugLog log_;
  bool is_software_;
  const Scene* scene_;
  GpuScene gpu_scene_;
  std::string surfaces_;  // defines of programs_
  Programs programs_;
  std::map<const TechniqueInfo*, std::unique_ptr<Technique>> techniques_;  // those that were drawn so far
  Screen screen_;
  GBuffer gbuffer_;
  LightMaps light_maps_;
  std::vector<LightView> views_;
  std::optional<LightKey> lights_of_;     // what light_maps_ and views_ were made for
  std::uint64_t light_maps_version_ = 0;  // of light_maps_ and views_; from 1 on
  TracedShadows traced_;
  LightTextures layers_;
  LightTargets targets_;
  gl::Framebuffer emission_target_, layers_target_;
  gl::StageTimer timer_;
  FrameReport report_;
};

}  // namespace lanthorn
