// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/obj/faces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "math/vec.h"

namespace lanthorn::obj {

namespace {

class Smoother {
 public:
  Smoother(const std::vector<Point>& positions, std::span<const BareFace> faces, std::vector<Corner>& corners,
           std::vector<Normal>& normals)
      : positions_(positions), faces_(faces), corners_(corners), normals_(normals) {
    face_normals_.reserve(faces.size());
    face_of_.resize(corners.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
      face_normals_.push_back(normal_of(faces[i]));
      for (std::size_t c = faces[i].first; c < faces[i].first + faces[i].count; ++c) face_of_[c] = i;
    }
    sort_corners_by_vertex();
  }

  void run() {
    for (std::size_t v = 0; v + 1 < starts_.size(); ++v)
      smooth_vertex(std::span(at_vertex_).subspan(starts_[v], starts_[v + 1] - starts_[v]));
    for (std::size_t i = 0; i < faces_.size(); ++i)
      if (is_flat(i))
        for (Corner& c : corners_of(faces_[i])) c.vn = none;
  }

 private:
  /// An edge from the current vertex to a neighbour, as one of the faces there uses it.
  struct Spoke {
    std::uint32_t neighbour = none;
    std::size_t corner = 0;  // index among the vertex's corners
    bool is_outgoing = false;
  };

  std::span<Corner> corners_of(const BareFace& face) const {
    return std::span(corners_).subspan(face.first, face.count);
  }

  // Unit length, or 0 for a face without area.
  glm::dvec3 normal_of(const BareFace& face) {
    polygon_.clear();
    for (const Corner& c : corners_of(face)) polygon_.push_back(positions_[c.v]);
    const glm::dvec3 area = area_vector(polygon_);
    const double length = glm::length(area);
    return length > 0 && std::isfinite(length) ? area / length : glm::dvec3(0);
  }

  void sort_corners_by_vertex() {
    starts_.assign(positions_.size() + 1, 0);
    for (const Corner& c : corners_) ++starts_[c.v + std::size_t{1}];
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    at_vertex_.resize(corners_.size());
    std::vector<std::size_t> next = starts_;
    for (std::size_t i = 0; i < corners_.size(); ++i) at_vertex_[next[corners_[i].v]++] = i;
  }

  std::uint32_t neighbour(std::size_t corner, bool is_outgoing) const {
    const BareFace& face = faces_[face_of_[corner]];
    const std::size_t i = corner - face.first;
    return corners_[face.first + (i + (is_outgoing ? 1 : face.count - 1)) % face.count].v;
  }

  double agreement(std::size_t first_corner, std::size_t second_corner) const {
    return glm::dot(face_normals_[face_of_[first_corner]], face_normals_[face_of_[second_corner]]);
  }

  bool is_smooth(std::size_t first_corner, std::size_t second_corner) const {
    constexpr double cosine = 0.8660254037844387;  // of 30 degrees
    const std::uint32_t group = faces_[face_of_[first_corner]].group;
    return group == faces_[face_of_[second_corner]].group && group != flat_group &&
           (group != group_by_angle || agreement(first_corner, second_corner) > cosine);
  }

  // Union-find over the corners.
  std::size_t root(std::size_t i) {
    while (joined_[i] != i) i = joined_[i] = joined_[joined_[i]];
    return i;
  }

  // Joins each face that traverses the edge in one direction to the face in the other direction whose normal is
  // nearest: a double-sided sheet has two of each. Faces that are back to back are not joined.
  void join_across(std::span<const Spoke> edge, std::span<const std::size_t> corners) {
    constexpr std::size_t most_faces = 16;  // more faces do not form a surface
    constexpr double back_to_back = -0.996;
    if (edge.size() > most_faces) return;
    for (const Spoke& a : edge) {
      const Spoke* nearest = nullptr;
      double most = back_to_back;
      for (const Spoke& b : edge) {
        if (!a.is_outgoing || b.is_outgoing) continue;
        const double agrees = agreement(corners[a.corner], corners[b.corner]);
        if (agrees <= most) continue;
        most = agrees;
        nearest = &b;
      }
      if (nearest != nullptr && is_smooth(corners[a.corner], corners[nearest->corner]))
        joined_[root(nearest->corner)] = root(a.corner);
    }
  }

  void join_corners(std::span<const std::size_t> corners) {
    spokes_.clear();
    joined_.resize(corners.size());
    std::iota(joined_.begin(), joined_.end(), std::size_t{0});
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (const bool is_outgoing : {false, true})
        spokes_.push_back({neighbour(corners[i], is_outgoing), i, is_outgoing});
    std::sort(spokes_.begin(), spokes_.end(), [](const Spoke& a, const Spoke& b) {
      return std::tie(a.neighbour, a.corner, a.is_outgoing) < std::tie(b.neighbour, b.corner, b.is_outgoing);
    });
    for (auto first = spokes_.begin(); first != spokes_.end();) {
      const auto last =
          std::find_if(first, spokes_.end(), [&](const Spoke& s) { return s.neighbour != first->neighbour; });
      join_across({first, last}, corners);
      first = last;
    }
  }

  double angle_at(std::size_t corner) const {
    const auto edge = [&](bool is_outgoing) {
      return glm::dvec3(positions_[neighbour(corner, is_outgoing)]) - glm::dvec3(positions_[corners_[corner].v]);
    };
    const glm::dvec3 before = edge(false), after = edge(true);
    return std::atan2(glm::length(glm::cross(before, after)), glm::dot(before, after));
  }

