// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "index/ball_bvh.h"

#include <memory>

#include "base/parallel.h"

namespace lanthorn {

namespace {

constexpr std::size_t balls_per_chunk = 1u << 15;

// The box of a ball, enlarged by more than the rounding errors of the box and of the distance.
Bounds box_of(const Ball& ball) {
  const Vec3 reach = Vec3(safe_reach(ball.radius)) + 0x1p-22f * glm::abs(ball.centre);
  return {ball.centre - reach, ball.centre + reach};
}

}  // namespace

BallBvh::Node::Node(std::span<const Bounds> children) {
  for (std::uint32_t lane = 0; lane < children.size(); ++lane) {
    low.set(lane, children[lane].min);
    high.set(lane, children[lane].max);
  }
}

template <class BallOf>
IndexBuild<BallBvh> BallBvh::build_from(std::size_t count, BallOf&& ball_of) {
  const auto items = std::make_unique_for_overwrite<LeafPoint[]>(count);
  parallel_chunks(count, balls_per_chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Point p = ball_of(i).centre;
      items[i] = {{p.x, p.y, p.z}, static_cast<std::uint32_t>(i)};
    }
  });
  sort_into_leaves(std::span(items.get(), count));

  std::vector<std::uint32_t> order(count);
  std::vector<Leaf> leaves((count + Lanes::width - 1) / Lanes::width);
  std::vector<Bounds> boxes(leaves.size());
  parallel_chunks(count, balls_per_chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const Ball ball = ball_of(items[slot].number);
      Leaf& leaf = leaves[slot / Lanes::width];
      leaf.centre.set(slot % Lanes::width, ball.centre);
      leaf.radius[slot % Lanes::width] = ball.radius;
      boxes[slot / Lanes::width].extend(box_of(ball));
      order[slot] = items[slot].number;
    }
  });
  BallBvh index;
  index.tree_ = {count, std::move(leaves), std::move(boxes)};
  return {std::move(index), std::move(order)};
}

IndexBuild<BallBvh> BallBvh::build(std::span<const Ball> balls) {
  return build_from(balls.size(), [balls](std::size_t i) { return balls[i]; });
}

IndexBuild<BallBvh> BallBvh::build(std::span<const Point> centres, float radius) {
  return build_from(centres.size(), [centres, radius](std::size_t i) { return Ball{centres[i], radius}; });
}

}  // namespace lanthorn
