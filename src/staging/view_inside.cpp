// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "staging/stand_in_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "math/vec.h"

namespace lanthorn {

namespace {

constexpr int y_axis = 1, z_axis = 2;

/// Parts of a model that may be walls, floors or ceilings: flat along a side of its bounding box, of which each covers
/// at least a twentieth.
class Slabs {
 public:
  Slabs(const ModelSamples& model, std::span<const Bounds> parts) : model_(model.bounds) {
    constexpr float thin = 0.1f, least_share = 0.05f;
    constexpr std::size_t most = 256;
    const Vec3 whole = model_.extent();
    for (const Bounds& part : parts)
      for (int axis = 0; axis < 3 && !part.empty() && slabs_.size() < most; ++axis) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        const Vec3 extent = part.extent();
        if (extent[axis] <= thin * whole[axis] && extent[a] * extent[b] >= least_share * whole[a] * whole[b])
          slabs_.push_back({part, axis});
      }
  }

  bool contain(const Point& p) const {
    constexpr float tolerance = 0.01f;
    const Vec3 margin = tolerance * model_.extent();
    return std::any_of(slabs_.begin(), slabs_.end(), [&](const Slab& slab) {
      for (int k = 0; k < 3; ++k)
        if (p[k] < slab.box.min[k] - margin[k] || p[k] > slab.box.max[k] + margin[k]) return false;
      return true;
    });
  }

  /// True if different slabs cover the six sides, except for openings.
  bool make_a_box() const { return count_sides(0.6f, 1) == 6; }
  /// True if slabs cover most sides, but little of some other side.
  bool lack_a_side() const { return count_sides(0.6f, 1) >= 3 && count_sides(0, 0.3f) > 0; }

 private:
  struct Slab {
    Bounds box;
    int axis = 0;
  };

  // The number of sides of which slabs cover a share in this range.
  int count_sides(float least, float most) const {
    int count = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (const float side : {0.0f, 1.0f}) {
        const float share = covered_share(axis, side);
        count += share >= least && share <= most ? 1 : 0;
      }
    return count;
  }

  float covered_share(int axis, float side) const {
    constexpr float near = 0.15f;
    constexpr int cells = 16;
    const Vec3 whole = model_.extent();
    int covered = 0;
    for (int i = 0; i < cells * cells; ++i) {
      const int column = i % cells, row = i / cells;
      Point p = model_.min;
      p[(axis + 1) % 3] += whole[(axis + 1) % 3] * (static_cast<float>(column) + 0.5f) / cells;
      p[(axis + 2) % 3] += whole[(axis + 2) % 3] * (static_cast<float>(row) + 0.5f) / cells;
      const float face = model_.min[axis] + side * whole[axis];
      const bool is_covered = std::any_of(slabs_.begin(), slabs_.end(), [&](const Slab& slab) {
        const auto spans = [&](int k) { return p[k] >= slab.box.min[k] && p[k] <= slab.box.max[k]; };
        return slab.axis == axis && std::fabs(slab.box.centre()[axis] - face) <= near * whole[axis] &&
               spans((axis + 1) % 3) && spans((axis + 2) % 3);
      });
      covered += is_covered ? 1 : 0;
    }
    return static_cast<float>(covered) / (cells * cells);
  }

  Bounds model_;
  std::vector<Slab> slabs_;
};

// Places in the bounding box where an eye may be.
std::vector<Point> places_inside(const Bounds& bounds, int up) {
  constexpr std::array<float, 5> across{0.08f, 0.3f, 0.5f, 0.7f, 0.92f};
  constexpr std::array<float, 2> heights{0.4f, 0.6f};
  std::vector<Point> places;
  for (const float a : across)
    for (const float height : heights)
      for (const float b : across)
        places.push_back(bounds.min + (up == y_axis ? Vec3(a, height, b) : Vec3(a, b, height)) * bounds.extent());
  return places;
}

// The positions from which surfaces are visible in nearly all directions.
std::vector<Panorama> surrounded_places(const ModelSamples& model, int up, float least_closed) {
  std::vector<Panorama> places;
  for (const Point& place : places_inside(model.bounds, up))
    if (Panorama panorama(model, place); panorama.closed() >= least_closed) places.push_back(std::move(panorama));
  return places;
}

// What is visible from outside, from any viewpoint.
struct Outside {
  std::vector<char> is_seen;   ///< for each sample
  double backs = 0, dull = 0;  ///< fractions: backs of one-sided surfaces; these, walls, or faces of a box

