// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "staging/stand_in_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "math/vec.h"
#include "staging/lit_sides.h"
#include "staging/surfaces.h"

namespace lanthorn {

namespace {

using namespace description;

// Degrees: azimuth from +z towards +x, elevation above the horizon.
struct Viewpoint {
  float azimuth = 0, elevation = 15;
  const char* name = "from the front";
  Direction up{0, 1, 0};  // of the model
};
// Sorted by preference, starting with the front.
constexpr std::array<Viewpoint, 16> viewpoints{{{0, 15, "from the front"},
                                                {45, 15, "from the front and right"},
                                                {-45, 15, "from the front and left"},
                                                {0, 40, "from the front and above"},
                                                {45, 40, "from the front, right and above"},
                                                {-45, 40, "from the front, left and above"},
                                                {90, 15, "from the right"},
                                                {-90, 15, "from the left"},
                                                {90, 40, "from the right and above"},
                                                {-90, 40, "from the left and above"},
                                                {180, 15, "from behind"},
                                                {135, 15, "from behind and right"},
                                                {-135, 15, "from behind and left"},
                                                {180, 40, "from behind and above"},
                                                {135, 40, "from behind, right and above"},
                                                {-135, 40, "from behind, left and above"}}};

// For rooms that are open at the top or bottom. From below: the front of a model with z up, seen from slightly above.
constexpr Viewpoint from_above{0, 75, "from above"}, from_below{0, -75, "from below, with z up", {0, 0, 1}};

ViewFrame frame_of(const Viewpoint& from) { return view_from(from.azimuth, from.elevation); }

/// A viewpoint, and what is visible from it.
struct Candidate {
  Viewpoint from;
  OutsideView view;
  bool is_behind_ground = false;

  double amount() const { return is_behind_ground ? 0 : view.amount(); }
};

const Viewpoint& best_viewpoint(const std::vector<const Candidate*>& candidates) {
  constexpr double much_more = 1.6, more = 1.15;
  double most = much_more * candidates[0]->amount();
  const Candidate* best = candidates[0];
  for (const Candidate* candidate : candidates)
    if (const double amount = candidate->amount(); amount > most) {
      most = more * amount;
      best = candidate;
    }
  return best->from;
}

/// Which faces of the model's bounding box are covered by walls.
class Walls {
 public:
  explicit Walls(const ModelSamples& model) {
    constexpr std::size_t cells = 16;
    constexpr float wall = 0.1f;  // depth, as a fraction of the box
    const Vec3 extent = model.bounds.extent();
    if (!(std::min({extent.x, extent.y, extent.z}) > 0)) return;
    std::array<std::array<std::vector<char>, 2>, 3> has_wall;
    for (auto& faces : has_wall) faces.fill(std::vector<char>(cells * cells));
    for (const Surfaces::Sample& s : model.samples) {
      const Vec3 at = (s.position - model.bounds.min) / extent;
      const auto cell = [&](int axis) {
        return std::min(static_cast<std::size_t>(std::max(at[axis], 0.0f) * cells), cells - 1);
      };
      for (int k = 0; k < 3; ++k) {
        const std::size_t i = cell((k + 1) % 3) * cells + cell((k + 2) % 3);
        if (at[k] < wall) has_wall[static_cast<std::size_t>(k)][0][i] = 1;
        if (at[k] > 1 - wall) has_wall[static_cast<std::size_t>(k)][1][i] = 1;
      }
    }
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t side = 0; side < 2; ++side)
        share_[k][side] = static_cast<float>(std::count(has_wall[k][side].begin(), has_wall[k][side].end(), 1)) /
                          static_cast<float>(cells * cells);
  }

  /// Walls of rooms that stand at its edges cover only a quarter.
  bool is_open(int axis, int side) const {
    constexpr float most = 0.5f;
    return share_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)] < most;
  }
  /// True for a box with one to three open faces whose other faces are closed.
  bool make_an_open_room() const {
    constexpr float least = 0.8f;
    int closed = 0, open = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        closed += share_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)] >= least ? 1 : 0;
        open += is_open(axis, side) ? 1 : 0;
      }
    return closed >= 3 && open >= 1;
  }

 private:
  std::array<std::array<float, 2>, 3> share_{};
};

