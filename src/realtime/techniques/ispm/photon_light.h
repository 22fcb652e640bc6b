// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The light of photons on the pixels near them: by drawn volumes, or by lists of photons for tiles of pixels (Mara,
// Luebke & McGuire 2013, "Toward Practical Real-Time Photon Mapping", section 4.3).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gl/buffer.h"
#include "gl/object.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "realtime/scene/gbuffer.h"
#include "realtime/scene/projection.h"
#include "realtime/techniques/ispm/photon_walk.h"

namespace lanthorn {

/// A kernel around photons: a flat cylinder about the normal.
struct PhotonVolume {
  float radius = 0.1f;        ///< in the tangent plane, m
  float half_height = 0.02f;  ///< along the normal, m

  friend bool operator==(const PhotonVolume&, const PhotonVolume&) = default;
};

/// A picture in square tiles, row by row. Photons are sorted into the tiles of pixels that their volumes may cover.
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

/// How photons reach the pixels near them; both give the same light up to rounding.
enum class PhotonGather : std::uint8_t {
  splat,  ///< volumes of photons are drawn and blended (McGuire & Luebke 2009)
  tiles   ///< tiles of pixels find the photons near them (Mara et al. 2013)
};

/// Light of photons on visible surfaces.
class PhotonLight {
 public:
  PhotonLight() = default;
  /// `closures`: the result of `closure_defines`.
  PhotonLight(const gl::ShaderFiles& files, const std::string& closures);

  /// Takes over the photons for the next frames.
  void upload(FramePhotons photons);
  /// The photons uploaded last; null: none yet.
  const SharedPhotons& photons() const { return frame_; }
  /// Adds the light of all photons to the two layers, RGBA32F, where eye paths do not draw (`is_drawn_by_paths`). The
  /// scene must be bound.
  void draw(const GBuffer& seen, const WindowRays& rays, const Mat4& to_clip, const PhotonVolume& volume,
            PhotonGather gather, const EyePaths& eye_paths, const gl::Texture& indirect, const gl::Texture& caustic);

 private:
  /// TilePhotons on the GPU.
  struct TileLists {
    gl::AlternatingBuffer begins, entries;
    std::uint32_t longest = 0;  // list
    void write(const TilePhotons& photons);
  };
  struct Range {
    std::uint32_t first = 0, count = 0;
  };
  void splat(const GBuffer& seen, const WindowRays& rays, const Mat4& to_clip, const gl::Texture& layer,
             Range photons) const;
  void gather(const GBuffer& seen, const gl::Texture& layer, const TileLists& lists) const;

  gl::Program splat_, tiles_;
  SharedPhotons frame_;
  gl::AlternatingBuffer photons_;
  TileLists indirect_tiles_, caustic_tiles_;
  gl::BufferTexture photon_texels_, tile_begins_, tile_photons_;
  gl::VertexArray no_vertices_;
};

}  // namespace lanthorn