  Outside(const ModelSamples& model, const Slabs& slabs, std::span<const OutsideView* const> views)
      : is_seen(model.samples.size()) {
    constexpr float tolerance = 0.05f, flat = 0.9f;
    // A corrugated roof is not a flat wall.
    const auto is_in_wall = [&](const Surfaces::Sample& s) {
      return max_component(glm::abs(s.normal)) > flat && slabs.contain(s.position);
    };
    double all = 0;
    for (const OutsideView* view : views)
      for (const std::size_t i : view->in_front()) {
        const bool is_back = view->is_back(i);
        is_seen[i] = 1;
        ++all;
        if (is_back) ++backs;
        if (is_back || model.is_on_box(i, tolerance) || is_in_wall(model.samples[i])) ++dull;
      }
    if (all == 0) return;
    backs /= all;
    dull /= all;
  }
};

/// What is visible from inside, but is no wall.
struct Things {
  double share = 0;         ///< of all samples that are visible from inside
  double seen_outside = 0;  ///< fraction of the things that are also visible from outside
  Vec3 centre{0.5f};        ///< mean position, as a fraction of the model's box

  Things(const ModelSamples& model, const Slabs& slabs, const Outside& outside, const std::vector<Panorama>& places) {
    constexpr float wall = 0.1f;
    std::vector<char> is_seen(model.samples.size());
    for (const Panorama& place : places)
      for (const std::size_t i : place.seen()) is_seen[i] = 1;
    double all = 0, count = 0;
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < is_seen.size(); ++i) {
      if (is_seen[i] == 0) continue;
      ++all;
      const Point& p = model.samples[i].position;
      if (model.is_on_box(i, wall) || slabs.contain(p)) continue;
      ++count;
      sum += glm::dvec3((p - model.bounds.min) / model.bounds.extent());
      if (outside.is_seen[i] != 0) ++seen_outside;
    }
    if (!(count > 0)) return;
    share = count / all;
    seen_outside /= count;
    centre = Vec3(sum / count);
  }

  bool are_hidden() const {
    constexpr double least = 0.05, most_seen_outside = 0.25;
    return share > least && seen_outside < most_seen_outside;
  }
};

// The fraction of what is visible from these positions that is the back of a one-sided surface.
double share_of_backs(const ModelSamples& model, const std::vector<Panorama>& places) {
  double all = 0, backs = 0;
  for (const Panorama& place : places)
    for (const std::size_t i : place.seen()) {
      ++all;
      if (model.is_back(i, place.eye())) ++backs;
    }
  return all > 0 ? backs / all : 0;
}

// True if the model has no opening, and hardly anything visible from these positions is such a back.
bool shows_fronts_inside(const ModelSamples& model, const std::vector<Panorama>& places) {
  constexpr float closed = 0.99f;
  constexpr double most_backs = 0.1;
  return std::any_of(places.begin(), places.end(), [&](const Panorama& p) { return p.closed() >= closed; }) &&
         share_of_backs(model, places) < most_backs;
}

// Sum of weights in a square picture.
double amount_seen(const ModelSamples& model, const Panorama& panorama, const ViewFrame& frame) {
  const float edge = std::tan(to_radians(view_inside_angle / 2));
  double sum = 0;
  for (const std::size_t i : panorama.seen()) {
    const Vec3 p = model.samples[i].position - panorama.eye();
    const float depth = -dot(p, frame.towards_eye);
    if (std::fabs(dot(p, frame.right)) < edge * depth && std::fabs(dot(p, frame.up)) < edge * depth)
      sum += model.weight(i, panorama.eye());
  }
  return sum;
}

