// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Guides of light paths: where they start, and directions at guide photons.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "index/bucket_kdtree.h"
#include "light/emission_guide.h"
#include "path/direction_guide.h"
#include "path/vertex.h"
#include "photon/photon.h"

namespace lanthorn {

/// Importance that an eye path has left on a surface: the eye's counterpart of a photon, which light walks should meet.
struct Importance {
  Photon photon;  ///< its power is the path's throughput, `wi` points to the path's vertex before
  Point origin;   ///< that vertex
};

/// Direction guides, built once at a subset of the photons from the directions of their neighbours. A vertex looks up
/// the nearest one (Jensen 1995 builds one at each vertex). Guides do not change the mean of an estimate, so they may
/// come from photons of other wavelengths or of another time. Immutable.
class GuidePhotons {
 public:
  static constexpr std::size_t stride = 32;  ///< one photon in `stride` has a record
  static constexpr std::size_t stride_of_importance = 8;
  static constexpr std::size_t nearest = 256;  ///< photons used for a record, at most

  GuidePhotons() = default;
  /// `accepts(flags)` selects the photons whose light the guided walks have to find.
  static GuidePhotons build(std::span<const std::vector<Photon>> chunks, const Wavelengths& w,
                            const std::function<bool(const PhotonFlags&)>& accepts);
  /// Guides light walks to the origins of the importance. Where importance is sparse, as far from a window through
  /// which the place is seen, neighbours are far apart; a guide therefore uses the directions from its own place to the
  /// neighbours' origins, not the neighbours' directions. One in `stride_of_importance` has a record, because
  /// importance is sparser than photons.
  static GuidePhotons build(std::span<const Importance> importance, const Wavelengths& w);

  /// The guidance at a vertex, on the side of `wi`; none if no record of its surface is near. The guide draws half of
  /// the directions of wide lobes, and fewer of narrow lobes, which the closure samples better.
  Guidance find(const SurfaceVertex& vertex) const;

  std::size_t size() const { return guides_.size(); }
  std::size_t memory_bytes() const {
    return index_.memory_bytes() + size() * (sizeof(Record) + sizeof(DirectionGuide) + DirectionGuide::table_bytes());
  }

 private:
  struct Record {
    Normal normal{0};  ///< on the illuminated side
    float reach = 0;   ///< distance of the farthest of its photons, m
  };
  class Builder;
  struct Source;
  static GuidePhotons build(std::vector<Source> sources, const Wavelengths& w, std::size_t of);

  BucketKdTree index_;
  std::vector<Record> records_;  ///< by slot; separate from the guides, which are large, because a search reads many
  std::vector<DirectionGuide> guides_;
};

/// Where light paths start, and in which directions surfaces scatter them.
struct LightGuide {
  EmissionGuide emission;
  GuidePhotons directions{};  ///< guides by importance; empty: the closures alone decide
};

/// A visitor of light walks whose next directions are guided.
template <class Visitor>
struct GuidedVisitor : Visitor {
  const GuidePhotons& directions;

  using Visitor::operator();
  GuidedContinuation operator()(const SurfaceVertex& vertex) {
    return {Visitor::operator()(vertex), directions.find(vertex)};
  }
};

/// Calls `follow` with the visitor, or with a guided one if there are directions.
template <class Visitor, class Follow>
void with_directions(const LightGuide* guide, const Visitor& visitor, Follow&& follow) {
  if (guide != nullptr && guide->directions.size() > 0)
    follow(GuidedVisitor<Visitor>{visitor, guide->directions});
  else
    follow(visitor);
}

}  // namespace lanthorn
