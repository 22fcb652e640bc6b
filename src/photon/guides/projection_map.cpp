// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/guides/projection_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "index/bucket_kdtree.h"

namespace lanthorn {

namespace {

using Numbers = TreeDistribution::Numbers;
using Cell = TreeDistribution::Cell;

// Share of the photons that start in cells without a target in their way.
constexpr float uniform_share = 1.0f / 16;
// Largest number of cells with a target in their way, for all lights together and for one light.
constexpr double cells_of_scene = 32768, cells_of_light = 4096;
// Each cell has a list of the balls that it may meet. Memory holds the lists of one level of the subdivision together
// with the lists of the next level, which are at most twice as long. Bounds on the number of balls, and on the list
// entries of a level for each cell that a light may have, keep the lists of a light below 200 MB.
constexpr std::size_t most_balls = 1 << 18, entries_per_cell = 4096;

/// A bound of a cell's photons: origins in a sphere, directions within an angle of an axis.
struct EmittedBeam {
  Point origin{0};
  float radius = 0;
  Direction axis{0, 0, 1};
  float cos = -1, sin = 0;  ///< of the angle
};

float angle_between(const Direction& a, const Direction& b) { return std::acos(std::clamp(dot(a, b), -1.0f, 1.0f)); }

bool may_meet(const EmittedBeam& beam, const Ball& ball) {
  const Vec3 to_ball = ball.centre - beam.origin;
  const float distance = std::sqrt(length_squared(to_ball)), reach = beam.radius + ball.radius;
  if (distance <= reach) return true;
  // The angle between axis and ball centre is compared with the sum of the beam's angle and the ball's angular radius.
  const float sin_ball = reach / distance;
  if (beam.cos < 0 && sin_ball >= beam.sin) return true;
  const float cos_both = beam.cos * std::sqrt(1 - sin_ball * sin_ball) - beam.sin * sin_ball;
  return dot(beam.axis, to_ball) >= distance * cos_both;
}

/// The targets of the photons.
struct Targets {
  std::vector<Ball> balls;
  std::vector<float> weights;  ///< of each ball; if empty, the photons that can hit a ball are distributed evenly
};

// Subdivides the emission numbers of one light, level by level, where its photons can hit one of the targets.
class LightSubdivision {
 public:
  LightSubdivision(const Light& light, const Targets& targets, const std::optional<AimedDisks>& disks, float scene_size)
      : light_(light),
        targets_(targets.balls),
        weights_(targets.weights),
        disks_(disks ? &*disks : nullptr),
        scene_size_(scene_size) {}

  /// The result's `relevance` is the share of the light's photons that can hit a target.
  EmissionGuide::OfLight build(std::size_t most_cells) {
    std::vector<std::uint32_t> all(targets_.size());
    std::iota(all.begin(), all.end(), 0u);
    std::vector<Open> level;
    open(Cell{}, met_by(Cell{}, all), level);
    while (!level.empty() && level.size() <= most_cells && entries(level) <= entries_per_cell * most_cells)
      level = halve(level);
    EmissionGuide::OfLight result{.numbers = {}, .relevance = 0};
    for (const Open& o : level) result.relevance += nodes_[o.node].cell.volume();
    distribute(level);
    settle(0);
    if (nodes_[0].mass > 0) add(0, result.numbers);
    return result;
  }

 private:
  struct Node {
    Cell cell;
    std::uint32_t axis = 0;
    std::uint32_t lower = 0;  ///< number of the first child, the second follows it; 0: no children
    float mass = 0;           ///< share of the photons, up to a factor
  };
  /// A node that can still be halved.
  struct Open {
    std::uint32_t node = 0;
    std::vector<std::uint32_t> near;  ///< targets that its photons can hit
  };
  static std::size_t entries(const std::vector<Open>& level) {
    return std::accumulate(level.begin(), level.end(), std::size_t{0},
                           [](std::size_t sum, const Open& o) { return sum + o.near.size(); });
  }
  struct Probe {
    Point origin{0};
    Direction direction{0, 0, 1};
  };
  std::optional<Probe> probe(const Cell& cell, const Numbers& t) const {
    const Numbers u = cell.at(t);
    const auto s = sample_emission(light_, disks_, u, any_);
    if (!s) return {};
    return Probe{s->origin, s->direction};
  }