// The number of separate meshes visible from each candidate. A mesh of which a candidate shows less than half as much
// as the best candidate counts in part. An unlit side counts a tenth.
std::vector<double> meshes_seen(const SceneDescription& scene, const ModelSamples& model,
                                const std::vector<Candidate>& candidates) {
  constexpr double dark_weight = 0.1, enough = 0.5;
  const std::vector<std::uint32_t> mesh_of = Surfaces(scene).meshes_of(model.samples);
  const std::size_t count = *std::max_element(mesh_of.begin(), mesh_of.end()) + std::size_t{1};
  std::vector<std::vector<double>> seen;
  std::vector<double> most(count);
  for (const Candidate& candidate : candidates) {
    std::vector<double>& of_meshes = seen.emplace_back(count);
    for (const std::size_t i : candidate.view.in_front())
      of_meshes[mesh_of[i]] += candidate.view.is_lit(i) ? 1 : dark_weight;
    for (std::size_t m = 0; m < count; ++m) most[m] = std::max(most[m], of_meshes[m]);
  }
  std::vector<double> numbers;
  for (const std::vector<double>& of_meshes : seen) {
    double& number = numbers.emplace_back();
    for (std::size_t m = 0; m < count; ++m)
      if (most[m] > 0) number += std::min(1.0, of_meshes[m] / (enough * most[m]));
  }
  return numbers;
}

// For an open room, the candidates that do not show far fewer of its meshes than the best one; if the front is one of
// these, only those that show nearly everything. Only open rooms are viewed from above or below.
std::vector<const Candidate*> with_most_meshes(const SceneDescription& scene, const ModelSamples& model,
                                               const std::vector<Candidate>& candidates, bool is_open_room) {
  constexpr double many_more = 1.6, nearly_all = 0.9;
  const std::vector<double> numbers =
      is_open_room ? meshes_seen(scene, model, candidates) : std::vector<double>(candidates.size(), 1);
  const double most = *std::max_element(numbers.begin(), numbers.end());
  const bool front_shows_few = most >= many_more * numbers[0];
  const double least = front_shows_few ? nearly_all * most : most / many_more;
  std::vector<const Candidate*> result;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (numbers[i] >= least && (front_shows_few || i < viewpoints.size())) result.push_back(&candidates[i]);
  return result;
}

// True if the scene's own lights illuminate hardly anything that is visible from outside.
bool is_lit_inside_alone(const ModelSamples& model, const std::vector<Candidate>& candidates) {
  constexpr double most_lit_outside = 0.05;
  const auto lit =
      std::count_if(model.lit.begin(), model.lit.end(), [](const LitSides& s) { return s.front || s.back; });
  return lit > 0 && std::all_of(candidates.begin(), candidates.end(), [&](const Candidate& candidate) {
           const OutsideView& view = candidate.view;
           const auto seen = std::count_if(view.in_front().begin(), view.in_front().end(),
                                           [&](std::size_t i) { return view.is_lit(i); });
           return static_cast<double>(seen) < most_lit_outside * static_cast<double>(lit);
         });
}

}  // namespace

StandInView stand_in_view(const SceneDescription& scene, const OneSided& one_sided, std::vector<Bounds> parts,
                          bool has_own_light, const std::optional<Vec3>& side_of_ground) {
  ModelSamples model(scene, one_sided);
  constexpr float largest = 1e18f;  // squares of distances must fit into floats
  if (model.samples.empty() || !(model.radius > 0) || !(model.radius < largest))
    return {.frame = frame_of(viewpoints[0]), .field_of_view = view_outside, .name = viewpoints[0].name};
  if (has_own_light) model.lit = lit_sides(scene, model);
  const Walls walls(model);
  const bool is_open_room = walls.make_an_open_room();
  // Also true if the viewpoint sees the ground nearly edge-on.
  const auto is_behind_ground = [&](const Viewpoint& viewpoint) {
    constexpr float least_cosine = 0.1f;
    return side_of_ground && dot(frame_of(viewpoint).towards_eye, *side_of_ground) < least_cosine;
  };
  std::vector<Viewpoint> from(viewpoints.begin(), viewpoints.end());
  if (is_open_room && walls.is_open(1, 1) && !is_behind_ground(from_above)) from.push_back(from_above);
  if (is_open_room && walls.is_open(1, 0) && !is_behind_ground(from_below)) from.push_back(from_below);
  std::vector<Candidate> candidates;
  candidates.reserve(from.size());
  for (const Viewpoint& viewpoint : from)
    candidates.push_back({viewpoint, OutsideView(model, frame_of(viewpoint)), is_behind_ground(viewpoint)});
  const bool is_dark_outside = is_lit_inside_alone(model, candidates);
  std::vector<const OutsideView*> around;
  for (std::size_t i = 0; i < viewpoints.size(); ++i) around.push_back(&candidates[i].view);
  for (const Part& part : parts_of(scene)) parts.push_back(part.box);
  if (auto inside = view_inside(model, parts, around, is_dark_outside, is_open_room))
    return {.frame = inside->frame,
            .field_of_view = view_inside_angle,
            .name = "from inside",
            .up = inside->up,
            .inside = inside};
  if (is_dark_outside) model.lit.clear();
  const Viewpoint& best = best_viewpoint(with_most_meshes(scene, model, candidates, is_open_room));
  return {.frame = frame_of(best),
          .field_of_view = view_outside,
          .name = best.name,
          .up = best.up,
          .hides_lights = is_dark_outside};
}

}  // namespace lanthorn
