// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The frame that techniques draw into, and the triangle with which they fill it.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "camera/view.h"
#include "gl/object.h"
#include "gl/texture.h"
#include "gl/timer.h"
#include "realtime/lights/light_maps.h"
#include "realtime/lights/light_views.h"
#include "realtime/scene/gbuffer.h"
#include "realtime/scene/gpu_scene.h"
#include "realtime/scene/layouts.h"
#include "realtime/scene/projection.h"
#include "realtime/techniques/technique.h"
#include "scene/scene.h"

namespace lanthorn {

/// In the order of the words of the parameter "shadows".
enum class ShadowKind : std::uint8_t {
  none = gpu::shadows_none,
  maps = gpu::shadows_mapped,
  traced = gpu::shadows_traced
};

struct FrameSettings {
  FrameSettings() = default;
  /// Takes the shadows and views of lights from the technique's parameters.
  explicit FrameSettings(TechniqueChoice choice) : technique(std::move(choice)) {
    if (!technique.info().description.has_light_views) return;
    shadows = static_cast<ShadowKind>(technique.word("shadows"));
    views.map_size = technique.whole("map");
    views.sky_views = technique.whole("sky");
  }

  TechniqueChoice technique;
  ShadowKind shadows = ShadowKind::maps;
  std::uint32_t photons = 20000;  ///< of techniques with photons: in the maps of all lights together
  int max_depth = 64;             ///< scattering events of a path from light to eye
  Vec2 offset{0};                 ///< of the points on the film from the centres of their pixels, pixels
  Vec2 lens{0.5f};                ///< point of the lens, in [0,1)²
  float time = 0;                 ///< of the camera, s
  int eye_path_spacing = 1;       ///< SpecularPaths::spacing
  /// For a moving eye: the GPU approximates some materials instead of drawing them by eye paths, whose light has noise.
  bool has_stand_ins = false;
  /// Paths through dispersive glass have wavelengths of their own, and their colours. A single frame shows these as
  /// coloured noise. False: glass without dispersion.
  bool disperses = true;
  /// In a large scene, parallel light has finer maps and half of its photons around the visible part. Photons from
  /// beyond are few and heavy.
  bool has_light_focus = false;
  /// Shadows of maps are blurred by a texel: for the first frames of a view, whose mean shows the texels.
  bool has_soft_edges = false;
  LightViewSettings views;
};

/// Statistics of a frame.
struct FrameReport {
  std::vector<gl::StageTime> stages;  ///< on the GPU; then those of the CPU, which run beside it
  std::vector<std::uint64_t> photons_per_bounce;
  std::uint64_t photons_started = 0, rays = 0, shadow_rays = 0;
  std::size_t light_views = 0;
  float radius = 0;  ///< of the technique's density estimate, m; 0 if it has none
};

/// The light of a frame in layers, each RGBA32F; their sum and the emission in the G-buffer is the picture.
struct LightTextures {
  gl::Texture direct, indirect, caustic;
};
/// These layers, each alone, to draw into.
struct LightTargets {
  gl::Framebuffer direct, indirect, caustic;
};

/// The triangle of screen.vert.glsl, which covers all pixels of the render target.
class Screen {
 public:
  Screen() : no_vertices_(gl::make_vertex_array()) {}

  /// Runs the program in use in each pixel.
  void draw() const {
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(no_vertices_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

 private:
  gl::VertexArray no_vertices_;
};

/// Data of a frame for a technique.
struct FrameContext {
  const FrameSettings& settings;
  const Scene& scene;
  const View& view;
  const WindowRays& rays;
  const Mat4& to_clip;        ///< of the eye
  const EyePaths& eye_paths;  ///< materials that the technique must leave out (`is_drawn_by_paths`)
  const GpuScene& gpu_scene;  ///< is bound
  const GBuffer& seen;
  const LightMaps& light_maps;
  const std::vector<LightView>& light_views;
  std::uint64_t light_maps_version;  ///< another number whenever maps and views are drawn anew
  const LightTextures& layers;
  const LightTargets& targets;
  const Screen& screen;
  bool is_software;  ///< the CPU draws
  gl::StageTimer& timer;
  FrameReport& report;
};

inline double milliseconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace lanthorn
