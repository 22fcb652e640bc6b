// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gl/texture.h"
#include "realtime/lights/light_views.h"
#include "realtime/scene/gbuffer.h"
#include "realtime/scene/gpu_scene.h"
#include "scene/scene.h"

namespace lanthorn {

/// Which views see each pixel of a G-buffer, by rays of the CPU: bit i of a pixel for view i. At most 32 views count.
class TracedShadows {
 public:
  /// Leaves out pixels whose `materials` eye paths draw (`is_drawn_by_paths`). Waits for the GPU. Returns the number of
  /// rays.
  std::uint64_t trace(const Scene& scene, const GBuffer& seen, const std::vector<LightView>& views,
                      const std::vector<GpuMaterial>& materials, const EyePaths& eye_paths);
  const gl::Texture& visibility() const { return visibility_; }  ///< R32UI

 private:
  gl::Texture visibility_;
};

}  // namespace lanthorn