  void smooth_vertex(std::span<const std::size_t> corners) {
    join_corners(corners);
    sums_.assign(corners.size(), glm::dvec3(0));
    for (std::size_t i = 0; i < corners.size(); ++i)
      sums_[root(i)] += angle_at(corners[i]) * face_normals_[face_of_[corners[i]]];
    indices_.assign(corners.size(), none);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::size_t r = root(i);
      const double length = glm::length(sums_[r]);
      if (faces_[face_of_[corners[i]]].group == flat_group || !(length > 0) || !std::isfinite(length)) continue;
      if (indices_[r] == none) {
        indices_[r] = static_cast<std::uint32_t>(normals_.size());
        normals_.emplace_back(sums_[r] / length);
      }
      corners_[corners[i]].vn = indices_[r];
    }
  }

  bool is_flat(std::size_t face) const {
    constexpr float tolerance = 1e-4f;  // for unit vectors
    const Normal n(face_normals_[face]);
    const std::span<const Corner> own = corners_of(faces_[face]);
    return std::all_of(own.begin(), own.end(), [&](const Corner& c) {
      return c.vn == none || distance_squared(normals_[c.vn], n) < sqr(tolerance);
    });
  }

  const std::vector<Point>& positions_;
  std::span<const BareFace> faces_;
  std::vector<Corner>& corners_;
  std::vector<Normal>& normals_;
  std::vector<glm::dvec3> face_normals_;
  std::vector<std::size_t> face_of_;             // for each corner
  std::vector<std::size_t> starts_, at_vertex_;  // corners by vertex
  // Of the current face or vertex.
  std::vector<Point> polygon_;
  std::vector<Spoke> spokes_;
  std::vector<std::size_t> joined_;
  std::vector<glm::dvec3> sums_;
  std::vector<std::uint32_t> indices_;
};

using Triangle = std::array<std::uint32_t, 3>;

// Ear clipping takes time proportional to the cube of the number of corners.
constexpr std::size_t most_corners = 1000;

// Projects the polygon into its plane, counter-clockwise.
std::vector<glm::dvec2> flattened(const std::vector<Point>& corners, const glm::dvec3& normal) {
  const glm::dvec3 n = glm::abs(normal);
  const int z = n.x > n.y && n.x > n.z ? 0 : n.y > n.z ? 1 : 2;
  const int x = (z + 1) % 3, y = (z + 2) % 3;
  const double turn = normal[z] < 0 ? -1 : 1;
  std::vector<glm::dvec2> result;
  result.reserve(corners.size());
  for (const Point& p : corners) result.emplace_back(p[x], turn * static_cast<double>(p[y]));
  return result;
}

double twice_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool is_inside(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return twice_area(a, b, p) >= 0 && twice_area(b, c, p) >= 0 && twice_area(c, a, p) >= 0;
}

// True if `left[i]` is an ear: the polygon is convex there, and no other corner lies in the triangle.
bool is_ear(const std::vector<glm::dvec2>& flat, const std::vector<std::uint32_t>& left, std::size_t i) {
  const std::size_t n = left.size();
  const std::uint32_t before = left[(i + n - 1) % n], here = left[i], after = left[(i + 1) % n];
  if (!(twice_area(flat[before], flat[here], flat[after]) > 0)) return false;
  for (const std::uint32_t other : left) {
    const bool is_corner = flat[other] == flat[before] || flat[other] == flat[here] || flat[other] == flat[after];
    if (!is_corner && is_inside(flat[other], flat[before], flat[here], flat[after])) return false;
  }
  return true;
}

std::vector<Triangle> fan(std::size_t corners) {
  std::vector<Triangle> result;
  for (std::uint32_t i = 1; i + 1 < corners; ++i) result.push_back({0, i, i + 1});
  return result;
}

}  // namespace

void add_smooth_normals(const std::vector<Point>& positions, std::span<const BareFace> faces,
                        std::vector<Corner>& corners, std::vector<Normal>& normals) {
  if (std::any_of(faces.begin(), faces.end(), [](const BareFace& f) { return f.group != flat_group; }))
    Smoother(positions, faces, corners, normals).run();
}

glm::dvec3 area_vector(const std::vector<Point>& corners) {
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += glm::cross(glm::dvec3(corners[i] - corners[0]), glm::dvec3(corners[(i + 1) % corners.size()] - corners[0]));
  return 0.5 * sum;
}

std::vector<Triangle> triangulate(const std::vector<Point>& corners, std::uint64_t& tests_left) {
  const std::size_t n = corners.size();
  if (n <= 3 || n > most_corners) return fan(n);
  const std::vector<glm::dvec2> flat = flattened(corners, area_vector(corners));
  std::vector<std::uint32_t> left(n);
  std::iota(left.begin(), left.end(), 0u);
  std::vector<Triangle> result;
  std::size_t i = 1, tried = 0;
  while (left.size() > 3) {
    if (tried == left.size()) return fan(n);
    const std::size_t m = left.size();
    if (tests_left < m) return fan(n);
    tests_left -= m;
    if (!is_ear(flat, left, i % m)) {
      ++i;
      ++tried;
      continue;
    }
    i %= m;
    result.push_back({left[(i + m - 1) % m], left[i], left[(i + 1) % m]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
    ++i;  // skips a corner, which avoids slivers
    tried = 0;
  }
  result.push_back({left[0], left[1], left[2]});
  return result;
}

}  // namespace lanthorn::obj
