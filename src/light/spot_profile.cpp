// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/spot_profile.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "light/brightness.h"
#include "math/frame.h"
#include "math/sampling.h"

namespace lanthorn {
namespace {

float smoothstep(float x) { return x * x * (3 - 2 * x); }

/// Samples x in [0,1] with density 2 smoothstep(x): the root of 2x³ - x⁴ = u, by Newton's method with bracketing.
float sample_smoothstep(float u) {
  float low = 0, high = 1;
  float x = std::cbrt(0.5f * u);  // the root for small u, and near it for all
  for (int i = 0; i < 8; ++i) {
    const float error = x * x * x * (2 - x) - u;
    (error > 0 ? high : low) = x;
    const float next = x - error / std::fmax(2 * smoothstep(x), 1e-20f);
    if (std::fabs(next - x) <= 1e-7f * x) return std::clamp(next, 0.0f, 1.0f);
    x = next > low && next < high ? next : 0.5f * (low + high);
  }
  return x;
}

using Falloff = SpotProfile::Falloff;

/// The falloff at the fraction x of the way from the outer cone to the inner one.
float intensity_at(Falloff shape, float x) { return shape == Falloff::square ? x * x : smoothstep(x); }

/// Integral of `intensity_at` over x in [0,1].
float mean_intensity(Falloff shape) { return shape == Falloff::square ? 1.0f / 3 : 0.5f; }

/// Samples x in [0,1] with density proportional to `intensity_at`.
float sample_falloff(Falloff shape, float u) { return shape == Falloff::square ? std::cbrt(u) : sample_smoothstep(u); }

/// Fraction of the integral of `intensity_at` that lies below x: the inverse of `sample_falloff`.
float part_below(Falloff shape, float x) { return shape == Falloff::square ? x * x * x : x * x * x * (2 - x); }

float one_minus_cos(float angle) { return 2 * sqr(std::sin(0.5f * angle)); }

}  // namespace

SpotProfile::SpotProfile(const Direction& axis_, const SpectrumCurve& intensity_, float start_angle, float total_angle,
                         Falloff shape_)
    : axis(axis_),
      intensity(intensity_),
      one_minus_cos_start(one_minus_cos(start_angle)),
      one_minus_cos_total(one_minus_cos(total_angle)),
      shape(shape_) {
  assert(start_angle >= 0 && start_angle <= total_angle);
}

float SpotProfile::falloff(const Direction& direction) const {
  const float h = 0.5f * distance_squared(direction, axis);
  if (h >= one_minus_cos_total) return 0;
  if (h <= one_minus_cos_start) return 1;
  return intensity_at(shape, (one_minus_cos_total - h) / (one_minus_cos_total - one_minus_cos_start));
}

// The falloff's integral over 1 - cos is `start` in the inner cone and its mean times `total - start` around it.
float SpotProfile::solid_angle() const {
  return 2 * pi * (one_minus_cos_start + mean_intensity(shape) * (one_minus_cos_total - one_minus_cos_start));
}

std::optional<ProfileSample> SpotProfile::sample(const Vec2& u, const Wavelengths& w) const {
  if (!(one_minus_cos_total > 0)) return {};
  const float border = one_minus_cos_total - one_minus_cos_start;
  // In units of 1 - cos: the inner cone has weight `start`, the falloff region its width times the mean.
  const float outside = mean_intensity(shape) * border;
  const float x = u.x * (one_minus_cos_start + outside);
  const bool inner = x < one_minus_cos_start;
  const float step = inner ? 1.0f : sample_falloff(shape, std::fmin(1.0f, (x - one_minus_cos_start) / outside));
  const float h = inner ? x : one_minus_cos_total - step * border;
  const float r = safe_sqrt(h * (2 - h)), phi = 2 * pi * u.y;
  const float value = intensity_at(shape, step);
  return ProfileSample{Frame(axis).to_world({r * std::cos(phi), r * std::sin(phi), 1 - h}),
                       intensity.evaluate(w) * value, value / solid_angle()};
}

std::optional<Vec2> SpotProfile::invert(const Direction& direction) const {
  const float border = one_minus_cos_total - one_minus_cos_start, outside = mean_intensity(shape) * border;
  const float h = std::min(0.5f * distance_squared(direction, axis), one_minus_cos_total);
  const float x = h < one_minus_cos_start
                      ? h
                      : one_minus_cos_start + outside * part_below(shape, (one_minus_cos_total - h) / border);
  const Vec3 local = Frame(axis).to_local(direction);
  const float inner = std::min(x / (one_minus_cos_start + outside), one_minus_epsilon);
  return Vec2(inner, turn_around_z(local.x, local.y));
}

float SpotProfile::integral() const { return luminance(intensity.rgb) * solid_angle(); }

float SpotProfile::largest() const { return largest_value(intensity); }

ProfileBounds SpotProfile::bounds() const {
  // At most the last 60 degrees of the cone count as emission around the normals, because the importance falls with the
  // cosine to them.
  const float total = std::acos(std::clamp(1 - one_minus_cos_total, -1.0f, 1.0f));
  const float start = std::acos(std::clamp(1 - one_minus_cos_start, -1.0f, 1.0f));
  const float normals = std::fmax(start, total - pi / 3);
  return {{axis, std::cos(normals)}, std::cos(total - normals), luminance(intensity.rgb)};
}

}  // namespace lanthorn
