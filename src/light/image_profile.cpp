// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/image_profile.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "math/octahedral.h"
#include "math/sampling.h"

namespace lanthorn {
namespace {

Vec2 image_point(SphereLayout layout, const Direction& d) {
  if (layout == SphereLayout::octahedral) return octahedral_from_direction(d);
  const float phi = d.x == 0 && d.y == 0 ? 0.0f : std::atan2(d.y, d.x);
  const float u = phi / (2 * pi);
  return {u < 0 ? std::fmin(u + 1, one_minus_epsilon) : u, std::atan2(std::hypot(d.x, d.y), d.z) / pi};
}

Direction direction_at(SphereLayout layout, const Vec2& uv) {
  if (layout == SphereLayout::octahedral) return direction_from_octahedral(uv);
  const float phi = 2 * pi * uv.x, theta = pi * uv.y, sin = std::sin(theta);
  return {sin * std::cos(phi), sin * std::sin(phi), std::cos(theta)};
}

/// Replaces each value by the mean of the bilinear interpolation over its texel: a kernel of 1/8, 3/4, 1/8 along both
/// axes.
std::vector<float> means_of_bilinear(const std::vector<float>& values, int width, int height) {
  const auto at = [&](int x, int y) {
    const int column = (x + width) % width, row = std::clamp(y, 0, height - 1);
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
  };
  std::vector<float> result;
  result.reserve(values.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto row = [&](int r) { return 0.125f * (at(x - 1, r) + at(x + 1, r)) + 0.75f * at(x, r); };
      result.push_back(0.125f * (row(y - 1) + row(y + 1)) + 0.75f * row(y));
    }
  return result;
}

}  // namespace

SphericalImage::SphericalImage(SphereLayout layout_, int width_, int height_, LightTexels rows)
    : layout(layout_), width(width_), height(height_), texels(std::move(rows)) {
  assert(width > 0 && height > 0 &&
         texels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  assert(layout != SphereLayout::octahedral || width == height);
  texels.clean();
  std::vector<float> weights;
  weights.reserve(texels.size());
  for (std::size_t i = 0; i < texels.size(); ++i) weights.push_back(luminance(texels[i]));
  if (layout == SphereLayout::equirectangular) weights = means_of_bilinear(weights, width, height);
  const float to_share =
      static_cast<float>(texels.size()) / (4 * pi);  // ratio of a texel's share of the sphere to its share of the image
  for (std::size_t i = 0; i < weights.size(); ++i)
    weights[i] *= to_share * solid_angle_of_texel(static_cast<int>(i / static_cast<std::size_t>(width)));
  distribution_ =
      PiecewiseConstant2d(std::move(weights), static_cast<std::size_t>(width), static_cast<std::size_t>(height));
  mean_luminance = distribution_.integral();
}

float SphericalImage::solid_angle_of_texel(int y) const {
  if (layout == SphereLayout::octahedral) return 4 * pi / static_cast<float>(texels.size());
  const float top = pi * static_cast<float>(y) / static_cast<float>(height),
              half = 0.5f * pi / static_cast<float>(height);
  return 2 * pi / static_cast<float>(width) * 2 * std::sin(top + half) * std::sin(half);
}

Direction SphericalImage::direction_of_texel(int x, int y) const {
  return direction_at(layout, {(static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                               (static_cast<float>(y) + 0.5f) / static_cast<float>(height)});
}

Rgb SphericalImage::wrapped_texel(int x, int y) const {
  const int column = (x + width) % width, row = std::clamp(y, 0, height - 1);
  return texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
}

Rgb SphericalImage::bilinear(const Vec2& uv) const {
  const float x = uv.x * static_cast<float>(width) - 0.5f, y = uv.y * static_cast<float>(height) - 0.5f;
  const auto x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const auto row = [&](int r) { return (1 - fx) * wrapped_texel(x0, r) + fx * wrapped_texel(x0 + 1, r); };
  return (1 - fy) * row(y0) + fy * row(y0 + 1);
}

/// Ratio of the density per solid angle to the density in the image.
float SphericalImage::density_factor(const Direction& d) const {
  if (layout == SphereLayout::octahedral) return pdf_uniform_sphere;
  return 1 / (2 * pi * pi * std::hypot(d.x, d.y));
}

Rgb SphericalImage::colour(const Direction& d) const {
  const Vec2 uv = image_point(layout, d);
  return layout == SphereLayout::octahedral ? texels[distribution_.cell(uv)] : bilinear(uv);
}

float SphericalImage::pdf(const Direction& d) const {
  return distribution_.pdf(image_point(layout, d)) * density_factor(d);
}

Vec2 SphericalImage::invert(const Direction& d) const { return distribution_.invert(image_point(layout, d)); }

std::optional<SphericalImage::Sample> SphericalImage::sample(const Vec2& u) const {
  const std::optional<PiecewiseConstant2d::Sample> s = distribution_.sample(u);
  if (!s) return {};
  Sample result;
  result.direction = direction_at(layout, s->at);
  result.pdf = s->pdf * density_factor(result.direction);
  if (!std::isfinite(result.pdf)) return {};
  result.colour = layout == SphereLayout::octahedral ? texels[s->cell] : bilinear(s->at);
  return result;
}

}  // namespace lanthorn
