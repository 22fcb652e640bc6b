// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/media/volume_map.h"

#include <cmath>
#include <type_traits>

#include "base/parallel.h"

namespace lanthorn {

namespace {

template <class Index>
IndexBuild<Index> index_of(std::span<const MediumPhoton* const> photons, float radius) {
  using Item = std::conditional_t<std::is_same_v<Index, BallBvh>, Ball, Beam>;
  std::vector<Item> items(photons.size());
  parallel_chunks(photons.size(), 1u << 13, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if constexpr (std::is_same_v<Index, BallBvh>)
        items[i] = {photons[i]->photon.position, radius};
      else
        items[i] = photons[i]->beam(radius);
  });
  return Index::build(items);
}

// Photons by medium, in path order.
using Photons = std::vector<const MediumPhoton*>;
std::vector<Photons> by_medium(std::span<const std::vector<MediumPhoton>> chunks) {
  std::vector<Photons> media;
  for (const std::vector<MediumPhoton>& chunk : chunks)
    for (const MediumPhoton& photon : chunk) {
      const auto i = static_cast<std::size_t>(photon.medium);
      if (i >= media.size()) media.resize(i + 1);
      media[i].push_back(&photon);
    }
  return media;
}

template <class Map>
std::vector<std::unique_ptr<Map>> maps_of(const std::vector<Photons>& media, ColorMode mode, float radius) {
  std::vector<std::unique_ptr<Map>> maps(media.size());
  for (std::size_t i = 0; i < media.size(); ++i)
    if (!media[i].empty()) maps[i] = std::make_unique<Map>(media[i], mode, radius);
  return maps;
}

template <class Map>
std::size_t bytes_of(const std::vector<std::unique_ptr<Map>>& maps) {
  std::size_t bytes = 0;
  for (const std::unique_ptr<Map>& map : maps) bytes += map ? map->memory_bytes() : 0;
  return bytes;
}

}  // namespace

template <class Index>
MediumPhotonMap<Index>::MediumPhotonMap(std::span<const MediumPhoton* const> photons, ColorMode mode, float radius)
    : mode_(mode) {
  float largest = 0;
  for (const MediumPhoton* p : photons) largest = std::fmax(largest, max_component(p->photon.power));
  power_unit_ = power_unit(largest);
  IndexBuild<Index> built = index_of<Index>(photons, radius);
  index_ = std::move(built.index);
  records_ = std::make_unique_for_overwrite<StoredPhoton[]>(photons.size());
  parallel_chunks(photons.size(), 1u << 13, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot)
      records_[slot] = StoredPhoton::pack(photons[built.order[slot]]->photon, mode, {.power = power_unit_});
  });
}

template class MediumPhotonMap<BallBvh>;
template class MediumPhotonMap<BeamBvh>;

VolumeMap::VolumeMap(std::span<const std::vector<MediumPhoton>> chunks, MediumRecords records, ColorMode mode,
                     float radius) {
  const std::vector<Photons> media = by_medium(chunks);
  if (records == MediumRecords::points)
    points_ = maps_of<Points>(media, mode, radius);
  else
    beams_ = maps_of<Beams>(media, mode, radius);
}

std::size_t VolumeMap::memory_bytes() const { return bytes_of(points_) + bytes_of(beams_); }

}  // namespace lanthorn
