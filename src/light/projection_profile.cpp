// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/projection_profile.h"

#include <array>
#include <cassert>
#include <utility>

#include "light/brightness.h"
#include "spectrum/curve.h"

namespace lanthorn {
namespace {

// On the plane z = 1, d omega = cos³ dA.
float cube(float x) { return x * x * x; }

}  // namespace

ProjectionImage::ProjectionImage(int width_, int height_, LightTexels rows, float fov)
    : width(width_), height(height_), texels(std::move(rows)) {
  assert(width > 0 && height > 0 &&
         texels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const float half = std::tan(0.5f * fov), aspect = static_cast<float>(width) / static_cast<float>(height);
  half_size = aspect > 1 ? Vec2(half * aspect, half) : Vec2(half, half / aspect);
  texels.clean();
  std::vector<float> weights;
  weights.reserve(texels.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Rgb texel = texels[weights.size()];
      const Vec2 p(half_size.x * (2 * (static_cast<float>(x) + 0.5f) / static_cast<float>(width) - 1),
                   half_size.y * (2 * (static_cast<float>(y) + 0.5f) / static_cast<float>(height) - 1));
      weights.push_back(luminance(texel) * cube(1 / std::sqrt(1 + p.x * p.x + p.y * p.y)));
    }
  distribution_ =
      PiecewiseConstant2d(std::move(weights), static_cast<std::size_t>(width), static_cast<std::size_t>(height));
  integral = area() * distribution_.integral();
}

std::optional<Vec2> ProjectionImage::image_point(const Direction& d) const {
  if (!(d.z > 0)) return {};
  const Vec2 uv(0.5f + 0.5f * d.x / (d.z * half_size.x), 0.5f - 0.5f * d.y / (d.z * half_size.y));
  const bool inside = uv.x >= 0 && uv.x < 1 && uv.y >= 0 && uv.y < 1;
  return inside ? std::optional(uv) : std::nullopt;
}

Rgb ProjectionImage::colour(const Direction& d) const {
  const std::optional<Vec2> uv = image_point(d);
  return uv ? texels[distribution_.cell(*uv)] : Rgb{};
}

float ProjectionImage::pdf(const Direction& d) const {
  const std::optional<Vec2> uv = image_point(d);
  return uv ? distribution_.pdf(*uv) / (area() * cube(d.z)) : 0.0f;
}

std::optional<ProjectionImage::Sample> ProjectionImage::sample(const Vec2& u) const {
  const std::optional<PiecewiseConstant2d::Sample> s = distribution_.sample(u);
  if (!s) return {};
  const Vec3 on_plane(half_size.x * (2 * s->at.x - 1), half_size.y * (1 - 2 * s->at.y), 1);
  const float cos = 1 / std::sqrt(length_squared(on_plane));
  return Sample{on_plane * cos, texels[s->cell], s->pdf / (area() * cube(cos))};
}

std::optional<Vec2> ProjectionImage::invert(const Direction& d) const {
  const std::optional<Vec2> uv = image_point(d);
  return uv ? std::optional(distribution_.invert(*uv)) : std::nullopt;
}

float ProjectionImage::solid_angle() const {
  // Solid angle of a rectangle, seen from above its centre.
  const float x = half_size.x, y = half_size.y;
  return 4 * std::atan(x * y / std::sqrt(1 + x * x + y * y));
}

Spectrum ProjectionProfile::value(const Direction& d, const Wavelengths& w) const {
  return evaluate_illuminant(scale * image->colour(map.light_from_world(d).direction), w);
}

std::optional<ProfileSample> ProjectionProfile::sample(const Vec2& u, const Wavelengths& w) const {
  const std::optional<ProjectionImage::Sample> s = image->sample(u);
  if (!s) return {};
  const DirectionMap::Mapped away = map.world_from_light(s->direction);
  return ProfileSample{away.direction, evaluate_illuminant(scale * s->colour, w), s->pdf * away.compression};
}

float ProjectionProfile::pdf(const Direction& d) const {
  const DirectionMap::Mapped local = map.light_from_world(d);
  return image->pdf(local.direction) * local.compression;
}

std::optional<Vec2> ProjectionProfile::invert(const Direction& d) const {
  return image->invert(map.light_from_world(d).direction);
}

float ProjectionProfile::largest() const { return scale * largest_value(image->texels); }

NormalCone ProjectionProfile::cone() const {
  std::array<Direction, 4> corners;
  Vec3 sum(0);
  for (unsigned i = 0; i < 4; ++i) {
    const Vec3 corner((i & 1) != 0 ? image->half_size.x : -image->half_size.x,
                      (i & 2) != 0 ? image->half_size.y : -image->half_size.y, 1);
    corners[i] = map.world_from_light(normalize(corner)).direction;
    sum += corners[i];
  }
  // Great circles join the corners. The direction farthest from an axis at less than 90 degrees is therefore a corner.
  const Direction axis = normalize(sum);
  float cos = 1;
  for (const Direction& corner : corners) cos = std::fmin(cos, dot(axis, corner));
  return cos > 0 ? NormalCone{axis, cos} : NormalCone{};
}

}  // namespace lanthorn
