// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photons after their first bounce, from the lights' maps: image-space photon mapping (McGuire & Luebke 2009), section
// 3.2.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "realtime/lights/light_maps.h"
#include "realtime/techniques/ispm/ispm_constants.h"

namespace lanthorn {

using gpu::PhotonStart;

/// Normal of the surface on which the photon begins.
Normal surface_normal(const PhotonStart& start);

/// Draws texels of the lights' maps with probabilities in proportion to the light that they scatter, and scatters a
/// photon at each.
class BounceMap {
 public:
  BounceMap() = default;
  /// `closures`: the result of `closure_defines`.
  explicit BounceMap(const gl::ShaderFiles& files, const std::string& closures = {});

  /// Draws the first scattering of each photon on the GPU. The scene must be bound, and the maps must have been drawn
  /// for the same numbers of photons.
  void start(const LightMaps& maps, int view_count, std::uint32_t photons, std::uint64_t seed, std::uint32_t frame);
  /// The photons of the last `start`; waits for the GPU.
  std::vector<PhotonStart> read() const { return starts_.read<PhotonStart>(count_); }

 private:
  gl::Program importance_, rows_, start_;
  gl::Buffer texel_sums_, row_sums_, starts_;
  std::uint32_t count_ = 0;
};

}  // namespace lanthorn
