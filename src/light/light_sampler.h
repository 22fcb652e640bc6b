// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light/light.h"

namespace lanthorn {

struct SampledLight {
  std::uint32_t light = 0;  ///< index into the lights the sampler was built from
  float pmf = 0;            ///< probability of having chosen it
};

/// Shares N photons among the lights in proportion to their power, by systematic sampling: the number of photons of a
/// light has mean N p_l and differs from it by less than one, and photon k of light l is the same photon whatever other
/// lights there are.
class PhotonAllocation {
 public:
  struct Share {
    std::uint32_t light = 0;
    std::uint64_t begin = 0;  ///< first photon of this light in the pass's order
    std::uint64_t count = 0;
    float weight = 0;         ///< factor of every photon's flux: 1 / (N p_l)
  };
  /// `offset` in [0,1): one random number per pass.
  PhotonAllocation(std::span<const Light> lights, std::uint64_t photons, float offset);
  std::span<const Share> shares() const { return shares_; }
  std::uint64_t total() const { return total_; }

 private:
  std::vector<Share> shares_;
  std::uint64_t total_ = 0;
};

/// Chooses lights for next-event estimation: a light BVH over bounded lights with orientation cones (Conty Estevez &
/// Kulla 2018); infinite and distant lights are chosen uniformly beside it.
class LightBvh {
 public:
  LightBvh() = default;
  explicit LightBvh(std::span<const Light> lights);

  /// `normal` is the shading normal of the receiving surface, or zero where there is none. Empty if no light can
  /// contribute.
  std::optional<SampledLight> sample(const Point& p, const Normal& normal, float u) const;
  /// Probability with which `sample` chooses `light` at this point.
  float pmf(const Point& p, const Normal& normal, std::uint32_t light) const;

 private:
  struct Node;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> infinite_lights_;
  std::vector<std::uint32_t> path_to_light_;  ///< per light, the turns from the root as bits
};

}  // namespace lanthorn
