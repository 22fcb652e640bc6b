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

/// A photon that the GPU has begun; the layout of start.comp.glsl.
struct PhotonStart {
  Point position{0};
  float state = gpu::start_none;
  Direction direction{0};  ///< of flight: arriving if incident, leaving if scattered
  float view = 0;
  Vec3 power{0};             ///< W
  std::uint32_t normal = 0;  ///< geometric, of the surface; octahedral, 2 x 16 bits

  Normal surface_normal() const;
};

/// Draws texels of the lights' maps with probabilities in proportion to the light that they scatter, and scatters a
/// photon at each.
class BounceMap {
 public:
  BounceMap() = default;
  /// `closures`: as `closure_defines` has it.
  explicit BounceMap(const gl::ShaderFiles& files, const std::string& closures = {});

  /// Begins the photons on the GPU. The scene must be bound; the maps were drawn with the same numbers of photons.
  void start(const LightMaps& maps, int view_count, std::uint32_t photons, std::uint64_t seed, std::uint32_t frame);
  /// The photons that have begun last; waits for the GPU.
  std::vector<PhotonStart> read() const { return starts_.read<PhotonStart>(count_); }

 private:
  gl::Program importance_, rows_, start_;
  gl::Buffer texel_sums_, row_sums_, starts_;
  std::uint32_t count_ = 0;
};

}  // namespace lanthorn
