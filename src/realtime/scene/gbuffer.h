// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/texture.h"

namespace lanthorn {

/// The surfaces that the eye sees, by pixel. The first row is the upper one of the picture. See gbuffer.glsl.
class GBuffer {
 public:
  GBuffer() = default;
  GBuffer(int width, int height);

  /// Binds it for drawing and clears it.
  void begin() const;
  /// Binds its textures for shaders that include gbuffer.glsl.
  void bind() const;

  int width() const { return position_.width(); }
  int height() const { return position_.height(); }
  const gl::Texture& position() const { return position_; }  ///< RGBA32F: world, depth along the axis; 0: nothing
  /// RGBA32UI: shading and geometric normal (octahedral, 2 x 16 bits), material, triangle.
  const gl::Texture& surface() const { return surface_; }
  const gl::Texture& colour() const { return colour_; }      ///< RGBA16F: reflectance of the diffuse base, GGX width
  const gl::Texture& lobe() const { return lobe_; }          ///< RGBA16F: as GpuMaterial::through, f90
  const gl::Texture& emission() const { return emission_; }  ///< RGBA32F: radiance
  const gl::Texture& depth() const { return depth_; }        ///< reversed: 1 nearest, 0 infinitely far

 private:
  gl::Texture position_, surface_, colour_, emission_, lobe_, depth_;
  gl::Framebuffer framebuffer_;
};

}  // namespace lanthorn
