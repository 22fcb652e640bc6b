// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/photonmap/irradiance_cache.h"

#include <algorithm>

namespace lanthorn {

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
