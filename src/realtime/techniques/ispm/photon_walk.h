// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The photons of a frame. The GPU finds the first bounce in the lights' maps: image-space photon mapping (McGuire &
// Luebke 2009), section 3.2. The CPU follows the later ones: the walk of the offline methods (path/walk.h), with all
// closures.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "photon/photon.h"
#include "realtime/lights/light_maps.h"
#include "realtime/lights/light_views.h"
#include "realtime/scene/layouts.h"
#include "scene/scene.h"

namespace lanthorn {

namespace gpu {
#include "realtime/techniques/ispm/ispm_constants.glsl"
}  // namespace gpu

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

/// A photon on a surface; the two texels of photon.glsl.
struct GpuPhoton {
  Point position{0};
  std::uint32_t normal = 0;  ///< of its surface; octahedral, 2 x 16 bits
  Vec3 power{0};             ///< W, with grazing_gain
  std::uint32_t wi = 0;      ///< to the previous vertex of its path; octahedral, 2 x 16 bits

  Normal surface_normal() const { return decode_octahedral<16>(normal); }
  Direction incident() const { return decode_octahedral<16>(wi); }
};

/// The photons of a frame; those that have met only delta lobes come last.
struct FramePhotons {
  std::vector<GpuPhoton> photons;
  std::vector<std::uint32_t> depths;      ///< of the photons: scattering events of their paths, the one there included
  std::uint32_t indirect = 0;             ///< number of the others, which come first
  std::vector<std::uint64_t> per_bounce;  ///< [i]: photons after i + 1 bounces
  std::uint64_t started = 0;              ///< in the bounce maps
  std::uint64_t rays = 0;
};

using SharedPhotons = std::shared_ptr<const FramePhotons>;

struct WalkSettings {
  std::uint64_t seed = 0;
  std::uint32_t frame = 0;
  int max_depth = 64;     ///< scattering events of a whole path, from light to eye
  bool disperses = true;  ///< as FrameSettings
};

/// Follows the photons. The result, including its order, is a function of the arguments alone.
FramePhotons walk_photons(const Scene& scene, const std::vector<LightView>& views,
                          const std::vector<PhotonStart>& starts, const WalkSettings& settings);

}  // namespace lanthorn