  // Samples all corners, the middle and points inside. Empty if some of them give no photon, so that no bound is known.
  std::optional<EmittedBeam> beam_of(const Cell& cell) const {
    constexpr unsigned corners = 16, inner = 8;
    std::array<Probe, corners + inner + 1> probes;
    for (unsigned i = 0; i < probes.size(); ++i) {
      Numbers t{0.5f, 0.5f, 0.5f, 0.5f};
      for (unsigned axis = 0; axis < 4 && i < corners + inner; ++axis)
        t[axis] = i < corners ? static_cast<float>(i >> axis & 1) : unit_float(hash_words({i, axis}));
      const std::optional<Probe> p = probe(cell, t);
      if (!p) return {};
      probes[i] = *p;
    }
    // Photons between the samples may lie slightly outside of their bound.
    constexpr float slack = 1.25f;
    Vec3 sum(0);
    Bounds origins;
    for (const Probe& p : probes) {
      sum += p.direction;
      origins.extend(p.origin);
    }
    EmittedBeam beam;
    beam.origin = origins.centre();
    const float length = std::sqrt(length_squared(sum));
    if (length < 0.5f * static_cast<float>(probes.size())) return beam;  // all directions
    beam.axis = sum / length;
    float angle = 0;
    for (const Probe& p : probes) {
      beam.radius = std::max(beam.radius, slack * std::sqrt(distance_squared(p.origin, beam.origin)));
      angle = std::max(angle, std::min(pi, slack * angle_between(beam.axis, p.direction)));
    }
    beam.cos = std::cos(angle);
    beam.sin = std::sin(angle);
    return beam;
  }

  // The axis along which the end points of the cell's photons differ most.
  std::uint32_t widest_axis(const Cell& cell) const {
    std::uint32_t best = 0;
    float most = -1;
    for (std::uint32_t axis = 0; axis < 4; ++axis) {
      float spread = 0;
      for (const float other : {0.25f, 0.75f}) {
        Numbers low{other, other, other, other}, high = low;
        low[axis] = 0.05f;
        high[axis] = 0.95f;
        const std::optional<Probe> a = probe(cell, low), b = probe(cell, high);
        if (!a || !b) continue;
        spread +=
            scene_size_ * angle_between(a->direction, b->direction) + std::sqrt(distance_squared(a->origin, b->origin));
      }
      if (spread > most) {
        most = spread;
        best = axis;
      }
    }
    return best;
  }

  // Those targets that the cell's photons can hit.
  std::vector<std::uint32_t> met_by(const Cell& cell, const std::vector<std::uint32_t>& targets) const {
    std::vector<std::uint32_t> met = targets;
    if (const std::optional<EmittedBeam> beam = beam_of(cell))
      std::erase_if(met, [&](std::uint32_t i) { return !may_meet(*beam, targets_[i]); });
    return met;
  }

  void open(const Cell& cell, std::vector<std::uint32_t>&& met, std::vector<Open>& level) {
    nodes_.push_back({cell, 0, 0, 0});
    if (!met.empty()) level.push_back({static_cast<std::uint32_t>(nodes_.size() - 1), std::move(met)});
  }

  // How a cell is halved, and the balls that each half meets.
  struct Halves {
    std::uint32_t axis = 0;
    std::array<std::vector<std::uint32_t>, 2> met;
  };

  std::vector<Open> halve(const std::vector<Open>& level) {
    std::vector<Halves> halves(level.size());
    constexpr std::size_t chunk = 16;
    parallel_chunks(level.size(), chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Cell& cell = nodes_[level[i].node].cell;
        Halves& of = halves[i];
        of.axis = widest_axis(cell);
        for (const bool upper : {false, true}) of.met[upper ? 1 : 0] = met_by(cell.half(of.axis, upper), level[i].near);
      }
    });
    std::vector<Open> next;
    for (std::size_t i = 0; i < level.size(); ++i) {
      Halves& of = halves[i];
      const Cell cell = nodes_[level[i].node].cell;
      nodes_[level[i].node].axis = of.axis;
      nodes_[level[i].node].lower = static_cast<std::uint32_t>(nodes_.size());
      for (const bool upper : {false, true}) open(cell.half(of.axis, upper), std::move(of.met[upper ? 1 : 0]), next);
    }
    return next;
  }

  // Sets the masses of the cells that were not halved. The weight of a target is distributed evenly over the photons
  // that can hit it.
  void distribute(const std::vector<Open>& level) {
    if (weights_.empty()) {
      for (const Open& o : level) nodes_[o.node].mass = nodes_[o.node].cell.volume();
      return;
    }
    std::vector<float> volumes(targets_.size(), 0.0f);
    for (const Open& o : level)
      for (const std::uint32_t target : o.near) volumes[target] += nodes_[o.node].cell.volume();
    for (const Open& o : level)
      for (const std::uint32_t target : o.near)
        nodes_[o.node].mass += weights_[target] * nodes_[o.node].cell.volume() / volumes[target];
  }

  // Sums the masses of the children. Children that are alike are merged into one cell.
  void settle(std::uint32_t number) {
    Node& node = nodes_[number];
    if (node.lower == 0) return;
    Node &lower = nodes_[node.lower], &upper = nodes_[node.lower + 1];
    settle(node.lower);
    settle(node.lower + 1);
    node.mass = lower.mass + upper.mass;
    if (lower.lower == 0 && upper.lower == 0 && lower.mass == upper.mass) node.lower = 0;
  }

