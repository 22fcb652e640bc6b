// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Light of mirrors, glass and glossy surfaces: eye paths of the CPU, because a rasteriser cannot follow them. They
// continue through delta lobes and, direction by direction, through narrow ones (LobeSplit); the frame's technique
// gives the indirect light of wide lobes, as photons do in probppm.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "camera/view.h"
#include "gl/buffer.h"
#include "gl/object.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "realtime/scene/gbuffer.h"
#include "realtime/scene/gpu_scene.h"
#include "realtime/techniques/technique.h"
#include "scene/scene.h"

namespace lanthorn {

class GatherVertex;

/// The eye paths of a frame.
struct SpecularPaths {
  std::uint64_t seed = 0;
  std::uint32_t frame = 0;
  int max_depth = 64;          ///< scattering events of a path from light to eye
  Vec2 offset{0}, lens{0.5f};  ///< as FrameSettings
  float time = 0;              ///< s
  /// Each material has one path in each block of this many pixels squared, and the block's other pixels show its light,
  /// too: an approximation if above 1, for an eye that moves.
  int spacing = 1;
  EyePaths eye_paths = all_eye_paths;
  bool disperses = true;               ///< as FrameSettings
  bool finds_indirect = true;          ///< false: direct light alone
  std::function<VertexLight()> light;  ///< of the technique; called only if there are paths
};

/// The light of these paths, in layers by PathClass.
class SpecularLight {
 public:
  SpecularLight() = default;
  explicit SpecularLight(const gl::ShaderFiles& files);

  /// Follows one path for each pixel, or for several (`SpecularPaths::spacing`), whose material `is_drawn_by_paths` or
  /// has delta lobes. In the second case the GPU draws the other lobes; it always draws emission that is seen directly.
  /// Waits for the GPU. Returns the number of rays, 0 if there is no such pixel.
  std::uint64_t trace(const Scene& scene, const View& view, const GBuffer& seen,
                      const std::vector<GpuMaterial>& materials, const SpecularPaths& paths);
  /// Adds the light that was traced last to the layers that are drawn into, one for each PathClass in its order.
  void add_to(const gl::Framebuffer& layers) const;

 private:
  gl::Program add_;
  gl::AlternatingBuffer light_;
  std::size_t pixels_ = 0;
  gl::BufferTexture texels_;
  gl::VertexArray no_vertices_;
};

}  // namespace lanthorn
