// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Frames of a scene by OpenGL. What a frame shows is a function of scene, view and settings.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/view.h"
#include "gl/debug_log.h"
#include "gl/program.h"
#include "gl/timer.h"
#include "gl/vertex_array.h"
#include "lanthorn/image.h"
#include "realtime/frame/specular_light.h"
#include "realtime/lights/light_maps.h"
#include "realtime/lights/light_views.h"
#include "realtime/lights/traced_shadows.h"
#include "realtime/scene/gbuffer.h"
#include "realtime/scene/gpu_scene.h"
#include "realtime/techniques/ispm/bounce_map.h"
#include "realtime/techniques/ispm/photon_light.h"
#include "realtime/techniques/ispm/photon_walk.h"
#include "realtime/techniques/splitsum/environment_light.h"
#include "realtime/techniques/voxelcones/voxel_light.h"
#include "scene/scene.h"

namespace lanthorn {

/// Light that has been scattered more than once.
enum class IndirectLight : std::uint8_t {
  none,
  ambient,
  photons,
  voxels,
  environment  ///< instead of all other light, that of the environment by the split sum, without shadows
};
enum class ShadowKind : std::uint8_t { none, maps, traced };

/// Settings of IndirectLight::photons.
struct PhotonSettings {
  std::uint32_t count = 20000;  ///< in the bounce maps of all lights together
  float radius = 0.1f;          ///< of a photon's kernel, m
  int max_depth = 64;           ///< scattering events of a path from light to eye
  PhotonGather gather = PhotonGather::automatic;
  /// Shows the photons of the frame before while the CPU follows this frame's (McGuire & Luebke 2009, fig. 3): frames
  /// come faster, and light follows a frame late.
  bool late = false;
};

struct FrameSettings {
  IndirectLight indirect = IndirectLight::none;
  ShadowKind shadows = ShadowKind::maps;
  Vec3 ambient{1};           ///< irradiance of IndirectLight::ambient, W/m²
  Vec2 offset{0};            ///< of the points on the film from the centres of their pixels, pixels
  Vec2 lens{0.5f};           ///< point of the lens, in [0,1)²
  float time = 0;            ///< of the camera, s
  int eye_path_spacing = 1;  ///< SpecularPaths::spacing
  /// For an eye that moves: the GPU draws materials that it knows nearly, instead of eye paths, whose light has noise.
  bool has_stand_ins = false;
  /// Parallel light has finer maps, and half of its photons, around what is seen of a large scene. Photons from beyond
  /// are few and heavy.
  bool has_light_focus = false;
  LightViewSettings views;
  PhotonSettings photons;
  VoxelSettings voxels;
};

/// The stage of a frame in which the CPU follows paths from the eye.
inline constexpr const char* eye_path_stage = "eye paths (CPU)";

/// What happened in a frame.
struct FrameReport {
  std::vector<gl::StageTime> stages;  ///< on the GPU; then those of the CPU, which run beside it
  std::vector<std::uint64_t> photons_per_bounce;
  std::uint64_t photons_started = 0, rays = 0, shadow_rays = 0;
  std::size_t light_views = 0;
};

/// What the maps of lights and the photons of a frame depend on, besides the scene.
struct LightKey {
  LightViewSettings views;
  std::uint32_t photons = 0;
  int max_depth = 0;

  friend bool operator==(const LightKey&, const LightKey&) = default;
};

/// The light of a frame in layers, each RGBA32F; their sum is the picture.
struct LightTextures {
  gl::Texture direct, indirect, caustic;
};

/// Settings of a picture for a screen.
struct ToneSettings {
  enum class Curve : std::uint8_t { clipped, reinhard, filmic };
  float exposure = 1;  ///< factor of radiance
  Curve curve = Curve::clipped;
  glm::vec4 shown{1};  ///< factors of emission, direct, indirect, caustic
};

/// Draws frames in the context that was current when it was made, and must be current whenever it is called.
class Renderer {
 public:
  /// Throws gl::Unavailable if the context has no OpenGL 4.5, Error if a shader does not compile.
  explicit Renderer(const Scene& scene);

  /// Compiles the shaders anew. The old ones stay if that throws.
  void reload(const gl::ShaderFiles& files);
  /// Shows an edited scene (`edit_scene`). `scene` must outlive its frames, like that of the constructor.
  void update(const Scene& scene);

  /// Draws the frame into layers. Throws Error with what OpenGL has reported, if anything.
  void draw(const View& view, const FrameSettings& settings);
  /// Draws the last frame for a screen into `framebuffer` (0: the window) of the same size, its first row at the upper
  /// edge.
  void present(unsigned framebuffer, const ToneSettings& tone) const;
  /// Layers emission, direct, indirect, caustic of the last frame: channels emission.R ... caustic.B.
  Image read_layers() const;
  /// Of the last frame; waits for the GPU.
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
    gl::Program gbuffer, light_map, background, direct, ambient, tone;
    BounceMap bounces;
    PhotonLight photons;
    EnvironmentLight environment;
    VoxelLight voxels;
    SpecularLight specular;
  };

  void allocate(int width, int height);
  void draw_gbuffer(const FrameSettings& settings, const WindowRays& rays);
  void trace_shadows(const FrameSettings& settings);
  void draw_direct(const FrameSettings& settings, const WindowRays& rays);
  void draw_lights(const FrameSettings& settings, const View& view, const WindowRays& rays);
  void draw_environment(const FrameSettings& settings, const WindowRays& rays);
  void draw_voxels(const FrameSettings& settings, const View& view, const WindowRays& rays);
  void draw_ambient(const FrameSettings& settings);
  void draw_indirect(const FrameSettings& settings, const View& view, const WindowRays& rays);
  void draw_photons(const FrameSettings& settings, const WindowRays& rays, const LightKey& key,
                    const std::vector<PhotonStart>& starts);
  std::vector<PhotonStart> draw_light_maps(const LightKey& key);
  void follow_photons(const LightKey& key, const std::vector<PhotonStart>& starts);
  void draw_volumes(const FrameSettings& settings, const WindowRays& rays);
  void draw_specular(const FrameSettings& settings, const View& view);
  PhotonVolume photon_volume(const FrameSettings& settings) const;
  Mat4 eye_clip(const WindowRays& rays) const;
  void draw_screen() const;

  gl::DebugLog log_;
  bool is_software_;
  const Scene* scene_;
  GpuScene gpu_scene_;
  gl::ShaderFiles files_;
  std::string surfaces_;  // defines of programs_
  Programs programs_;
  gl::VertexArray no_vertices_;
  GBuffer gbuffer_;
  LightMaps light_maps_;
  std::vector<LightView> views_;
  std::optional<LightKey> lights_of_;  // what light_maps_, views_ and the photons were made for
  SharedPhotons shown_photons_;        // of the frame
  TracedShadows traced_;
  LightTextures layers_;
  gl::Framebuffer emission_target_, direct_target_, indirect_target_, caustic_target_, layers_target_;
  gl::StageTimer timer_;
  FrameReport report_;
};

}  // namespace lanthorn
