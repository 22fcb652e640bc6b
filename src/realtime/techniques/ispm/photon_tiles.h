// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photons sorted into the tiles of pixels that their volumes may cover (Mara, Luebke & McGuire 2013, section 4.3).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lanthorn/vec.h"
#include "realtime/techniques/ispm/ispm_constants.h"
#include "realtime/techniques/ispm/photon_walk.h"

namespace lanthorn {

/// A kernel around photons: a flat cylinder about the normal.
struct PhotonVolume {
  float radius = 0.1f;        ///< in the tangent plane, m
  float half_height = 0.02f;  ///< along the normal, m

  friend bool operator==(const PhotonVolume&, const PhotonVolume&) = default;
};

/// A picture in square tiles, row by row.
struct TileGrid {
  static constexpr int side = gpu::tile_side;  ///< pixels
  int width = 0, height = 0;                   ///< of the picture, pixels

  int columns() const { return (width + side - 1) / side; }
  int rows() const { return (height + side - 1) / side; }
};

/// Lists of the photons of each tile, one after the other, in the layout of gather.comp.glsl. A list may have
/// photons whose volumes do not reach the tile, but lacks none.
struct TilePhotons {
  struct Entry {
    Point position;  ///< stored here, so that searches for near photons read memory in order
    std::uint32_t photon;
  };
  std::vector<std::uint32_t> begins;  ///< [t]: of the list of tile t in `entries`; then the end of the last
  std::vector<Entry> entries;         ///< of each list in ascending order of photons
};

/// `first`: number of photons[0].
TilePhotons photons_by_tile(std::span<const GpuPhoton> photons, std::uint32_t first, const Mat4& to_clip,
                            const PhotonVolume& volume, const TileGrid& grid);

}  // namespace lanthorn
