// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/light_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "base/parallel.h"

namespace lanthorn {

namespace {

std::vector<double> relevant_powers(std::span<const Light> lights, const EmissionGuide* guide) {
  if (guide && guide->lights.size() != lights.size())
    throw std::invalid_argument("an emission guide is used with a scene that has another number of lights");
  std::vector<double> powers;
  powers.reserve(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const double relevance = guide ? static_cast<double>(guide->lights[i].relevance) : 1.0;
    powers.push_back(relevance * std::fmax(0.0, static_cast<double>(power(lights[i]))));
  }
  return powers;
}

}  // namespace

std::vector<float> emission_probabilities(std::span<const Light> lights, const EmissionGuide* guide) {
  const std::vector<double> powers = relevant_powers(lights, guide);
  const double total = std::accumulate(powers.begin(), powers.end(), 0.0);
  std::vector<float> result;
  result.reserve(powers.size());
  for (const double power : powers) result.push_back(total > 0 ? static_cast<float>(power / total) : 0.0f);
  return result;
}

PhotonAllocation::PhotonAllocation(std::span<const Light> lights, std::uint64_t photons, float offset,
                                   const EmissionGuide* guide) {
  const std::vector<double> powers = relevant_powers(lights, guide);
  const double total_power = std::accumulate(powers.begin(), powers.end(), 0.0);
  if (!(total_power > 0)) return;
  double running = 0;
  std::size_t last = lights.size() - 1;
  while (powers[last] == 0) --last;
  for (std::size_t i = 0; i <= last; ++i) {
    running += powers[i];
    // The last light takes the remainder, so that rounding loses no photon.
    const double place = std::floor(running / total_power * static_cast<double>(photons) + static_cast<double>(offset));
    const std::uint64_t end = i == last ? photons : std::min(photons, static_cast<std::uint64_t>(place));
    if (end == total_) continue;
    const double expected = static_cast<double>(photons) * (powers[i] / total_power);
    shares_.push_back({static_cast<std::uint32_t>(i), total_, end - total_, static_cast<float>(1 / expected)});
    total_ = end;
  }
}

namespace {

struct Angle {
  float cos = 1, sin = 0;
};
/// max(0, a - b) for angles in [0, pi].
Angle excess(const Angle& a, const Angle& b) {
  if (a.cos >= b.cos) return {};
  return {a.cos * b.cos + a.sin * b.sin, a.sin * b.cos - a.cos * b.sin};
}
Angle angle_of(float cos) { return {cos, safe_sqrt(1 - cos * cos)}; }

/// Conty Estevez & Kulla 2018, eq. 3, with a bounding sphere: an estimate of the irradiance that could reach p, W/m²,
/// ignoring visibility. 0 only if no light can reach p: angles have some slack against rounding.
float importance(const LightBounds& light, const Point& p, const Normal& normal) {
  constexpr float play = 1e-4f;
  const Vec3 d = p - light.centre;
  const float distance2 = length_squared(d), radius2 = light.radius * light.radius;
  if (distance2 <= radius2 || distance2 == 0) return light.intensity / std::max(1e-30f, radius2);
  const float inverse_distance = 1 / std::sqrt(distance2);
  const Direction towards_p = d * inverse_distance;
  const float sin_sphere = light.radius * inverse_distance;
  const Angle sphere{safe_sqrt(1 - sin_sphere * sin_sphere), sin_sphere};

  const float cos_axis = dot(light.axis, towards_p);
  const Angle axis = angle_of(light.two_sided ? std::fabs(cos_axis) : cos_axis);
  const Angle emitted = excess(excess(axis, {light.cos_normals, light.sin_normals}), sphere);
  if (emitted.cos < light.cos_emission - play) return 0;
  float result = light.intensity * std::max(play, emitted.cos) * sqr(inverse_distance);
  if (normal != Normal(0)) {
    // Both sides count: the surface may transmit.
    result *= std::max(play, excess(angle_of(std::fabs(dot(normal, towards_p))), sphere).cos);
  }
  return result;
}

/// A cone that contains both cones (given by axis and cosine of the half angle), as tight as possible.
NormalCone unite(NormalCone a, NormalCone b) {
  if (a.cos > b.cos) std::swap(a, b);
  if (a.cos <= -1) return a;
  // Usually cone b lies inside cone a. This test detects that without trigonometry, except in borderline cases.
  constexpr float play = 1e-5f;
  if (dot(a.axis, b.axis) > excess(angle_of(a.cos), angle_of(b.cos)).cos + play) return a;
  const float angle_a = std::acos(std::clamp(a.cos, -1.0f, 1.0f)), angle_b = std::acos(std::clamp(b.cos, -1.0f, 1.0f));
  const float between =
      2 * std::atan2(std::sqrt(distance_squared(a.axis, b.axis)), std::sqrt(length_squared(a.axis + b.axis)));
  if (between + angle_b <= angle_a) return a;
  const float angle = 0.5f * (angle_a + between + angle_b);
  const Vec3 sideways = b.axis - dot(a.axis, b.axis) * a.axis;
  const float length = std::sqrt(length_squared(sideways));
  if (angle >= pi || !(length > 0)) return {a.axis, -1};
  const float turn = angle - angle_a;
  return {normalize(std::cos(turn) * a.axis + (std::sin(turn) / length) * sideways), std::cos(angle)};
}

/// A light or a group of lights, as the builder sees it.
struct Group : EmissionBounds {
  bool empty = true;

