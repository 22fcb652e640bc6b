// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/guides/guide_photons.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "photon/gather/kernels.h"
#include "photon/gather/photon_gather.h"

namespace lanthorn {

namespace {

Normal lit_side(const Photon& photon) { return dot(photon.wi, photon.normal) < 0 ? -photon.normal : photon.normal; }

}  // namespace

struct GuidePhotons::Source {
  const Photon* photon;
  const Point* origin;  ///< of its last flight; null: unknown, as good as far away

  Direction seen_from(const Point& p) const { return origin != nullptr ? normalize(*origin - p) : photon->wi; }
};

/// The accepted photons and a tree of them, which is needed only during construction.
class GuidePhotons::Builder {
 public:
  Builder(std::vector<Source> sources, const Wavelengths& w) : sources_(std::move(sources)), w_(w) {
    std::vector<Point> positions;
    positions.reserve(sources_.size());
    for (const Source& source : sources_) positions.push_back(source.photon->position);
    tree_ = BucketKdTree::build(positions);
  }

  void make(const Photon& photon, Record& record, DirectionGuide& guide) const {
    std::array<Neighbour, nearest> memory;
    const std::span<const Neighbour> found = tree_.index.nearest(photon.position, infinity, memory);
    record = {lit_side(photon), std::sqrt(found.front().dist2)};
    std::vector<DirectionGuide::Seen> light;
    for (const Neighbour& n : found) {
      const Source& other = sources_[tree_.order[n.slot]];
      if (is_of(*other.photon, record, photon.position))
        light.push_back({other.seen_from(photon.position), brightness(*other.photon)});
    }
    guide = DirectionGuide(record.normal, light);
  }

 private:
  static bool is_of(const Photon& photon, const Record& record, const Point& p) {
    constexpr float least_cosine = 0.5f;
    return is_in_disc(dot(photon.position - p, record.normal), record.reach) &&
           dot(lit_side(photon), record.normal) >= least_cosine;
  }
  float brightness(const Photon& photon) const {
    return sum_of(photon.flags.dispersed ? photon.power * w_.dispersed : photon.power);
  }

  std::vector<Source> sources_;
  IndexBuild<BucketKdTree> tree_;
  const Wavelengths& w_;
};

GuidePhotons GuidePhotons::build(std::span<const std::vector<Photon>> chunks, const Wavelengths& w,
                                 const std::function<bool(const PhotonFlags&)>& accepts) {
  std::vector<Source> sources;
  for (const std::vector<Photon>& chunk : chunks)
    for (const Photon& photon : chunk)
      if (accepts(photon.flags)) sources.push_back({&photon, nullptr});
  return build(std::move(sources), w, stride);
}

GuidePhotons GuidePhotons::build(std::span<const Importance> importance, const Wavelengths& w) {
  std::vector<Source> sources;
  sources.reserve(importance.size());
  for (const Importance& i : importance) sources.push_back({&i.photon, &i.origin});
  return build(std::move(sources), w, stride_of_importance);
}

GuidePhotons GuidePhotons::build(std::vector<Source> sources, const Wavelengths& w, std::size_t of) {
  std::vector<const Photon*> chosen;
  std::vector<Point> positions;
  for (std::size_t i = 0; i < sources.size(); i += of) {
    chosen.push_back(sources[i].photon);
    positions.push_back(sources[i].photon->position);
  }
  const Builder builder(std::move(sources), w);
  IndexBuild<BucketKdTree> built = BucketKdTree::build(positions);
  GuidePhotons result;
  result.index_ = std::move(built.index);
  result.records_.resize(chosen.size());
  result.guides_.resize(chosen.size());
  // In the order of the slots, so that consecutive queries read the same parts of the tree.
  constexpr std::size_t chunk_records = 64;
  parallel_chunks(chosen.size(), chunk_records, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot)
      builder.make(*chosen[built.order[slot]], result.records_[slot], result.guides_[slot]);
  });
  return result;
}

Guidance GuidePhotons::find(const SurfaceVertex& vertex) const {
  constexpr float largest_share = 0.5f;
  constexpr float least_cosine = 0.8f;
  const float share = largest_share * wide_share(vertex);
  if (!(share > 0)) return {};
  const Point& p = vertex.at.position;
  const Normal normal = dot(vertex.wi, vertex.at.normal) < 0 ? -vertex.at.normal : vertex.at.normal;
  const SlotRange near = index_.leaf_around(p);
  std::optional<Neighbour> best;
  for (std::uint32_t slot = near.begin; slot < near.end; ++slot) {
    const Record& record = records_[slot];
    const Vec3 offset = index_.position(slot) - p;
    const Neighbour candidate{length_squared(offset), slot};
    if (best && !(candidate < *best)) continue;
    if (dot(record.normal, normal) < least_cosine) continue;
    if (is_in_disc(dot(offset, normal), record.reach)) best = candidate;
  }
  return best ? Guidance{&guides_[best->slot], share} : Guidance{};
}

}  // namespace lanthorn
