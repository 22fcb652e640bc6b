// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "index/hash_grid.h"
#include "path/light_layers.h"
#include "path/lobe_split.h"
#include "path/walk.h"
#include "photon/gather/photon_hit.h"
#include "realtime/techniques/ispm/photon_tiles.h"
#include "realtime/techniques/ispm/photon_walk.h"

namespace lanthorn {

/// The photons of a frame, for gathering at points. The kernel is the same as in photon.glsl.
class NearPhotons {
 public:
  NearPhotons(SharedPhotons photons, const PhotonVolume& volume);

  bool holds(const SharedPhotons& photons, const PhotonVolume& volume) const {
    return photons_ == photons && volume_ == volume;
  }
  /// Adds the photons' light that the vertex scatters to the eye, as far as the split leaves it to photons.
  void gather(const SurfaceVertex& vertex, const LobeSplit& split, int max_depth, LightLayers& layers) const;

 private:
  Spectrum light_of(const GpuPhoton& photon, const GatherVertex& met, const LobeSplit& split) const;

  SharedPhotons photons_;
  PhotonVolume volume_;
  float reach_;
  IndexBuild<HashGrid> index_;
};

}  // namespace lanthorn