  void add(const Group& g) {
    if (g.empty) return;
    cone = empty ? g.cone : unite(cone, g.cone);
    cos_emission = empty ? g.cos_emission : std::fmin(cos_emission, g.cos_emission);
    box.extend(g.box);
    intensity += g.intensity;
    two_sided = two_sided || g.two_sided;
    empty = false;
  }
};

/// Surface area orientation heuristic (Conty Estevez & Kulla 2018, §4.1): power times solid angle of emission times
/// extent. The extent is the squared diagonal, because boxes around point lights may have no surface area.
float cost(const Group& g, float regularity) {
  if (g.empty) return 0;
  const float normals = std::acos(std::clamp(g.cone.cos, -1.0f, 1.0f));
  const float emission = std::acos(std::clamp(g.cos_emission, -1.0f, 1.0f));
  const float reach = std::fmin(normals + emission, pi);
  const float sin = std::sin(normals), cos = std::cos(normals);
  const float solid_angle =
      2 * pi * (1 - cos) + 0.5f * pi * (2 * reach * sin - std::cos(normals - 2 * reach) - 2 * normals * sin + cos);
  return g.intensity * solid_angle * regularity * length_squared(g.box.extent());
}

LightBounds bounds_of(const Group& g) {
  return {.centre = g.box.centre(),
          // Slightly larger than the box's half diagonal, which rounding may make too small.
          .radius = 0.5f * std::sqrt(length_squared(g.box.extent())) * 1.0001f,
          .axis = g.cone.axis,
          .cos_normals = g.cone.cos,
          .sin_normals = angle_of(g.cone.cos).sin,
          .cos_emission = g.cos_emission,
          .intensity = g.intensity,
          .two_sided = g.two_sided};
}

}  // namespace

struct LightBvh::Builder {
  struct Leaf {
    Group group;
    std::uint32_t light;
  };
  /// A split after `bucket`.
  struct Choice {
    float cost = infinity;
    int axis = 0;
    std::size_t bucket = 0;
  };
  static constexpr std::size_t buckets = 12;
  static constexpr std::size_t most_weighed =
      1024;  ///< most leaves of a node that decide on its split; equally spaced ones are taken

  LightBvh& bvh;
  std::vector<Leaf> leaves;

  /// Builds the subtree of [begin, end) into the 2 (end - begin) - 1 nodes from `node` on. Returns the union of its
  /// lights.
  Group build(std::size_t begin, std::size_t end, std::size_t node, std::uint64_t turns, unsigned depth) {
    if (end - begin == 1) {
      const Leaf& leaf = leaves[begin];
      bvh.nodes_[node] = {bounds_of(leaf.group), leaf.light, true};
      bvh.places_[leaf.light] = {turns, Place::Kind::bounded};
      return leaf.group;
    }
    const std::size_t middle = split(begin, end, depth);
    const std::size_t second = node + 2 * (middle - begin);
    Group all, rest;
    const auto build_first = [&] { all = build(begin, middle, node + 1, turns, depth + 1); };
    const auto build_rest = [&] { rest = build(middle, end, second, turns | (std::uint64_t{1} << depth), depth + 1); };
    if (end - begin > most_weighed) {
      parallel_invoke(build_first, build_rest);
    } else {
      build_first();
      build_rest();
    }
    all.add(rest);
    bvh.nodes_[node] = {bounds_of(all), static_cast<std::uint32_t>(second), false};
    return all;
  }

