// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "index/beam_bvh.h"
#include "path/light_pass.h"
#include "path/path_context.h"
#include "path/path_draw.h"
#include "photon/flux_classes.h"
#include "photon/guides/guide_photons.h"
#include "photon/photon.h"

namespace lanthorn {

/// A photon where it scatters in a medium, or where its flight through one begins.
struct MediumPhoton {
  Photon photon;  ///< its normal is its direction `wi`
  MediumId medium;
  float length = 0;  ///< of the flight, in direction -wi; 0: a photon that scatters

  Beam beam(float radius) const { return {photon.position, -photon.wi, length, radius}; }
};

/// True if the flights of a light path are among the `share` that is kept. The choice is random, with the same
/// probability for all paths, so that all kept flights are weighted by the same factor, wherever they start.
inline bool keeps_beams(const Sampler& of_path, float share) { return of_path.generator(1).next() < share; }

/// The photons that a pass stores.
struct PhotonRule {
  int first_depth = 2;  ///< 1 stores photons straight from a light too; 2 leaves direct light to other techniques
  int max_depth = 64;   ///< of the whole path, which uses the photon at its first vertex or later
  int roulette_depth = 1;
  bool caustics_alone = false;  ///< stores caustic photons only, and ends paths after a non-delta scattering
  FluxClasses classes{};        ///< in which photons are kept apart
  MediumRecords media = MediumRecords::none;
  int first_medium_depth = 2;  ///< as `first_depth`, in media
};

/// Photons by class, chunk of work, and path.
using PhotonChunks = std::vector<std::vector<std::vector<Photon>>>;

/// Traces the photons of a pass, or of a block of its light paths, and keeps them in path order: chunk by chunk and
/// path by path, independent of the number of threads. Reuses its memory from pass to pass.
class PhotonTracer {
 public:
  /// All photons of the pass share `draw`. `guide` may be null; `pass.guide` must be null.
  void trace(const Scene& scene, LightPass pass, const PhotonRule& rule, const PassDraw& draw,
             const LightGuide* guide = nullptr);

  /// Photons on surfaces, of one class.
  std::span<const std::vector<Photon>> chunks(std::size_t flux_class = 0) const { return photons_[flux_class]; }
  /// Photons in media, by the same chunks; none if the rule asks for none.
  std::span<const std::vector<MediumPhoton>> medium_chunks() const { return medium_photons_; }
  /// Light paths of the block, or of the whole pass.
  std::uint64_t emitted() const { return emitted_; }
  /// On surfaces and in media.
  std::uint64_t stored() const { return stored_; }
  std::uint64_t stored_in_media() const { return stored_in_media_; }
  const RayCounts& rays() const { return rays_; }

 private:
  PhotonChunks photons_{1};
  std::vector<std::vector<MediumPhoton>> medium_photons_;
  std::uint64_t emitted_ = 0;
  std::uint64_t stored_ = 0;
  std::uint64_t stored_in_media_ = 0;
  RayCounts rays_;
};

}  // namespace lanthorn
