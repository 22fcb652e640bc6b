// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gl/program.h"
#include "realtime/scene/projection.h"
#include "realtime/techniques/splitsum/environment_maps.h"
#include "scene/scene.h"

namespace lanthorn {

/// Split-sum shading of visible surfaces, by the maps of the scene's environment.
class EnvironmentLight {
 public:
  explicit EnvironmentLight(const gl::ShaderFiles& files);

  /// Bakes the maps if the environment has changed; returns whether it has. A GPU bakes them itself; with software
  /// OpenGL the CPU does.
  bool prepare(const Scene& scene);
  /// Uses the program split_sum.frag.glsl with its maps. G-buffer and scene must be bound.
  void use(const WindowRays& rays) const;

 private:
  gl::ShaderFiles files_;
  gl::Program shade_;
  EnvironmentMaps maps_;
  std::vector<Vec3> fingerprint_;
};

}  // namespace lanthorn
