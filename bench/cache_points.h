// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Point sets for the benchmarks of the point indices.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "math/hash.h"
#include "math/sampling.h"
#include "math/vec.h"

namespace lanthorn::bench {

/// Uniform in the unit cube.
inline std::vector<Point> uniform_points(std::size_t count, std::uint64_t seed) {
  HashRng rng(seed);
  std::vector<Point> points(count);
  for (Point& p : points) p = {rng.next(), rng.next(), rng.next()};
  return points;
}

/// A room of side 2 with two balls in it, rotated about an oblique axis unless `aligned`, so that no surface is
/// parallel to the axes.
class Room {
 public:
  explicit Room(bool aligned) {
    if (aligned) return;
    const Vec3 n = normalize(Vec3(1, 2, 3));
    const Vec3 s = normalize(cross(n, Vec3(0.3f, -1, 0.2f)));
    x_ = s, y_ = cross(n, s), z_ = n;
  }

  /// A point on one of the surfaces, uniform by area, but with eight times the density on the balls (as for caustics).
  Point sample(HashRng& rng) const {
    constexpr float ball_area = 8 * 4 * pi * radius * radius;
    float u = rng.next() * (24 + 2 * ball_area);
    if (u >= 24) return to_world(centre(u < 24 + ball_area) + radius * sample_uniform_sphere(rng.next2()));
    const auto wall = static_cast<int>(u / 4);
    Point p{2 * rng.next() - 1, 2 * rng.next() - 1, 2 * rng.next() - 1};
    p[wall % 3] = wall < 3 ? -1.0f : 1.0f;
    return to_world(p);
  }

  /// Traces a ray from the middle of one wall through pixel (x, y) of a square image, and returns the point that it
  /// hits.
  Point seen(float x, float y) const {
    const Point eye{0, 0, -0.999f};
    const Vec3 d = normalize(Vec3(2 * x - 1, 2 * y - 1, 1.0f));
    float t = infinity;
    for (int axis = 0; axis < 3; ++axis) t = std::fmin(t, (std::copysign(1.0f, d[axis]) - eye[axis]) / d[axis]);
    for (const bool left : {false, true}) {
      const Vec3 c = eye - centre(left);
      const float b = dot(c, d), q = b * b - dot(c, c) + radius * radius;
      if (q > 0 && -b - std::sqrt(q) > 0) t = std::fmin(t, -b - std::sqrt(q));
    }
    return to_world(eye + t * d);
  }

 private:
  static constexpr float radius = 0.35f;
  static Point centre(bool left) { return left ? Point{-0.5f, -0.65f, 0.2f} : Point{0.45f, -0.65f, -0.1f}; }
  Point to_world(const Point& p) const { return p.x * x_ + p.y * y_ + p.z * z_; }

  Vec3 x_{1, 0, 0}, y_{0, 1, 0}, z_{0, 0, 1};
};

inline std::vector<Point> surface_points(std::size_t count, std::uint64_t seed, bool aligned = false) {
  HashRng rng(seed);
  const Room room(aligned);
  std::vector<Point> points(count);
  for (Point& p : points) p = room.sample(rng);
  return points;
}

/// First hits of a side × side image, in scan order, with a jittered position in each pixel.
inline std::vector<Point> eye_points(int side, std::uint64_t seed, bool aligned = false) {
  HashRng rng(seed);
  const Room room(aligned);
  std::vector<Point> points;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      points.push_back(room.seen((static_cast<float>(x) + rng.next()) / static_cast<float>(side),
                                 (static_cast<float>(y) + rng.next()) / static_cast<float>(side)));
  return points;
}

}  // namespace lanthorn::bench
