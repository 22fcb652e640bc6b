// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Properties that vary over surfaces, for the GPU: layers of one texture over the unit square of (u, v), which repeats.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "gl/texture.h"
#include "math/vec.h"
#include "realtime/scene/constants.h"

namespace lanthorn {

/// The texels of a layer, as a function of (u, v) in [0,1)².
using SurfaceLayer = std::function<glm::vec4(const Vec2&)>;

inline constexpr std::size_t most_layers = 256;

/// Values in the middles of 16 x 16 equal parts of the unit square, row by row.
template <class Values>
auto probe_square(const Values& values) {
  constexpr int points = 16;
  std::vector<decltype(values(Vec2(0)))> probes;
  for (int y = 0; y < points; ++y)
    for (int x = 0; x < points; ++x)
      probes.push_back(values((Vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) / float{points}));
  return probes;
}

class SurfaceTextures {
 public:
  /// Takes over these layers, `most_layers` at most. Returns false, and keeps the texels, if layers of the same values
  /// are there: edits of a scene change few of them, if any.
  bool update(const std::vector<SurfaceLayer>& layers);
  /// For the sampler of bsdf.glsl.
  void bind() const { texture_.bind(gpu::unit_surfaces); }
  int side() const { return texture_.width(); }

 private:
  std::vector<glm::vec4> fingerprint_;
  gl::Texture texture_;
};

}  // namespace lanthorn
