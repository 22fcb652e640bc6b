// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The lights' views of the scene: the bounce maps of image-space photon mapping (McGuire & Luebke 2009), which are
// shadow maps, too.
#pragma once

#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "realtime/lights/light_views.h"
#include "realtime/scene/gpu_scene.h"

namespace lanthorn {

/// A layer of texels for each window of each view.
class LightMaps {
 public:
  /// Draws the scene from all views into maps of `size` x `size` texels. `program`: scene.vert.glsl with
  /// gbuffer.frag.glsl. `photons`: number of photons of each view; empty: no photons.
  void draw(const GpuScene& scene, const std::vector<LightView>& views, const std::vector<std::uint32_t>& photons,
            const gl::Program& program, int size);
  /// Binds views and maps for shaders that include light_views.glsl.
  void bind() const;

  int layers() const { return layers_; }
  int size() const { return position_.width(); }
  const gl::Texture& position() const { return position_; }
  const gl::Texture& surface() const { return surface_; }
  const gl::Texture& colour() const { return colour_; }

 private:
  void allocate(int layers, int size);
  void upload(const std::vector<LightView>& views, const std::vector<std::uint32_t>& photons,
              const BoundingSphere& sphere);

  int layers_ = 0;
  gl::Texture position_, surface_, colour_, depth_;
  std::vector<gl::Framebuffer> framebuffers_;  // by layer
  gl::AlternatingBuffer views_;
};

}  // namespace lanthorn
