// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light/emission_guide.h"
#include "light/light.h"
#include "math/vec.h"

namespace lanthorn {

struct SampledLight {
  std::uint32_t light = 0;  ///< index into the lights the sampler was built from
  float pmf = 0;            ///< probability of having chosen it
};

/// Probability with which a photon starts on each light: proportional to its power, or to power times relevance.
/// `guide`: relevance of each light; may be null. All 0 if no light has power. Throws std::invalid_argument if the
/// guide is for another number of lights.
std::vector<float> emission_probabilities(std::span<const Light> lights, const EmissionGuide* guide = nullptr);

/// Distributes N photons among the lights with these probabilities, by systematic sampling. The number of photons of
/// light l has mean N p_l and differs from it by less than one. Photon k of light l is the same photon whatever other
/// lights exist.
class PhotonAllocation {
 public:
  struct Share {
    std::uint32_t light = 0;
    std::uint64_t begin = 0;  ///< first photon of this light in the pass's order
    std::uint64_t count = 0;
    float weight = 0;  ///< factor of every photon's flux: 1 / (N p_l)
  };
  /// `offset` in [0,1): one random number per pass. `guide`: as for `emission_probabilities`.
  PhotonAllocation(std::span<const Light> lights, std::uint64_t photons, float offset,
                   const EmissionGuide* guide = nullptr);
  std::span<const Share> shares() const { return shares_; }
  std::uint64_t total() const { return total_; }

 private:
  std::vector<Share> shares_;
  std::uint64_t total_ = 0;
};

/// Bounds of the position, orientation and strength of a light or a group of lights.
struct LightBounds {
  Point centre{0};
  float radius = 0;         ///< metres: radius of a sphere around the light or group
  Direction axis{0, 0, 1};  ///< axis of the cone of emission normals
  float cos_normals = 1;    ///< cosine of the half angle of that cone
  float sin_normals = 0;
  float cos_emission = 0;  ///< cosine of the half angle of emission around each normal
  float intensity = 0;     ///< W/sr, luminance, towards the front
  bool two_sided = false;
};

/// Selects lights for next-event estimation: a light BVH with orientation cones over the bounded lights (Conty Estevez
/// & Kulla 2018). Infinite and distant lights are chosen uniformly beside it; each has the same probability as the
/// whole tree.
class LightBvh {
 public:
  LightBvh() = default;
  explicit LightBvh(std::span<const Light> lights);

  /// `normal` is the shading normal of the receiving surface, or zero if there is none. Returns nullopt if no light of
  /// the chosen group can contribute; the probabilities of all lights then sum to less than 1.
  std::optional<SampledLight> sample(const Point& p, const Normal& normal, float u) const;
  /// Probability that `sample` chooses `light` at this point.
  float pmf(const Point& p, const Normal& normal, std::uint32_t light) const;

 private:
  struct Node {
    LightBounds bounds;
    std::uint32_t next = 0;  ///< inner node: index of its second child (the first follows it); leaf: the light
    bool leaf = false;
  };
  /// Position of a light in the tree.
  struct Place {
    enum class Kind : std::uint8_t { never, infinite, bounded };
    std::uint64_t turns = 0;  ///< path from the root, lowest bit first: 1 is the second child
    Kind kind = Kind::never;
  };
  struct Builder;

  /// Chooses among the bounded lights and multiplies `pmf` by the probability of the choice, which is 0 if none can
  /// contribute. Precondition: there are some.
  std::uint32_t descend(const Point& p, const Normal& normal, float u, float& pmf) const;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> infinite_lights_;
  std::vector<Place> places_;  ///< per light
};

// Inline: a result of this size is returned through memory, which costs more than choosing among few lights.
inline std::optional<SampledLight> LightBvh::sample(const Point& p, const Normal& normal, float u) const {
  const auto choices = static_cast<float>(infinite_lights_.size() + (nodes_.empty() ? 0 : 1));
  if (choices == 0) return {};
  const float scaled = u * choices;
  const auto choice = static_cast<std::size_t>(scaled);
  if (choice < infinite_lights_.size()) return SampledLight{infinite_lights_[choice], 1 / choices};
  if (nodes_.empty()) return SampledLight{infinite_lights_.back(), 1 / choices};  // u * choices rounded up
  float pmf = 1 / choices;
  const std::uint32_t light = descend(p, normal, std::min(one_minus_epsilon, scaled - std::floor(scaled)), pmf);
  return pmf > 0 ? std::optional(SampledLight{light, pmf}) : std::nullopt;
}

}  // namespace lanthorn
