// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "index/bucket_kdtree.h"
#include "path/direction_guide.h"
#include "path/vertex.h"
#include "photon/photon.h"

namespace lanthorn {

/// Guides for directions, made once at some of the photons from the directions of their neighbours, so that a vertex
/// has only to find one that is near (Jensen 1995 makes one at each vertex). Whatever they say, estimates keep their
/// mean: they may be of other wavelengths or of another time. Immutable.
class GuidePhotons {
 public:
  static constexpr std::size_t stride = 32;    ///< one photon in so many has a record
  static constexpr std::size_t nearest = 256;  ///< photons that a record is made of, at most

  GuidePhotons() = default;
  /// `accepts(flags)`: the photons whose light the walks look for by themselves.
  static GuidePhotons build(std::span<const std::vector<Photon>> chunks, const Wavelengths& w,
                            const std::function<bool(const PhotonFlags&)>& accepts);

  /// What guides walks at the vertex, on the side that they came from; nothing if no record of its surface is near.
  /// Half of the directions of wide lobes are the guide's, fewer of narrow ones, which closures know better.
  Guidance find(const SurfaceVertex& vertex) const;

  std::size_t size() const { return guides_.size(); }
  std::size_t memory_bytes() const {
    return index_.memory_bytes() + size() * (sizeof(Record) + sizeof(DirectionGuide) + DirectionGuide::table_bytes());
  }

 private:
  struct Record {
    Normal normal{0};  ///< on the side that the light comes from
    float reach = 0;   ///< distance of the farthest of its photons, m
  };
  class Builder;

  BucketKdTree index_;
  std::vector<Record> records_;  ///< by slot, and apart from the large guides, since a search reads many
  std::vector<DirectionGuide> guides_;
};

}  // namespace lanthorn
