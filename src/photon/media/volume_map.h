// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The photons of a pass in participating media.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "index/ball_bvh.h"
#include "index/beam_bvh.h"
#include "photon/photon_pass.h"

namespace lanthorn {

/// Records of the photons or beams in one medium, in the slot order of their index.
template <class Index>
class MediumPhotonMap {
 public:
  /// The index finds them within `radius` (m).
  MediumPhotonMap(std::span<const MediumPhoton* const> photons, ColorMode mode, float radius);

  const Index& index() const { return index_; }
  /// W.
  Spectrum power(std::uint32_t slot) const { return records_[slot].power(mode_) * power_unit_; }
  /// Towards the previous vertex of the light path.
  Direction wi(std::uint32_t slot) const { return records_[slot].wi(); }
  PhotonFlags flags(std::uint32_t slot) const { return records_[slot].flags(mode_); }
  std::size_t memory_bytes() const { return index_.memory_bytes() + index_.size() * sizeof(StoredPhoton); }

 private:
  Index index_;
  ColorMode mode_;
  float power_unit_;  ///< W
  std::unique_ptr<StoredPhoton[]> records_;
};

/// The photons of a pass in media, as points or as beams: one map for each medium, so that no light leaks from one
/// medium into another.
class VolumeMap {
 public:
  using Points = MediumPhotonMap<BallBvh>;
  using Beams = MediumPhotonMap<BeamBvh>;

  VolumeMap() = default;
  /// The chunks are in path order. The map does not depend on the division into chunks.
  VolumeMap(std::span<const std::vector<MediumPhoton>> chunks, MediumRecords records, ColorMode mode, float radius);

  /// Null if there are none in this medium.
  const Points* points(MediumId medium) const { return in(points_, medium); }
  const Beams* beams(MediumId medium) const { return in(beams_, medium); }
  std::size_t memory_bytes() const;

 private:
  template <class Map>
  static const Map* in(const std::vector<std::unique_ptr<Map>>& maps, MediumId medium) {
    const auto i = static_cast<std::size_t>(medium);
    return i < maps.size() ? maps[i].get() : nullptr;
  }

  // By medium; null for media without photons.
  std::vector<std::unique_ptr<Points>> points_;
  std::vector<std::unique_ptr<Beams>> beams_;
};

}  // namespace lanthorn
