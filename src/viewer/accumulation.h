// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The picture in the window: the mean of frames, or an offline render.
#pragma once

#include <array>
#include <cstdint>

#include "gl/program.h"
#include "gl/texture.h"
#include "lanthorn/image.h"
#include "realtime/frame/renderer.h"

namespace lanthorn {

/// Names of the layers of light in a picture, in the order of `Accumulation`'s.
inline constexpr std::array light_layer_names{"emission", "direct", "indirect", "caustic"};

/// Settings of a picture for a screen.
struct ToneSettings {
  enum class Curve : std::uint8_t {
    clipped = gpu::curve_clipped,
    reinhard = gpu::curve_reinhard,
    filmic = gpu::curve_filmic,
    agx = gpu::curve_agx,
    highlights = gpu::curve_highlights
  };
  float exposure = 1;  ///< factor of radiance
  Curve curve = Curve::clipped;
  float highlight_strength = 0;  ///< of `HighlightCurve`
  glm::vec4 shown{1};            ///< factors of emission, direct, indirect, caustic
};

class Accumulation {
 public:
  /// The OpenGL context must be current, here and later.
  Accumulation(int width, int height);

  /// Forgets the frames so far.
  void reset() { frames_ = 0; }
  /// Adds the renderer's last frame. `factor`: pixel value over radiance.
  void add(const Renderer& renderer, float factor);
  /// Replaces the mean by the layers of a picture of this size. Light without layers counts as emission.
  void load(const Image& image);

  std::uint64_t frames() const { return frames_; }
  int width() const { return layers_[0].width(); }
  int height() const { return layers_[0].height(); }
  /// Draws the mean, tone-mapped, into the texture `screen`, the first row first in memory.
  void present(const ToneSettings& tone);
  const gl::Texture& screen() const { return screen_; }
  /// R, G, B and the four layers.
  Image read() const;

 private:
  std::array<gl::Texture, 4> layers_;  // emission, direct, indirect, caustic
  gl::Texture screen_;
  gl::Framebuffer layer_target_, screen_target_;
  gl::Program accumulate_, tone_;
  Screen screen_triangle_;
  std::uint64_t frames_ = 0;
};

}  // namespace lanthorn
