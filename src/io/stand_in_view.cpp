// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/stand_in_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "io/lit_sides.h"
#include "math/vec.h"

namespace lanthorn {

namespace {

using namespace description;

// Degrees: from +z towards +x, and above the horizon.
struct Viewpoint {
  float azimuth = 0, elevation = 15;
  const char* name = "from the front";
};
// The first is the front; the nearer to it the better.
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

ViewFrame frame_of(const Viewpoint& from) { return view_from(from.azimuth, from.elevation); }

const Viewpoint& best_viewpoint(const std::vector<OutsideView>& views) {
  constexpr double much_more = 1.6, more = 1.15;
  double most = much_more * views[0].amount();
  std::size_t best = 0;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (const double amount = views[i].amount(); amount > most) {
      most = more * amount;
      best = i;
    }
  return viewpoints[best];
}

// Places in the bounding box.
std::vector<Point> places_inside(const Bounds& bounds) {
  constexpr std::array<float, 5> across{0.08f, 0.3f, 0.5f, 0.7f, 0.92f};
  constexpr std::array<float, 2> heights{0.4f, 0.6f};
  std::vector<Point> places;
  for (const float x : across)
    for (const float y : heights)
      for (const float z : across) places.push_back(bounds.min + Vec3(x, y, z) * bounds.extent());
  return places;
}

// The places from which surfaces are seen in nearly all directions.
std::vector<Panorama> surrounded_places(const ModelSamples& model) {
  constexpr float least_closed = 0.95f;
  std::vector<Panorama> places;
  for (const Point& place : places_inside(model.bounds))
    if (Panorama panorama(model, place); panorama.closed() >= least_closed) places.push_back(std::move(panorama));
  return places;
}

// What nothing hides from outside, from any viewpoint.
struct Outside {
  std::vector<char> is_seen;   ///< of each sample
  double backs = 0, dull = 0;  ///< shares: backs of one-sided surfaces; these, or faces of a box

  Outside(const ModelSamples& model, const std::vector<OutsideView>& views) : is_seen(model.samples.size()) {
    constexpr float tolerance = 0.05f;
    double all = 0;
    for (const OutsideView& view : views)
      for (const std::size_t i : view.in_front()) {
        is_seen[i] = 1;
        ++all;
        if (view.is_back(i)) ++backs;
        if (view.is_back(i) || model.is_on_box(i, tolerance)) ++dull;
      }
    backs /= all;
    dull /= all;
  }
};

// Whether things are seen from these places that are hardly seen from outside, besides the walls.
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

// Whether the model is open nowhere, and hardly anything that is seen from these places is the back of a one-sided
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

// Whether the scene's own lights reach hardly anything that is seen from outside.
bool is_lit_inside_alone(const ModelSamples& model, const std::vector<OutsideView>& views) {
  constexpr double most_lit_outside = 0.05;
  const auto lit =
      std::count_if(model.lit.begin(), model.lit.end(), [](const LitSides& s) { return s.front || s.back; });
  return lit > 0 && std::all_of(views.begin(), views.end(), [&](const OutsideView& view) {
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

// The place with most of what the eye sees, besides the eye's own.
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

std::optional<StandInView> best_view_inside(const ModelSamples& model, const std::vector<OutsideView>& views) {
  constexpr float most_height = 0.6f;
  constexpr double dull_share = 0.9, backs_share = 0.9;
  const Outside outside(model, views);
  // Rooms are wider than they are high, chests often are not.
  const Vec3 extent = model.bounds.extent();
  const bool may_be_room = extent.y <= most_height * std::max(extent.x, extent.z) && outside.dull >= dull_share;
  // Walls that viewers do not draw from outside, or the sphere of a sky.
  const bool may_face_inwards = model.one_sided.is_certain && outside.backs >= backs_share;
  const bool is_dark_outside = is_lit_inside_alone(model, views);
  if (!may_be_room && !may_face_inwards && !is_dark_outside) return {};
  const std::vector<Panorama> rooms = surrounded_places(model);
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
      best = {frame, view_inside, "from inside", with_lamp(model, rooms, room)};
    }
  return best;
}

}  // namespace

StandInView stand_in_view(const SceneDescription& scene, const OneSided& one_sided, bool has_own_light) {
  ModelSamples model(scene, one_sided);
  constexpr float largest = 1e18f;  // squares of distances must fit into floats
  if (model.samples.empty() || !(model.radius > 0) || !(model.radius < largest))
    return {frame_of(viewpoints[0]), view_outside, viewpoints[0].name, {}};
  if (has_own_light) model.lit = lit_sides(scene, model);
  std::vector<OutsideView> outside;
  outside.reserve(viewpoints.size());
  for (const Viewpoint& viewpoint : viewpoints) outside.emplace_back(model, frame_of(viewpoint));
  if (auto inside = best_view_inside(model, outside)) return *inside;
  const Viewpoint& best = best_viewpoint(outside);
  return {frame_of(best), view_outside, best.name, {}};
}

}  // namespace lanthorn