  /// Reorders [begin, end) and returns the start of its second part.
  std::size_t split(std::size_t begin, std::size_t end, unsigned depth) {
    Bounds centres, box;
    for (std::size_t i = begin; i < end; ++i) {
      centres.extend(leaves[i].group.box.centre());
      box.extend(leaves[i].group.box);
    }
    if (end - begin == 2) return begin + 1;
    const Vec3 extent = centres.extent(), size = box.extent();
    Choice best;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(extent[axis] > 0)) continue;
      const Choice choice = best_along(axis, begin, end, centres, max_component(size) / size[axis]);
      if (choice.cost < best.cost) best = choice;
    }
    // From depth 32 on, splits in halves, so that the path from the root fits into 64 bits.
    if (depth < 32 && best.cost < infinity) {
      const auto first = leaves.begin() + static_cast<std::ptrdiff_t>(begin);
      const auto last = leaves.begin() + static_cast<std::ptrdiff_t>(end);
      const auto middle = std::stable_partition(
          first, last, [&](const Leaf& leaf) { return bucket(leaf, centres, best.axis) <= best.bucket; });
      if (middle != first && middle != last) return static_cast<std::size_t>(middle - leaves.begin());
    }
    return begin + (end - begin) / 2;
  }

  /// The best split along an axis in which the centres differ.
  Choice best_along(int axis, std::size_t begin, std::size_t end, const Bounds& centres, float regularity) const {
    const std::size_t step = (end - begin + most_weighed - 1) / most_weighed;
    std::array<Group, buckets> groups;
    for (std::size_t i = begin; i < end; i += step) groups[bucket(leaves[i], centres, axis)].add(leaves[i].group);
    std::array<float, buckets> above;  // cost of all buckets from this one on
    Group rest;
    for (std::size_t b = buckets; b-- > 0;) {
      rest.add(groups[b]);
      if (groups[b].empty)
        above[b] = b + 1 < buckets ? above[b + 1] : infinity;
      else
        above[b] = cost(rest, regularity);
    }
    Choice best;
    Group first;
    for (std::size_t b = 0; b + 1 < buckets; ++b) {
      if (groups[b].empty) continue;  // same split as after the previous bucket
      first.add(groups[b]);
      const float split_cost = cost(first, regularity) + above[b + 1];
      if (split_cost < best.cost) best = {split_cost, axis, b};
    }
    return best;
  }

  static std::size_t bucket(const Leaf& leaf, const Bounds& centres, int axis) {
    const float x = (leaf.group.box.centre()[axis] - centres.min[axis]) / centres.extent()[axis];
    return std::min(static_cast<std::size_t>(x * static_cast<float>(buckets)), buckets - 1);
  }
};

LightBvh::LightBvh(std::span<const Light> lights) : places_(lights.size()) {
  Builder builder{*this, {}};
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    if (!(power(lights[i]) > 0)) continue;
    if (const std::optional<EmissionBounds> bounds = emission_bounds(lights[i])) {
      builder.leaves.push_back({{*bounds, false}, index});
    } else {
      infinite_lights_.push_back(index);
      places_[i].kind = Place::Kind::infinite;
    }
  }
  if (builder.leaves.empty()) return;
  nodes_.resize(2 * builder.leaves.size() - 1);
  builder.build(0, builder.leaves.size(), 0, 0, 0);
}

std::uint32_t LightBvh::descend(const Point& p, const Normal& normal, float u, float& pmf) const {
  std::uint32_t at = 0;
  while (!nodes_[at].leaf) {
    const std::uint32_t second = nodes_[at].next;
    const float first_importance = importance(nodes_[at + 1].bounds, p, normal);
    const float second_importance = importance(nodes_[second].bounds, p, normal);
    const float total = first_importance + second_importance;
    if (!(total > 0)) {
      pmf = 0;
      return 0;
    }
    const float first = first_importance / total;
    if (u < first) {
      u = std::min(one_minus_epsilon, u / first);
      pmf *= first;
      at = at + 1;
    } else {
      u = std::min(one_minus_epsilon, (u - first) / (1 - first));
      pmf *= 1 - first;
      at = second;
    }
  }
  return nodes_[at].next;
}

float LightBvh::pmf(const Point& p, const Normal& normal, std::uint32_t light) const {
  const auto choices = static_cast<float>(infinite_lights_.size() + (nodes_.empty() ? 0 : 1));
  const Place& place = places_[light];
  if (place.kind == Place::Kind::never) return 0;
  float pmf = 1 / choices;
  if (place.kind == Place::Kind::infinite) return pmf;
  std::uint64_t turns = place.turns;
  for (std::uint32_t at = 0; !nodes_[at].leaf; turns >>= 1) {
    const std::uint32_t second = nodes_[at].next;
    const float first_importance = importance(nodes_[at + 1].bounds, p, normal);
    const float second_importance = importance(nodes_[second].bounds, p, normal);
    const float total = first_importance + second_importance;
    if (!(total > 0)) return 0;
    const float first = first_importance / total;
    pmf *= (turns & 1) != 0 ? 1 - first : first;
    at = (turns & 1) != 0 ? second : at + 1;
  }
  return pmf;
}

}  // namespace lanthorn
