// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/photonmap/irradiance_cache.h"

#include <algorithm>
#include <cmath>

namespace lanthorn {

namespace {

// Mean of tan θ over a ring, for constant radiance within the ring. The tangent itself is unbounded.
float mean_tangent(float sin2_low, float sin2_high) {
  const auto integral = [](float s) { return std::asin(std::sqrt(s)) - safe_sqrt(s * (1 - s)); };
  return (integral(sin2_high) - integral(sin2_low)) / (sin2_high - sin2_low);
}

}  // namespace

HemisphereGrid::HemisphereGrid(int cells)
    : rings_(std::max(1, static_cast<int>(std::lround(std::sqrt(static_cast<float>(cells) * inv_pi))))),
      sectors_(std::max(4, cells / rings_)) {}

Vec3 HemisphereGrid::direction(int cell, const Vec2& u) const {
  const int ring = cell / sectors_;
  const float sin2 = (static_cast<float>(ring) + u.x) / static_cast<float>(rings_);
  const float phi = 2 * pi * (static_cast<float>(cell % sectors_) + u.y) / static_cast<float>(sectors_);
  const float sin = std::sqrt(sin2);
  return {sin * std::cos(phi), sin * std::sin(phi), safe_sqrt(1 - sin2)};
}

IrradianceRecord estimate_irradiance(const HemisphereGrid& grid, std::span<const HemisphereRay> rays,
                                     const Frame& frame) {
  const int rings = grid.rings(), sectors = grid.sectors();
  const auto ray = [&](int j, int k) -> const HemisphereRay& {
    const int index = j * sectors + (k + sectors) % sectors;
    return rays[static_cast<std::size_t>(index)];
  };
  const auto per_ring = [rings](int j) { return static_cast<float>(j) / static_cast<float>(rings); };
  const float width = 2 * pi / static_cast<float>(sectors);
  const float cell = pi / static_cast<float>(grid.cells());
  IrradianceRecord record;
  record.normal = frame.n;
  float inverse_distances = 0;
  for (int j = 0; j < rings; ++j) {
    // θ at the inner and outer edge of the ring.
    const float sin2 = per_ring(j), sin = std::sqrt(sin2), outer_sin = std::sqrt(per_ring(j + 1));
    const float tangent = mean_tangent(sin2, per_ring(j + 1));
    for (int k = 0; k < sectors; ++k) {
      const float middle = width * (static_cast<float>(k) + 0.5f), border = width * static_cast<float>(k);
      const Vec3 outward = frame.to_world({std::cos(middle), std::sin(middle), 0});
      const Vec3 around = frame.to_world({-std::sin(border), std::cos(border), 0});
      const HemisphereRay &here = ray(j, k), &before = ray(j, k - 1);
      record.irradiance += cell * here.radiance;
      record.rotation.add(outward, cell * tangent * here.radiance);
      inverse_distances += 1 / here.distance;
      // The edge between two cells belongs to the nearer of the two surfaces. It moves against the translation.
      record.translation.add(
          around, (outer_sin - sin) / std::min(here.distance, before.distance) * (here.radiance - before.radiance));
      if (j == 0) continue;
      const HemisphereRay& inner = ray(j - 1, k);
      record.translation.add(outward, width * sin * (1 - sin2) / std::min(here.distance, inner.distance) *
                                          (here.radiance - inner.radiance));
    }
  }
  record.distance = static_cast<float>(grid.cells()) / inverse_distances;
  const Vec3 slope(sum_of(record.translation.x), sum_of(record.translation.y), sum_of(record.translation.z));
  const float steepness = std::sqrt(length_squared(slope));
  if (steepness > 0) record.distance = std::min(record.distance, sum_of(record.irradiance) / steepness);
  return record;
}

// Estimated relative error, Ward et al. 1988, eq. 3: changes by translation and by rotation. Infinite if the record
// lies in front of the point's surface, where it could receive light that the point does not.
float IrradianceCache::estimated_error(const IrradianceRecord& record, const Point& p, const Normal& normal) {
  constexpr float least_slope = -0.1f;  // tolerates bumps and rounding
  const Vec3 offset = p - record.position;
  const float distance = std::sqrt(length_squared(offset));
  if (0.5f * dot(offset, normal + record.normal) < least_slope * distance) return infinity;
  return distance / record.radius() + safe_sqrt(1 - dot(normal, record.normal));
}

void IrradianceCache::insert(IrradianceRecord record) {
  constexpr float least_cosine = 0.5f;  // beyond, hemispheres overlap too little
  const auto clamp_by = [&](IrradianceRecord& one, const IrradianceRecord& other) {
    if (dot(one.normal, other.normal) < least_cosine) return;
    one.distance = std::min(one.distance, other.distance + std::sqrt(distance_squared(one.position, other.position)));
  };
  reach_.for_each_near(record.position, record.distance, [&](std::uint32_t id) { clamp_by(record, records_[id]); });
  reach_.for_each_around(record.position, [&](std::uint32_t id) { clamp_by(records_[id], record); });

  const auto id = static_cast<std::uint32_t>(records_.size());
  valid_.insert(id, record.position, smoothing * error_ * record.radius());
  reach_.insert(id, record.position, record.distance);
  records_.push_back(record);
}

bool IrradianceCache::covers(const Point& p, const Normal& normal, float limit) const {
  bool found = false;
  for_each_valid(p, normal, limit, [&](const IrradianceRecord&, float) { found = true; });
  return found;
}

// Weights fall to 0 at the end of a record's validity, so that no edge is visible there, and they are bounded, so that
// no single record is visible (Tabellion & Lamorlette 2004, "An Approximate Global Illumination System for Computer
// Generated Films").
std::optional<Spectrum> IrradianceCache::find(const Point& p, const Normal& normal) const {
  const float limit = smoothing * error_;
  Spectrum sum;
  float weights = 0;
  for_each_valid(p, normal, limit, [&](const IrradianceRecord& record, float e) {
    const float weight = 1 - e / limit;
    sum += weight * record.at(p, normal);
    weights += weight;
  });
  if (!(weights > 0)) return {};
  return map(sum / weights, [](float x) { return std::max(0.0f, x); });
}

}  // namespace lanthorn
