// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "ibl/cube_map.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <utility>

#include "base/parallel.h"

namespace lanthorn {

namespace {

// A direction in a face's coordinates; `major` is the component along the face's axis.
struct FaceCoordinates {
  float s, t, major;
};
// From the OpenGL specification, table of cube map face selection.
FaceCoordinates on_face(int face, const Vec3& d) {
  switch (face) {
    case 0:
      return {-d.z, -d.y, d.x};
    case 1:
      return {d.z, -d.y, -d.x};
    case 2:
      return {d.x, d.z, d.y};
    case 3:
      return {d.x, -d.z, -d.y};
    case 4:
      return {d.x, -d.y, d.z};
    default:
      return {-d.x, -d.y, -d.z};
  }
}
Vec2 place_of(const FaceCoordinates& c) { return {0.5f * (c.s / c.major + 1), 0.5f * (c.t / c.major + 1)}; }

int face_of(const Vec3& d) {
  const float ax = std::fabs(d.x), ay = std::fabs(d.y), az = std::fabs(d.z);
  if (ax >= ay && ax >= az) return d.x >= 0 ? 0 : 1;
  if (ay >= az) return d.y >= 0 ? 2 : 3;
  return d.z >= 0 ? 4 : 5;
}

}  // namespace

CubePoint cube_point(const Vec3& d) {
  const int face = face_of(d);
  return {face, place_of(on_face(face, d))};
}

std::optional<Vec2> place_on_face(int face, const Direction& d) {
  constexpr float most_oblique = 0.25f;  // the corners of a face are at 1 / sqrt(3)
  const FaceCoordinates c = on_face(face, d);
  return c.major > most_oblique ? std::optional(place_of(c)) : std::nullopt;
}

CubeTexel cube_texel(const CubePoint& place, int size) {
  const auto texel = [&](float v) { return std::clamp(static_cast<int>(v * static_cast<float>(size)), 0, size - 1); };
  return {place.face, texel(place.at.x), texel(place.at.y)};
}

Direction cube_direction(int face, const Vec2& at) {
  const float s = 2 * at.x - 1, t = 2 * at.y - 1;
  switch (face) {
    case 0:
      return normalize(Vec3(1, -t, -s));
    case 1:
      return normalize(Vec3(-1, -t, s));
    case 2:
      return normalize(Vec3(s, 1, t));
    case 3:
      return normalize(Vec3(s, -1, -t));
    case 4:
      return normalize(Vec3(s, -t, 1));
    default:
      return normalize(Vec3(-s, -t, -1));
  }
}

CubeMap::CubeMap(int size)
    : size_(size), texels_(static_cast<std::size_t>(cube_faces * (size + 2)) * static_cast<std::size_t>(size + 2)) {
  assert(size > 0);
}

void CubeMap::close_seams() {
  const int last = size_ - 1;
  // Slightly beyond the edge, so that the position along it is the same on both faces.
  constexpr float beyond = 1e-5f;
  const auto neighbour = [&](int face, float x, float y) {
    return texel(cube_texel(cube_point(cube_direction(face, {x, y})), size_));
  };
  for (int face = 0; face < cube_faces; ++face) {
    for (int i = 0; i < size_; ++i) {
      const float along = (static_cast<float>(i) + 0.5f) / static_cast<float>(size_);
      texel(face, -1, i) = neighbour(face, -beyond, along);
      texel(face, size_, i) = neighbour(face, 1 + beyond, along);
      texel(face, i, -1) = neighbour(face, along, -beyond);
      texel(face, i, size_) = neighbour(face, along, 1 + beyond);
    }
    // Three texels meet at a corner of the cube.
    for (const int x : {-1, size_})
      for (const int y : {-1, size_}) {
        const int inner_x = std::clamp(x, 0, last), inner_y = std::clamp(y, 0, last);
        texel(face, x, y) = (texel(face, inner_x, inner_y) + texel(face, x, inner_y) + texel(face, inner_x, y)) / 3.0f;
      }
  }
}

Spectrum CubeMap::lookup(const Direction& direction) const {
  const CubePoint p = cube_point(direction);
  const float x = p.at.x * static_cast<float>(size_) + 0.5f, y = p.at.y * static_cast<float>(size_) + 0.5f;
  const int x0 = std::min(static_cast<int>(x), size_), y0 = std::min(static_cast<int>(y), size_);
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const Spectrum* const corner = data() + index(p.face, x0 - 1, y0 - 1);
  return (1 - fy) * ((1 - fx) * corner[0] + fx * corner[1]) +
         fy * ((1 - fx) * corner[stride()] + fx * corner[stride() + 1]);
}

std::vector<float> cube_solid_angles(int size) {
  const auto n = static_cast<std::size_t>(size);
  // Solid angle of the rectangle from the centre of the face to (s, t).
  std::vector<double> corner((n + 1) * (n + 1));
  const auto coordinate = [&](std::size_t i) { return 2 * static_cast<double>(i) / static_cast<double>(size) - 1; };
  for (std::size_t j = 0; j <= n; ++j)
    for (std::size_t i = 0; i <= n; ++i) {
      const double s = coordinate(i), t = coordinate(j);
      corner[j * (n + 1) + i] = std::atan2(s * t, std::sqrt(s * s + t * t + 1));
    }
  std::vector<float> result(n * n);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      const double* const c = corner.data() + j * (n + 1) + i;
      result[j * n + i] = static_cast<float>(c[0] - c[1] - c[n + 1] + c[n + 2]);
    }
  return result;
}

namespace {

CubeMap half_of(const CubeMap& fine) {
  const std::vector<float> weights = cube_solid_angles(fine.size());
  CubeMap half(fine.size() / 2);
  const int n = half.size();
  parallel_for(0, cube_faces * n, [&](int row) {
    const int face = row / n, y = row % n;
    for (int x = 0; x < n; ++x) {
      Spectrum sum;
      float weight_sum = 0;
      for (const int j : {2 * y, 2 * y + 1})
        for (const int i : {2 * x, 2 * x + 1}) {
          const float weight = weights[static_cast<std::size_t>(j) * static_cast<std::size_t>(fine.size()) +
                                       static_cast<std::size_t>(i)];
          sum += weight * fine.texel(face, i, j);
          weight_sum += weight;
        }
      half.texel(face, x, y) = sum / weight_sum;
    }
  });
  half.close_seams();
  return half;
}

}  // namespace

CubePyramid cube_pyramid(CubeMap finest) {
  assert(std::has_single_bit(static_cast<unsigned>(finest.size())));
  CubePyramid levels{std::move(finest)};
  while (levels.back().size() > 1) levels.push_back(half_of(levels.back()));
  return levels;
}

Image strip_of(const CubeMap& map) {
  const int n = map.size();
  Image strip(cube_faces * n, n, {"R", "G", "B"});
  for (int y = 0; y < n; ++y)
    for (int column = 0; column < cube_faces * n; ++column)
      for (int c = 0; c < 3; ++c)
        strip.at(column, y, static_cast<std::size_t>(c)) = map.texel(column / n, column % n, y)[c];
  return strip;
}

CubeMap cube_of(const Image& strip) {
  const int n = strip.height;
  assert(strip.width == cube_faces * n && strip.channel_count() == 3);
  CubeMap map(n);
  for (int y = 0; y < n; ++y)
    for (int column = 0; column < cube_faces * n; ++column)
      for (int c = 0; c < 3; ++c)
        map.texel(column / n, column % n, y)[c] = strip.at(column, y, static_cast<std::size_t>(c));
  map.close_seams();
  return map;
}

}  // namespace lanthorn
