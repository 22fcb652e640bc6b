// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light/emission_guide.h"
#include "light/light.h"

namespace lanthorn {

struct SampledLight {
  std::uint32_t light = 0;  ///< index into the lights the sampler was built from
  float pmf = 0;            ///< probability of having chosen it
};

/// Shares N photons among the lights in proportion to their power, or to power times relevance, by systematic sampling:
/// the number of photons of a light has mean N p_l and differs from it by less than one, and photon k of light l is the
/// same photon whatever other lights there are.
class PhotonAllocation {
 public:
  struct Share {
    std::uint32_t light = 0;
    std::uint64_t begin = 0;  ///< first photon of this light in the pass's order
    std::uint64_t count = 0;
    float weight = 0;  ///< factor of every photon's flux: 1 / (N p_l)
  };
  /// `offset` in [0,1): one random number per pass. `guide`: with the relevance of each light; may be null.
  PhotonAllocation(std::span<const Light> lights, std::uint64_t photons, float offset,
                   const EmissionGuide* guide = nullptr);
  std::span<const Share> shares() const { return shares_; }
  std::uint64_t total() const { return total_; }

 private:
  std::vector<Share> shares_;
  std::uint64_t total_ = 0;
};

/// What a light or a group of lights could send to a point: bounds of place, orientation and strength.
struct LightBounds {
  Point centre{0};
  float radius = 0;         ///< metres: of a sphere around all of it
  Direction axis{0, 0, 1};  ///< of the cone of emission normals
  float cos_normals = 1;    ///< half angle of that cone
  float sin_normals = 0;
  float cos_emission = 0;  ///< half angle of the emission around each normal
  float intensity = 0;     ///< W/sr, luminance, towards the front
  bool two_sided = false;
};

/// Chooses lights for next-event estimation: a light BVH over bounded lights with orientation cones (Conty Estevez &
/// Kulla 2018); infinite and distant lights are chosen uniformly beside it, each as probable as the whole tree.
class LightBvh {
 public:
  LightBvh() = default;
  explicit LightBvh(std::span<const Light> lights);

  /// `normal` is the shading normal of the receiving surface, or zero where there is none. Empty if no light of the
  /// group that was chosen can contribute; the probabilities of all lights then sum to less than 1.
  std::optional<SampledLight> sample(const Point& p, const Normal& normal, float u) const;
  /// Probability with which `sample` chooses `light` at this point.
  float pmf(const Point& p, const Normal& normal, std::uint32_t light) const;

 private:
  struct Node {
    LightBounds bounds;
    std::uint32_t next = 0;  ///< inner node: index of its second child (the first follows it); leaf: the light
    bool leaf = false;
  };
  /// Where a light is chosen.
  struct Place {
    enum class Kind : std::uint8_t { never, infinite, bounded };
    std::uint64_t turns = 0;  ///< from the root, lowest bit first: 1 is the second child
    Kind kind = Kind::never;
  };
  struct Builder;

  std::optional<SampledLight> sample_bounded(const Point& p, const Normal& normal, float u, float pmf) const;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> infinite_lights_;
  std::vector<Place> places_;  ///< per light
};

}  // namespace lanthorn
