// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/scene/projection.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/matrix.hpp>
#include <utility>
#include <vector>

#include "lanthorn/error.h"

namespace lanthorn {

namespace {

using DVec3 = glm::dvec3;

// Four unit directions through the corners of a rectangle, scaled to end in one plane as a parallelogram: a + d' = b' +
// c'.
void set_perspective(WindowRays& rays, const DVec3& a, const DVec3& b, const DVec3& c, const DVec3& d) {
  const DVec3 factors = glm::inverse(glm::dmat3(b, c, -d)) * a;
  const DVec3 right = factors.x * b - a, down = factors.y * c - a;
  DVec3 axis = glm::normalize(glm::cross(right, down));
  if (dot(axis, a) < 0) axis = -axis;
  const double scale = 1 / dot(axis, a);
  rays.axis = Vec3(axis);
  rays.corner = Vec3(scale * a);
  rays.right = Vec3(scale * right);
  rays.down = Vec3(scale * down);
}

float median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The first hits of 64 rays through the middles of as many parts of the window.
std::vector<Point> seen_points(const Scene& scene, const WindowRays& rays, float time) {
  constexpr int rows = 8;
  std::vector<Point> seen;
  for (int i = 0; i < rows * rows; ++i) {
    const int column = i % rows, row = i / rows;
    const float x = (static_cast<float>(column) + 0.5f) / rows, y = (static_cast<float>(row) + 0.5f) / rows;
    const Vec3 through = rays.corner + x * rays.right + y * rays.down;
    Ray ray;
    ray.origin = rays.parallel ? through : rays.eye;
    ray.direction = rays.parallel ? rays.axis : normalize(through);
    ray.time = time;
    if (const auto at = scene.intersect(ray, Wavelengths{})) seen.push_back(at->position);
  }
  return seen;
}

Point median_of(const std::vector<Point>& points) {
  Point middle{0};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> along;
    along.reserve(points.size());
    for (const Point& p : points) along.push_back(p[axis]);
    middle[axis] = median(std::move(along));
  }
  return middle;
}

}  // namespace

Mat4 clip_matrix(const WindowRays& rays, float near, float far) {
  // Coordinates (x, y, t) of a point: x and y in the window, times t in perspective; t is its distance along the axis.
  const glm::dmat3 basis(DVec3(rays.right), DVec3(rays.down), DVec3(rays.parallel ? rays.axis : rays.corner));
  const glm::dmat3 inverse = glm::inverse(basis);
  const DVec3 origin = -(inverse * DVec3(rays.parallel ? rays.corner : rays.eye));
  const glm::dmat4x3 coordinates(inverse[0], inverse[1], inverse[2], origin);
  const auto row = [&](int i) {
    return glm::dvec4(coordinates[0][i], coordinates[1][i], coordinates[2][i], coordinates[3][i]);
  };
  const glm::dvec4 x = row(0), y = row(1), t = row(2);
  const glm::dvec4 one(0, 0, 0, 1);
  const glm::dvec4 w = rays.parallel ? one : t;
  const double depth = static_cast<double>(far) - static_cast<double>(near);
  const glm::dvec4 z = rays.parallel ? (static_cast<double>(far) * one - t) / depth : static_cast<double>(near) * one;
  return Mat4(glm::transpose(glm::dmat4(2.0 * x - w, 2.0 * y - w, z, w)));
}

WindowRays window_rays(const View& view, const Vec2& offset, const Vec2& u_lens, float time) {
  const auto ray = [&](int x, int y) {
    const Vec2 raster = Vec2(static_cast<float>(x), static_cast<float>(y)) + offset;
    return view.camera.sample_ray(raster, u_lens, time).ray;
  };
  const PixelWindow& w = view.window;
  const Ray a = ray(w.x0, w.y0), b = ray(w.x0 + w.width(), w.y0), c = ray(w.x0, w.y0 + w.height()),
            d = ray(w.x0 + w.width(), w.y0 + w.height());
  WindowRays rays;
  rays.eye = a.origin;
  if (a.direction == b.direction && a.direction == c.direction) {
    rays.parallel = true;
    rays.corner = a.origin;
    rays.right = b.origin - a.origin;
    rays.down = c.origin - a.origin;
    rays.axis = a.direction;
    return rays;
  }
  if (a.origin != b.origin || a.origin != c.origin || a.origin != d.origin)
    throw Error("a rasteriser draws for perspective and orthographic cameras only");
  set_perspective(rays, a.direction, b.direction, c.direction, d.direction);
  // All rays of a spherical camera start at one point, too, but its central ray is not the one in the middle of the
  // corners.
  const Vec2 middle =
      0.5f * Vec2(static_cast<float>(w.x0 + w.x0 + w.width()), static_cast<float>(w.y0 + w.y0 + w.height()));
  const Direction centre = view.camera.sample_ray(middle + offset, u_lens, time).ray.direction;
  if (!(dot(centre, normalize(rays.corner + 0.5f * (rays.right + rays.down))) > 1 - 1e-5f))
    throw Error("a rasteriser draws for perspective and orthographic cameras only");
  return rays;
}

ViewFocus focus_of(const Scene& scene, const View& view) {
  const float time = view.camera.time(0);
  const WindowRays rays = window_rays(view, Vec2(0), Vec2(0.5f), time);
  const std::vector<Point> seen = seen_points(scene, rays, time);
  ViewFocus focus;
  if (seen.empty()) return focus;
  focus.centre = rays.parallel ? median_of(seen) : rays.eye;
  std::vector<float> distances;
  distances.reserve(seen.size());
  for (const Point& p : seen) distances.push_back(std::sqrt(distance_squared(p, focus.centre)));
  focus.distance = median(std::move(distances));
  return focus;
}

float seen_radius(const Scene& scene, const View& view) {
  constexpr float most_distances = 4;
  return std::min(scene.bounding_sphere().radius, most_distances * focus_of(scene, view).distance);
}

}  // namespace lanthorn
