// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "index/beam_bvh.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "index/slot_points.h"
#include "math/frame.h"

namespace lanthorn {

namespace {

constexpr std::size_t beams_per_chunk = 1u << 15;

std::size_t chunks_of(std::size_t beams) { return (beams + beams_per_chunk - 1) / beams_per_chunk; }

// The end of piece `number` - 1 of `count` and the start of piece `number`.
Point cut_point(const Beam& beam, int number, int count) {
  return beam.origin + (beam.length * static_cast<float>(number) / static_cast<float>(count)) * beam.direction;
}

float sum_of(const Vec3& v) { return v.x + v.y + v.z; }

// Around an end of a piece, with room for the rounding of `cut_point`.
Bounds box_around(const Point& p, const Beam& beam) {
  const Vec3 reach(safe_reach(beam.radius) + 0x1p-22f * (sum_of(glm::abs(beam.origin)) + beam.length));
  return {p - reach, p + reach};
}

// Into how many pieces beams are cut: of about the same length, such that twice as many as beams would do if all beams
// were as long. No piece is short against its radius, which would not make its bounds tighter.
std::vector<std::uint16_t> piece_counts(std::span<const Beam> beams) {
  constexpr double pieces_per_beam = 2;
  std::vector<double> sums(chunks_of(beams.size()));
  parallel_chunks(beams.size(), beams_per_chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sums[c] += static_cast<double>(beams[i].length);
  });
  const double length = std::accumulate(sums.begin(), sums.end(), 0.0);
  const auto usual = static_cast<float>(length / (pieces_per_beam * static_cast<double>(beams.size())));
  std::vector<std::uint16_t> counts(beams.size());
  parallel_chunks(beams.size(), beams_per_chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float own = std::max(usual, 4 * beams[i].radius);
      const float count = own > 0 ? std::ceil(beams[i].length / own) : 1.0f;
      counts[i] = static_cast<std::uint16_t>(std::clamp(count, 1.0f, 65535.0f));
    }
  });
  return counts;
}

// Piece `number` of `count` of a beam.
struct Cut {
  std::uint32_t beam;
  std::uint16_t number, count;
};
struct Cuts {
  std::size_t size = 0;
  std::unique_ptr<Cut[]> cuts;
  std::unique_ptr<KeyedItem<6>[]> items;  // start and end of each, and its number among the cuts
};

Cuts cut_up(std::span<const Beam> beams) {
  const std::vector<std::uint16_t> counts = piece_counts(beams);
  std::vector<std::size_t> begins(chunks_of(beams.size()) + 1);  // of the pieces of each chunk of beams
  parallel_chunks(beams.size(), beams_per_chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) begins[c + 1] += counts[i];
  });
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  Cuts all{begins.back(), std::make_unique_for_overwrite<Cut[]>(begins.back()),
           std::make_unique_for_overwrite<KeyedItem<6>[]>(begins.back())};
  parallel_chunks(beams.size(), beams_per_chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    std::size_t at = begins[c];
    for (std::size_t i = begin; i < end; ++i)
      for (std::uint16_t number = 0; number < counts[i]; ++number, ++at) {
        const Point a = cut_point(beams[i], number, counts[i]), b = cut_point(beams[i], number + 1, counts[i]);
        all.cuts[at] = {static_cast<std::uint32_t>(i), number, counts[i]};
        all.items[at] = {{a.x, a.y, a.z, b.x, b.y, b.z}, static_cast<std::uint32_t>(at)};
      }
  });
  return all;
}

}  // namespace

// Enlarged by more than rounding takes from coordinates in the frame of any ray, as far as it depends on the box.
void BeamBvh::StoredBox::set(std::uint32_t lane, const Bounds& box) {
  const Point middle = box.centre();
  const Vec3 extent = glm::max(box.max - middle, middle - box.min);
  centre.set(lane, middle);
  half.set(lane, (1 + 0x1p-20f) * extent + Vec3(0x1p-19f * sum_of(glm::abs(middle)) + 1e-18f));
}

BeamBvh::LaneRay::LaneRay(const RaySegment& ray)
    : origin{ray.origin.x, ray.origin.y, ray.origin.z},
      u{0.0f, 0.0f, 0.0f},
      v{0.0f, 0.0f, 0.0f},
      w{ray.direction.x, ray.direction.y, ray.direction.z},
      begin(ray.begin),
      end(ray.end),
      slack(0x1p-19f * sum_of(glm::abs(ray.origin))) {
  const Frame frame(ray.direction);
  u = {frame.s.x, frame.s.y, frame.s.z};
  v = {frame.t.x, frame.t.y, frame.t.z};
}

IndexBuild<BeamBvh> BeamBvh::build(std::span<const Beam> beams) {
  const Cuts all = cut_up(beams);
  sort_into_leaves(std::span(all.items.get(), all.size));

  // Beams are numbered in the order of their first pieces.
  BeamBvh index;
  std::vector<std::uint32_t> order, slots(beams.size());
  order.reserve(beams.size());
  index.first_pieces_.reserve(beams.size());
  for (std::size_t i = 0; i < all.size; ++i) {
    const Cut& piece = all.cuts[all.items[i].number];
    if (piece.number != 0) continue;
    slots[piece.beam] = static_cast<std::uint32_t>(order.size());
    order.push_back(piece.beam);
    index.first_pieces_.push_back(static_cast<std::uint32_t>(i));
  }

  std::vector<Leaf> leaves((all.size + Lanes::width - 1) / Lanes::width);
  std::vector<Hull> hulls(leaves.size());
  parallel_chunks(all.size, beams_per_chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Cut& piece = all.cuts[all.items[i].number];
      const Beam& beam = beams[piece.beam];
      const auto lane = static_cast<std::uint32_t>(i % Lanes::width);
      Leaf& leaf = leaves[i / Lanes::width];
      leaf.origin.set(lane, beam.origin);
      leaf.direction.set(lane, beam.direction);
      leaf.radius[lane] = beam.radius;
      leaf.length[lane] = beam.length;
      leaf.piece[lane] = {slots[piece.beam], piece.number, piece.count};
      const auto& [ax, ay, az, bx, by, bz] = all.items[i].key;
      hulls[i / Lanes::width].extend({box_around({ax, ay, az}, beam), box_around({bx, by, bz}, beam)});
    }
  });
  index.tree_ = {all.size, std::move(leaves), std::move(hulls)};
  return {std::move(index), std::move(order)};
}

}  // namespace lanthorn
