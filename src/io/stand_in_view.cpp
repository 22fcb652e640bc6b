// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/stand_in_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "io/lit_sides.h"
#include "math/vec.h"

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

// Candidate positions in the bounding box.
std::vector<Point> places_inside(const Bounds& bounds) {
  constexpr std::array<float, 5> across{0.08f, 0.3f, 0.5f, 0.7f, 0.92f};
  constexpr std::array<float, 2> heights{0.4f, 0.6f};
  std::vector<Point> places;
  for (const float x : across)
    for (const float y : heights)
      for (const float z : across) places.push_back(bounds.min + Vec3(x, y, z) * bounds.extent());
  return places;
}

// The positions from which surfaces are visible in nearly all directions.
std::vector<Panorama> surrounded_places(const ModelSamples& model) {
  constexpr float least_closed = 0.95f;
  std::vector<Panorama> places;
  for (const Point& place : places_inside(model.bounds))
    if (Panorama panorama(model, place); panorama.closed() >= least_closed) places.push_back(std::move(panorama));
  return places;
}

// What is visible from outside, from any viewpoint.
struct Outside {
  std::vector<char> is_seen;   ///< for each sample
  double backs = 0, dull = 0;  ///< fractions: backs of one-sided surfaces; these or faces of a box

  Outside(const ModelSamples& model, std::span<const Candidate> candidates) : is_seen(model.samples.size()) {
    constexpr float tolerance = 0.05f;
    double all = 0;
    for (const Candidate& candidate : candidates)
      for (const std::size_t i : candidate.view.in_front()) {
        const bool is_back = candidate.view.is_back(i);
        is_seen[i] = 1;
        ++all;
        if (is_back) ++backs;
        if (is_back || model.is_on_box(i, tolerance)) ++dull;
      }
    backs /= all;
    dull /= all;
  }
};

// True if objects other than walls are visible from these positions but hardly visible from outside.
bool has_things_inside(const ModelSamples& model, const Outside& outside, const std::vector<Panorama>& places) {
  constexpr float wall = 0.1f;
  constexpr double least_things = 0.05, most_seen_outside = 0.25;
  std::vector<char> is_seen(model.samples.size());
  for (const Panorama& place : places)
    for (const std::size_t i : place.seen()) is_seen[i] = 1;
  double all = 0, things = 0, seen_outside = 0;
  for (std::size_t i = 0; i < is_seen.size(); ++i) {
    if (is_seen[i] == 0) continue;
    ++all;
    if (model.is_on_box(i, wall)) continue;
    ++things;
    if (outside.is_seen[i] != 0) ++seen_outside;
  }
  return things > least_things * all && seen_outside < most_seen_outside * things;
}

// True if the model has no opening, and hardly anything visible from these positions is the back of a one-sided
// surface.
bool shows_fronts_inside(const ModelSamples& model, const std::vector<Panorama>& places) {
  constexpr float closed = 0.99f;
  constexpr double most_backs = 0.1;
  double all = 0, backs = 0;
  bool is_closed = false;
  for (const Panorama& place : places) {
    is_closed = is_closed || place.closed() >= closed;
    for (const std::size_t i : place.seen()) {
      ++all;
      if (model.is_back(i, place.eye())) ++backs;
    }
  }
  return is_closed && backs < most_backs * all;
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

// Sum of weights in a square picture.
double amount_seen(const ModelSamples& model, const Panorama& panorama, const ViewFrame& frame) {
  const float edge = std::tan(to_radians(view_inside / 2));
  double sum = 0;
  for (const std::size_t i : panorama.seen()) {
    const Vec3 p = model.samples[i].position - panorama.eye();
    const float depth = -dot(p, frame.towards_eye);
    if (std::fabs(dot(p, frame.right)) < edge * depth && std::fabs(dot(p, frame.up)) < edge * depth)
      sum += model.weight(i, panorama.eye());
  }
  return sum;
}

// The position, apart from the eye's own, that sees most of what the eye sees.
StandInView::Inside with_lamp(const ModelSamples& model, const std::vector<Panorama>& rooms, const Panorama& eye) {
  std::vector<char> is_seen(model.samples.size());
  for (const std::size_t i : eye.seen()) is_seen[i] = 1;
  const Panorama* best = &eye;
  std::ptrdiff_t most = 0;
  for (const Panorama& room : rooms) {
    if (&room == &eye) continue;
    const auto shared =
        std::count_if(room.seen().begin(), room.seen().end(), [&](std::size_t i) { return is_seen[i] != 0; });
    if (shared <= most) continue;
    most = shared;
    best = &room;
  }
  constexpr float largest = 0.05f;
  return {eye.eye(), best->eye(), std::min(best->clearance() / 3, largest * model.radius), model.radius / 2};
}

// True if the walls around these positions belong to the whole model, not to a figure or a lamp in it.
bool enclose_the_model(const ModelSamples& model, const std::vector<Panorama>& places) {
  constexpr float least = 0.8f;
  Bounds walls;
  for (const Panorama& place : places)
    for (const std::size_t i : place.seen()) walls.extend(model.samples[i].position);
  if (walls.empty()) return false;
  const Vec3 extent = walls.extent(), whole = model.bounds.extent();
  return extent.x >= least * whole.x && extent.y >= least * whole.y && extent.z >= least * whole.z;
}

std::optional<StandInView> best_view_inside(const ModelSamples& model, std::span<const Candidate> from_outside,
                                            bool is_dark_outside) {
  constexpr float most_height = 0.6f;
  constexpr double dull_share = 0.9, backs_share = 0.9;
  const Outside outside(model, from_outside);
  // Rooms are wider than high; chests often are not.
  const Vec3 extent = model.bounds.extent();
  const bool may_be_room = extent.y <= most_height * std::max(extent.x, extent.z) && outside.dull >= dull_share;
  // Walls that viewers cull from outside, or the sphere of a sky.
  const bool may_face_inwards = model.one_sided.is_certain && outside.backs >= backs_share;
  if (!may_be_room && !may_face_inwards && !is_dark_outside) return {};
  const std::vector<Panorama> rooms = surrounded_places(model);
  if (!enclose_the_model(model, rooms)) return {};
  if (!(may_be_room && has_things_inside(model, outside, rooms)) &&
      !(may_face_inwards && shows_fronts_inside(model, rooms)) && !is_dark_outside)
    return {};
  double most = 0;
  std::optional<StandInView> best;
  for (const Panorama& room : rooms)
    for (int i = 0; i < 8; ++i) {
      const ViewFrame frame = frame_of({45.0f * static_cast<float>(i), 10});
      const double amount = amount_seen(model, room, frame);
      if (amount <= most) continue;
      most = amount;
      best = StandInView{
          .frame = frame, .field_of_view = view_inside, .name = "from inside", .inside = with_lamp(model, rooms, room)};
    }
  return best;
}

}  // namespace

StandInView stand_in_view(const SceneDescription& scene, const OneSided& one_sided, bool has_own_light,
                          const std::optional<Vec3>& side_of_ground) {
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
  if (auto inside = best_view_inside(model, std::span(candidates).first(viewpoints.size()), is_dark_outside))
    return *inside;
  if (is_dark_outside) model.lit.clear();
  const Viewpoint& best = best_viewpoint(with_most_meshes(scene, model, candidates, is_open_room));
  return {.frame = frame_of(best),
          .field_of_view = view_outside,
          .name = best.name,
          .up = best.up,
          .hides_lights = is_dark_outside};
}

}  // namespace lanthorn
