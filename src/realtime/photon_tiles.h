// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photons sorted into the tiles of pixels that their volumes may cover (Mara, Luebke & McGuire 2013, section 4.3).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lanthorn/vec.h"
#include "realtime/photon_walk.h"

namespace lanthorn {

/// A kernel around photons: an ellipsoid compressed along the normal.
struct PhotonVolume {
  float radius = 0.1f;        ///< in the tangent plane, m
  float half_height = 0.02f;  ///< along the normal, m
};

/// A picture in square tiles, row by row.
struct TileGrid {
  static constexpr int side = 16;  ///< pixels; that of shaders/gather.comp.glsl
  int width = 0, height = 0;       ///< of the picture, pixels

  int columns() const { return (width + side - 1) / side; }
  int rows() const { return (height + side - 1) / side; }
};

/// The photons of each tile, in the layout of shaders/gather.comp.glsl: element t says where the list of tile t begins
/// in this array, the element after the last tile's where the last list ends. The lists follow; each has numbers of
/// photons, counted from `first`, in ascending order. A list may have photons whose volumes do not reach the tile, but
/// lacks none.
std::vector<std::uint32_t> photons_by_tile(std::span<const GpuPhoton> photons, std::uint32_t first, const Mat4& to_clip,
                                           const PhotonVolume& volume, const TileGrid& grid);

}  // namespace lanthorn