// The view from this position, with a lamp at the other position that sees most of what the eye sees.
ViewInside with_lamp(const ModelSamples& model, const std::vector<Panorama>& rooms, const Panorama& eye,
                     const ViewFrame& frame, int up) {
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
  Direction upwards(0);
  upwards[up] = 1;
  return {.frame = frame,
          .up = upwards,
          .eye = eye.eye(),
          .lamp = best->eye(),
          .lamp_radius = std::min(best->clearance() / 3, largest * model.radius),
          .lamp_distance = model.radius / 2};
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

// The height in proportion to the longer of the other two sides.
float height_of(const Vec3& extent, int up) { return extent[up] / std::max(extent[0], extent[3 - up]); }

/// Decides whether a model that does not glow from inside is a room, and which axis is up in it.
class Room {
 public:
  Room(const ModelSamples& model, std::span<const Bounds> parts, std::span<const OutsideView* const> from_outside)
      : model_(model), slabs_(model, parts), outside_(model, slabs_, from_outside), has_walls_(slabs_.make_a_box()) {}

  bool lacks_a_side() const { return slabs_.lack_a_side(); }

  const Outside& outside() const { return outside_; }

  /// The axis that is up; nullopt if the model is no room. With an open side, only things that are hidden all the same
  /// make it one.
  std::optional<int> up(const std::vector<Panorama>& places, bool has_open_side) const {
    constexpr double dull_share = 0.9, most_backs = 0.5;
    if (outside_.dull < dull_share) return {};
    const Things things(model_, slabs_, outside_, places);
    const bool is_furnished = things.are_hidden();
    // Viewers do not draw the backs of walls: an empty model of such walls is meant to be seen from outside.
    const bool shows_backs = model_.one_sided.is_certain && share_of_backs(model_, places) > most_backs;
    if ((has_open_side || shows_backs) && !is_furnished) return {};
    if (!has_open_side && is_upright_along_z(things, is_furnished)) return z_axis;
    if (is_furnished && height_of(model_.bounds.extent(), y_axis) <= most_height) return y_axis;
    return is_built_along(y_axis) ? std::optional(y_axis) : std::nullopt;
  }

 private:
  static constexpr float most_height = 0.6f;  // chests with things in them are often higher

  // The things of a room stand on its floor. An empty one has z up if it would be too high otherwise.
  bool is_upright_along_z(const Things& things, bool is_furnished) const {
    constexpr float low = 0.4f, lower = 0.1f, longest = 1.5f;  // wardrobes and refrigerators are longer along y
    const Vec3 extent = model_.bounds.extent();
    if (!is_furnished)
      return is_built_along(z_axis) && height_of(extent, y_axis) > most_height && extent.y <= longest * extent.x;
    const bool may_be_room = height_of(extent, z_axis) <= most_height || is_built_along(z_axis);
    return may_be_room && things.centre.z <= low && things.centre.z < things.centre.y - lower;
  }

  // True if walls make the model, in the proportions of a room. A cupboard is higher or less deep.
  bool is_built_along(int up) const {
    constexpr float most = 0.85f, least_width = 0.8f;
    const Vec3 extent = model_.bounds.extent();
    return has_walls_ && height_of(extent, up) <= most &&
           std::min(extent[0], extent[3 - up]) >= least_width * extent[up];
  }

  const ModelSamples& model_;
  Slabs slabs_;
  Outside outside_;
  bool has_walls_;
};

}  // namespace

std::optional<ViewInside> view_inside(const ModelSamples& model, std::span<const Bounds> parts,
                                      std::span<const OutsideView* const> from_outside, bool is_dark_outside,
                                      bool has_open_side) {
  constexpr float least_closed = 0.95f;
  constexpr double backs_share = 0.9;
  const Room room(model, parts, from_outside);
  has_open_side = has_open_side || room.lacks_a_side();
  const float with_windows = has_open_side ? least_closed : 0.85f;
  std::vector<Panorama> places = surrounded_places(model, y_axis, with_windows);
  if (!enclose_the_model(model, places)) return {};
  const std::optional<int> up = room.up(places, has_open_side);
  // Walls that viewers cull from outside, or the sphere of a sky.
  const bool may_face_inwards = model.one_sided.is_certain && room.outside().backs >= backs_share;
  if (up == z_axis) places = surrounded_places(model, z_axis, with_windows);
  if (!up) {
    std::erase_if(places, [&](const Panorama& place) { return place.closed() < least_closed; });
    const bool faces_inwards = may_face_inwards && shows_fronts_inside(model, places);
    if (!enclose_the_model(model, places) || !(faces_inwards || is_dark_outside)) return {};
  }
  double most = 0;
  std::optional<ViewInside> best;
  for (const Panorama& place : places)
    for (int i = 0; i < 8; ++i) {
      const ViewFrame frame = view_from(45.0f * static_cast<float>(i), 10, up == z_axis);
      const double amount = amount_seen(model, place, frame);
      if (amount <= most) continue;
      most = amount;
      best = with_lamp(model, places, place, frame, up.value_or(y_axis));
    }
  return best;
}

}  // namespace lanthorn
