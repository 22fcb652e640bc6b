// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/stand_in_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "io/surfaces.h"
#include "math/vec.h"

namespace lanthorn {

namespace {

using namespace description;

constexpr float view_outside = 40, view_inside = 60;  // degrees

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

ViewFrame frame_of(const Viewpoint& from) {
  const float a = to_radians(from.azimuth), e = to_radians(from.elevation);
  ViewFrame frame;
  frame.towards_eye = {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
  frame.right = {std::cos(a), 0, -std::sin(a)};
  frame.up = cross(frame.towards_eye, frame.right);
  return frame;
}

struct Model {
  std::vector<Surfaces::Sample> samples;
  float spacing = 0;  ///< of samples on surfaces
  Bounds bounds;
  float radius = 0;
  const OneSided& one_sided;

  Model(const SceneDescription& scene, const OneSided& of_one_side) : one_sided(of_one_side) {
    constexpr std::size_t count = std::size_t{1} << 15;
    const Surfaces surfaces(scene);
    samples = surfaces.samples(count);
    spacing = static_cast<float>(std::sqrt(surfaces.area() / count));
    for (const Surfaces::Sample& s : samples) bounds.extend(s.position);
    radius = 0.5f * std::sqrt(length_squared(bounds.extent()));
  }

  bool is_back(const Surfaces::Sample& s, const Point& eye) const {
    return dot(eye - s.position, s.normal) < 0 && one_sided.materials.count(s.material) > 0;
  }
  // A surface that is seen at a slant counts less, and so does the back of a one-sided one.
  double weight(const Surfaces::Sample& s, const Point& eye) const {
    constexpr float back_weight = 0.25f;
    const float cosine = std::fabs(dot(normalize(eye - s.position), s.normal));
    return static_cast<double>(std::min(1.0f, 2 * cosine) * (is_back(s, eye) ? back_weight : 1));
  }
  // Whether the sample lies on a face of the bounding box, up to this part of its extent.
  bool is_on_box(const Surfaces::Sample& s, float tolerance) const {
    for (int i = 0; i < 3; ++i) {
      const float depth = std::min(s.position[i] - bounds.min[i], bounds.max[i] - s.position[i]);
      if (std::fabs(s.normal[i]) > 0.9f && depth < tolerance * bounds.extent()[i]) return true;
    }
    return false;
  }
};

// The samples that an eye at this viewpoint sees. A depth buffer of points, so that nothing has to be built.
class OutsideView {
 public:
  OutsideView(const Model& model, const Viewpoint& viewpoint) : model_(model) {
    constexpr int cells = 48;
    const ViewFrame frame = frame_of(viewpoint);
    const float half_angle = to_radians(view_outside / 2);
    const float distance = model.radius / std::sin(half_angle);
    eye_ = model.bounds.centre() + distance * frame.towards_eye;
    const float cell = 2 * distance * std::tan(half_angle) / cells;  // at the centre's distance
    struct Projected {
      std::size_t cell = 0;
      float depth = 0;
    };
    std::vector<Projected> projected(model.samples.size());
    std::vector<float> nearest(cells * cells, infinity);
    for (std::size_t i = 0; i < projected.size(); ++i) {
      const Vec3 p = model.samples[i].position - eye_;
      const float depth = std::max(-dot(p, frame.towards_eye), 1e-3f * distance);
      const auto column = [&](const Direction& axis) {
        const float x = dot(p, axis) * distance / depth / cell + 0.5f * cells;
        return static_cast<std::size_t>(std::clamp(x, 0.0f, cells - 1.0f));
      };
      projected[i] = {column(frame.up) * cells + column(frame.right), depth};
      nearest[projected[i].cell] = std::min(nearest[projected[i].cell], depth);
    }
    for (std::size_t i = 0; i < projected.size(); ++i) {
      const float behind = projected[i].depth - nearest[projected[i].cell];
      if (behind <= 1.5f * cell) seen_.push_back(i);
      if (behind <= 0.5f * cell) in_front_.push_back(i);
    }
  }

  const std::vector<std::size_t>& seen() const { return seen_; }
  /// Those which nothing thin can hide: walls do not let things near them through, but surfaces at a slant are missing.
  const std::vector<std::size_t>& in_front() const { return in_front_; }
  /// In numbers of samples.
  double amount() const {
    double sum = 0;
    for (const std::size_t i : seen_) sum += model_.weight(model_.samples[i], eye_);
    return sum;
  }
  bool is_back(std::size_t i) const { return model_.is_back(model_.samples[i], eye_); }

 private:
  const Model& model_;
  Point eye_{0};
  std::vector<std::size_t> seen_, in_front_;
};

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

// The samples that are seen from a point inside, in all directions. A cube map of depths. Samples cover squares as
// large as their part of the surface, so that walls close although they are near.
class Panorama {
 public:
  Panorama(const Model& model, const Point& eye) : eye_(eye) {
    std::vector<float> nearest(6 * cells * cells, infinity);
    std::vector<std::size_t> cell_of(model.samples.size());
    for (std::size_t i = 0; i < cell_of.size(); ++i) cell_of[i] = draw(model.samples[i].position - eye, model, nearest);
    for (std::size_t i = 0; i < cell_of.size(); ++i) {
      const float distance = length(model.samples[i].position - eye);
      clearance_ = std::min(clearance_, distance);
      if (distance <= nearest[cell_of[i]] + 4 * distance / cells + model.spacing) seen_.push_back(i);
    }
    const auto open = std::count(nearest.begin(), nearest.end(), infinity);
    closed_ = 1 - static_cast<float>(open) / static_cast<float>(nearest.size());
  }

  const Point& eye() const { return eye_; }
  const std::vector<std::size_t>& seen() const { return seen_; }
  float closed() const { return closed_; }        ///< share of directions in which there is something
  float clearance() const { return clearance_; }  ///< metres to the nearest sample

 private:
  static constexpr int cells = 24;  // along an edge of the cube's faces

  static std::size_t draw(const Vec3& p, const Model& model, std::vector<float>& nearest) {
    const Vec3 size = glm::abs(p);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t face = static_cast<std::size_t>(2 * axis) + (p[axis] < 0 ? 1 : 0);
    const float depth = std::max(size[axis], 1e-6f * model.radius);
    const float half = model.spacing / depth * 0.5f * cells;
    const auto at = [&](int other, float offset) {
      const float x = (p[(axis + other) % 3] / depth + 1) * 0.5f * cells + offset;
      return static_cast<std::size_t>(std::clamp(x, 0.0f, cells - 1.0f));
    };
    const auto cell = [&](std::size_t row, std::size_t column) { return (face * cells + row) * cells + column; };
    for (std::size_t row = at(1, -half); row <= at(1, half); ++row)
      for (std::size_t column = at(2, -half); column <= at(2, half); ++column)
        nearest[cell(row, column)] = std::min(nearest[cell(row, column)], length(p));
    return cell(at(1, 0), at(2, 0));
  }

  Point eye_;
  std::vector<std::size_t> seen_;
  float closed_ = 0, clearance_ = infinity;
};

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
std::vector<Panorama> surrounded_places(const Model& model) {
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

  Outside(const Model& model, const std::vector<OutsideView>& views) : is_seen(model.samples.size()) {
    constexpr float tolerance = 0.05f;
    double all = 0;
    for (const OutsideView& view : views)
      for (const std::size_t i : view.in_front()) {
        is_seen[i] = 1;
        ++all;
        if (view.is_back(i)) ++backs;
        if (view.is_back(i) || model.is_on_box(model.samples[i], tolerance)) ++dull;
      }
    backs /= all;
    dull /= all;
  }
};

// Whether things are seen from these places that are hardly seen from outside, besides the walls.
bool has_things_inside(const Model& model, const Outside& outside, const std::vector<Panorama>& places) {
  constexpr float wall = 0.1f;
  constexpr double least_things = 0.05, most_seen_outside = 0.25;
  std::vector<char> is_seen(model.samples.size());
  for (const Panorama& place : places)
    for (const std::size_t i : place.seen()) is_seen[i] = 1;
  double all = 0, things = 0, seen_outside = 0;
  for (std::size_t i = 0; i < is_seen.size(); ++i) {
    if (is_seen[i] == 0) continue;
    ++all;
    if (model.is_on_box(model.samples[i], wall)) continue;
    ++things;
    if (outside.is_seen[i] != 0) ++seen_outside;
  }
  return things > least_things * all && seen_outside < most_seen_outside * things;
}

// Whether the model is open nowhere, and hardly anything that is seen from these places is the back of a one-sided
// surface.
bool shows_fronts_inside(const Model& model, const std::vector<Panorama>& places) {
  constexpr float closed = 0.99f;
  constexpr double most_backs = 0.1;
  double all = 0, backs = 0;
  bool is_closed = false;
  for (const Panorama& place : places) {
    is_closed = is_closed || place.closed() >= closed;
    for (const std::size_t i : place.seen()) {
      ++all;
      if (model.is_back(model.samples[i], place.eye())) ++backs;
    }
  }
  return is_closed && backs < most_backs * all;
}

// Sum of weights in a square picture.
double amount_seen(const Model& model, const Panorama& panorama, const ViewFrame& frame) {
  const float edge = std::tan(to_radians(view_inside / 2));
  double sum = 0;
  for (const std::size_t i : panorama.seen()) {
    const Vec3 p = model.samples[i].position - panorama.eye();
    const float depth = -dot(p, frame.towards_eye);
    if (std::fabs(dot(p, frame.right)) < edge * depth && std::fabs(dot(p, frame.up)) < edge * depth)
      sum += model.weight(model.samples[i], panorama.eye());
  }
  return sum;
}

// The place with most of what the eye sees, besides the eye's own.
StandInView::Inside with_lamp(const Model& model, const std::vector<Panorama>& rooms, const Panorama& eye) {
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

std::optional<StandInView> best_view_inside(const Model& model, const std::vector<OutsideView>& views) {
  constexpr float most_height = 0.6f;
  constexpr double dull_share = 0.9, backs_share = 0.9;
  const Outside outside(model, views);
  // Rooms are wider than they are high, chests often are not.
  const Vec3 extent = model.bounds.extent();
  const bool may_be_room = extent.y <= most_height * std::max(extent.x, extent.z) && outside.dull >= dull_share;
  // Walls that viewers do not draw from outside, or the sphere of a sky.
  const bool may_face_inwards = model.one_sided.is_certain && outside.backs >= backs_share;
  if (!may_be_room && !may_face_inwards) return {};
  const std::vector<Panorama> rooms = surrounded_places(model);
  if (!(may_be_room && has_things_inside(model, outside, rooms)) &&
      !(may_face_inwards && shows_fronts_inside(model, rooms)))
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

StandInView stand_in_view(const SceneDescription& scene, const OneSided& one_sided) {
  const Model model(scene, one_sided);
  constexpr float largest = 1e18f;  // squares of distances must fit into floats
  if (model.samples.empty() || !(model.radius > 0) || !(model.radius < largest))
    return {frame_of(viewpoints[0]), view_outside, viewpoints[0].name, {}};
  std::vector<OutsideView> outside;
  outside.reserve(viewpoints.size());
  for (const Viewpoint& viewpoint : viewpoints) outside.emplace_back(model, viewpoint);
  if (auto inside = best_view_inside(model, outside)) return *inside;
  const Viewpoint& best = best_viewpoint(outside);
  return {frame_of(best), view_outside, best.name, {}};
}

}  // namespace lanthorn
