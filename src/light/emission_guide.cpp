// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/emission_guide.h"

#include <algorithm>
#include <cmath>

#include "math/frame.h"
#include "math/sampling.h"

namespace lanthorn {

float AimedDisks::radius(int disk) const {
  return smallest * std::pow(scene.radius / smallest, static_cast<float>(disk) / (count - 1));
}

void AimedDisks::move(EmissionSample& emission, const Vec2& u) const {
  const Frame frame(-emission.direction);
  const Vec3 aim = frame.to_local(centre - scene.centre);
  const auto centre_of = [&](int disk) { return disk == count - 1 ? Vec2(0) : Vec2(aim.x, aim.y); };
  const int chosen = std::min(count - 1, static_cast<int>(u.x * count));
  const Vec2 p =
      centre_of(chosen) + radius(chosen) * sample_concentric_disk({u.x * count - static_cast<float>(chosen), u.y});
  if (dot(p, p) > sqr(scene.radius)) {
    emission.flux = Spectrum();
    return;
  }
  float density = 0;  // times pi
  for (int disk = 0; disk < count; ++disk) {
    const float r2 = sqr(radius(disk));
    const Vec2 from_centre = p - centre_of(disk);
    if (disk == chosen || dot(from_centre, from_centre) <= r2) density += 1 / (count * r2);
  }
  emission.origin = scene.centre + frame.to_world({p.x, p.y, scene.radius});
  emission.flux *= 1 / (sqr(scene.radius) * density);
}

std::optional<EmissionSample> sample_emission(const Light& light, const AimedDisks* disks,
                                              const TreeDistribution::Numbers& u, const Wavelengths& w) {
  std::optional<EmissionSample> emission = sample_emission(light, {u[0], u[1]}, {u[2], u[3]}, w);
  // A portal's photons start at the portal.
  if (emission && disks && is_far(light) && !emission->from_infinity) disks->move(*emission, {u[0], u[1]});
  return emission;
}

}  // namespace lanthorn
