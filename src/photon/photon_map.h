// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "index/point_index.h"
#include "photon/photon.h"

namespace lanthorn {

/// Photons in the slot order of an index. Immutable; any number of threads may query it.
template <PointIndex Index>
class PhotonMap {
 public:
  /// A stored photon. Accessors decode on each call.
  class Ref {
   public:
    Ref(const PhotonMap& map, std::uint32_t slot) : map_(&map), slot_(slot) {}

    std::uint32_t slot() const { return slot_; }
    Point position() const { return map_->index_.position(slot_); }
    /// Unit, towards the previous vertex of the light path.
    Direction wi() const { return stored().wi(); }
    /// Power times grazing_gain, W.
    Spectrum power() const { return stored().power(map_->mode_) * map_->units_.power; }
    /// Surface normal at the photon. nullopt in spectral mode, whose records do not store it.
    std::optional<Normal> normal() const { return stored().normal(map_->mode_); }
    PhotonFlags flags() const { return stored().flags(map_->mode_); }
    /// At most the length of the light path's last segment, m; at least an eighth of it, except at grazing incidence.
    float flight() const { return stored().flight(map_->mode_) * map_->units_.flight; }

   private:
    const StoredPhoton& stored() const { return map_->photons_[slot_]; }

    const PhotonMap* map_;
    std::uint32_t slot_;
  };

  PhotonMap() = default;

  /// Stores all photons of the chunks, which are in path order. `index_arguments` are passed to `Index::build` after
  /// the positions (for `HashGrid`: the largest query radius). The map does not depend on how the photons are divided
  /// into chunks.
  template <class... IndexArguments>
  static PhotonMap build(std::span<const std::vector<Photon>> chunks, ColorMode mode,
                         IndexArguments&&... index_arguments) {
    const std::vector<Piece> pieces = pieces_of(chunks);
    const std::size_t count = pieces.empty() ? 0 : pieces.back().first + pieces.back().photons.size();
    PhotonMap map;
    map.mode_ = mode;
    map.units_ = units_of(pieces);

    const auto positions = std::make_unique_for_overwrite<Point[]>(count);
    parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
      std::size_t i = pieces[p].first;
      for (const Photon& photon : pieces[p].photons) positions[i++] = photon.position;
    });
    IndexBuild<Index> built =
        Index::build(std::span<const Point>(positions.get(), count), std::forward<IndexArguments>(index_arguments)...);
    map.index_ = std::move(built.index);

    const auto slot_of = std::make_unique_for_overwrite<std::uint32_t[]>(count);
    parallel_chunks(count, piece_size, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t slot = begin; slot < end; ++slot) slot_of[built.order[slot]] = static_cast<std::uint32_t>(slot);
    });
    map.photons_ = std::make_unique_for_overwrite<StoredPhoton[]>(count);
    parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
      std::size_t i = pieces[p].first;
      for (const Photon& photon : pieces[p].photons)
        map.photons_[slot_of[i++]] = StoredPhoton::pack(photon, mode, map.units_);
    });
    return map;
  }
  template <class... IndexArguments>
  static PhotonMap build(const std::vector<Photon>& photons, ColorMode mode, IndexArguments&&... index_arguments) {
    return build(std::span(&photons, 1), mode, std::forward<IndexArguments>(index_arguments)...);
  }

  /// Calls `visit(Ref photon, float dist2)` for every photon with dist2 <= radius², in a fixed order.
  template <class Visit>
  void for_each_near(const Point& p, float radius, Visit&& visit) const {
    index_.for_each_near(p, radius, [&](std::uint32_t slot, float dist2) { visit(Ref(*this, slot), dist2); });
  }

  /// See `NearestIndex`; `(*this)[neighbour.slot]` is the photon.
  std::span<const Neighbour> nearest(const Point& p, float max_radius,
                                     std::span<Neighbour> heap) const requires NearestIndex<Index> {
    return index_.nearest(p, max_radius, heap);
  }

  Ref operator[](std::uint32_t slot) const { return {*this, slot}; }
  std::size_t size() const { return index_.size(); }
  const Index& index() const { return index_; }
  ColorMode mode() const { return mode_; }
  /// Memory of records, positions and the index's tables, bytes.
  std::size_t memory_bytes() const { return index_.memory_bytes() + size() * sizeof(StoredPhoton); }

 private:
  /// Consecutive photons of one chunk. `first` is the number of the first one in path order.
  struct Piece {
    std::size_t first;
    std::span<const Photon> photons;
  };
  static constexpr std::size_t piece_size = 1u << 13;

  static std::vector<Piece> pieces_of(std::span<const std::vector<Photon>> chunks) {
    std::vector<Piece> pieces;
    std::size_t first = 0;
    for (const std::vector<Photon>& chunk : chunks)
      for (std::span<const Photon> rest = chunk; !rest.empty();) {
        pieces.push_back({first, rest.first(std::min(rest.size(), piece_size))});
        first += pieces.back().photons.size();
        rest = rest.subspan(pieces.back().photons.size());
      }
    return pieces;
  }

  static PhotonUnits units_of(const std::vector<Piece>& pieces) {
    std::vector<float> powers(pieces.size()), flights(pieces.size());
    parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) {
      for (const Photon& photon : pieces[p].photons) {
        powers[p] = std::max(powers[p], max_component(photon.gained_power()));
        flights[p] = std::max(flights[p], photon.flight);
      }
    });
    if (pieces.empty()) return {};
    return {power_unit(*std::max_element(powers.begin(), powers.end())),
            flight_unit(*std::max_element(flights.begin(), flights.end()))};
  }

  Index index_;
  ColorMode mode_ = ColorMode::rgb;
  PhotonUnits units_;
  std::unique_ptr<StoredPhoton[]> photons_;
};

}  // namespace lanthorn