  std::uint32_t add(std::uint32_t number, TreeDistribution& to) const {
    const Node& node = nodes_[number];
    if (node.lower == 0)
      return to.add_leaf(uniform_share * node.cell.volume() + (1 - uniform_share) * node.mass / nodes_[0].mass);
    const std::uint32_t lower = add(node.lower, to);
    const std::uint32_t upper = add(node.lower + 1, to);
    return to.add_inner(node.axis, lower, upper);
  }

  const Light& light_;
  std::span<const Ball> targets_;
  std::span<const float> weights_;
  const AimedDisks* disks_;
  float scene_size_;
  Wavelengths any_ = Wavelengths::rgb(0.5f);  // position and direction do not depend on them
  std::vector<Node> nodes_;
};

// Number of pieces of this size along each axis of a box.
Vec3 pieces_of(const Bounds& box, float size) {
  constexpr float most = 16;
  return glm::clamp(glm::ceil(box.extent() / size), Vec3(1), Vec3(most));
}

// Cuts long boxes into pieces, so that the balls around them are not much larger.
void add_balls(const Bounds& box, float size, std::vector<Ball>& to) {
  const Vec3 pieces = pieces_of(box, size);
  const Vec3 step = box.extent() / pieces;
  const float radius = 0.5f * std::sqrt(length_squared(step));
  for (float z = 0.5f; z < pieces.z; ++z)
    for (float y = 0.5f; y < pieces.y; ++y)
      for (float x = 0.5f; x < pieces.x; ++x) to.push_back({box.min + Vec3(x, y, z) * step, radius});
}

std::vector<Ball> balls_around(const Scene& scene, const std::vector<Bounds>& boxes) {
  // Pieces are larger if there would be too many. After five doublings each box is one piece.
  float size = scene.bounding_sphere().radius / 16;
  const auto count = [&] {
    double sum = 0;
    for (const Bounds& box : boxes) {
      const Vec3 pieces = pieces_of(box, size);
      sum += static_cast<double>(pieces.x * pieces.y * pieces.z);
    }
    return sum;
  };
  for (int doublings = 0; doublings < 5 && count() > static_cast<double>(most_balls); ++doublings) size *= 2;
  std::vector<Ball> balls;
  for (const Bounds& box : boxes) add_balls(box, size, balls);
  return balls;
}

EmissionGuide map_of(const Scene& scene, const Targets& targets, const std::optional<AimedDisks>& disks) {
  const std::vector<Light>& lights = scene.lights();
  EmissionGuide guide(lights.size(), disks);
  if (targets.balls.empty()) return guide;
  double total_power = 0;
  for (const Light& light : lights) total_power += static_cast<double>(std::fmax(0.0f, power(light)));
  if (!(total_power > 0)) return guide;
  parallel_for(std::size_t{0}, lights.size(), [&](std::size_t i) {
    const double share = static_cast<double>(std::fmax(0.0f, power(lights[i]))) / total_power;
    const auto cells = static_cast<std::size_t>(std::min(cells_of_light, cells_of_scene * share));
    guide.lights[i] = LightSubdivision(lights[i], targets, disks, scene.bounding_sphere().radius).build(cells);
  });
  // Photons that can hit a target have the same density for all lights, and every light gets some.
  double mean = 0;
  for (std::size_t i = 0; i < lights.size(); ++i)
    mean += static_cast<double>(std::fmax(0.0f, power(lights[i])) * guide.lights[i].relevance) / total_power;
  for (EmissionGuide::OfLight& light : guide.lights)
    light.relevance = mean > 0 ? light.relevance + uniform_share * static_cast<float>(mean) : 1.0f;
  return guide;
}

}  // namespace

EmissionGuide make_projection_map(const Scene& scene, PhotonTarget target, const std::optional<AimedDisks>& disks) {
  std::vector<Bounds> boxes;
  for (const Obstacle& o : scene.obstacles())
    if (o.is_specular || target != PhotonTarget::specular) boxes.push_back(o.box);
  if (target == PhotonTarget::surfaces_and_media) {
    const std::optional<std::vector<Bounds>> media = scene.scattering_boxes();
    if (!media) return map_of(scene, {}, disks);
    boxes.insert(boxes.end(), media->begin(), media->end());
  }
  return map_of(scene, {balls_around(scene, boxes), {}}, disks);
}

EmissionGuide make_projection_map(const Scene& scene, std::span<const PhotonBox> boxes,
                                  const std::optional<AimedDisks>& disks) {
  Targets targets;
  for (const PhotonBox& b : boxes) {
    targets.balls.push_back({b.box.centre(), 0.5f * std::sqrt(length_squared(b.box.extent()))});
    targets.weights.push_back(b.weight);
  }
  return map_of(scene, targets, disks);
}

}  // namespace lanthorn
