// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/emission_guide.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>

#include "math/frame.h"
#include "math/sampling.h"

namespace lanthorn {

namespace {

// The disks in the plane across the photons' direction; coordinates from the scene's centre.
struct DisksAcross {
  const AimedDisks& disks;
  Frame frame;
  Vec2 aim;

  DisksAcross(const AimedDisks& disks_, const Direction& direction)
      : disks(disks_), frame(-direction), aim(across(disks_.centre)) {}

  Vec2 across(const Point& p) const {
    const Vec3 local = frame.to_local(p - disks.scene.centre);
    return {local.x, local.y};
  }
  Vec2 centre(int disk) const { return disk == AimedDisks::count - 1 ? Vec2(0) : aim; }
};

// Photons of far lights start on the disks, except photons of a portal light, which start at the portal.
bool starts_on_disks(const Light& light) { return is_far(light) && !std::holds_alternative<PortalLight>(light); }

TreeDistribution::SomeNumbers numbers_of(const EmissionNumbers& u) {
  TreeDistribution::SomeNumbers result;
  for (const auto& [first, given] : {std::pair<std::size_t, std::optional<Vec2>>{0, u.position}, {2, u.direction}})
    if (given) {
      result[first] = given->x;
      result[first + 1] = given->y;
    }
  return result;
}

}  // namespace

AimedDisks::AimedDisks(const BoundingSphere& scene_, const Point& centre_, float smallest)
    : scene(scene_), centre(centre_) {
  for (int disk = 0; disk < count; ++disk)
    radius_[static_cast<unsigned>(disk)] =
        smallest * std::pow(scene.radius / smallest, static_cast<float>(disk) / (count - 1));
}

void AimedDisks::move(EmissionSample& emission, const Vec2& u) const {
  const DisksAcross disks(*this, emission.direction);
  const int chosen = std::min(count - 1, static_cast<int>(u.x * count));
  const Vec2 p =
      disks.centre(chosen) + radius(chosen) * sample_concentric_disk({u.x * count - static_cast<float>(chosen), u.y});
  if (dot(p, p) > sqr(scene.radius)) {
    emission.flux = Spectrum();
    return;
  }
  float density = 0;  // times pi
  for (int disk = 0; disk < count; ++disk) {
    const float r2 = sqr(radius(disk));
    const Vec2 from_centre = p - disks.centre(disk);
    if (disk == chosen || dot(from_centre, from_centre) <= r2) density += 1 / (count * r2);
  }
  emission.origin = scene.centre + disks.frame.to_world({p.x, p.y, scene.radius});
  emission.flux *= 1 / (sqr(scene.radius) * density);
}

float AimedDisks::density(const Point& p, const Direction& direction, const TreeDistribution& numbers,
                          const std::optional<Vec2>& u_direction, float enough) const {
  const DisksAcross disks(*this, direction);
  TreeDistribution::SomeNumbers at = numbers_of({{}, u_direction});
  const auto by = [&](int disk, const Vec2& square) {
    const Vec2 u = glm::clamp(0.5f * (square / radius(disk) + Vec2(1)), Vec2(0), Vec2(one_minus_epsilon));
    at[0] = (static_cast<float>(disk) + u.x) / count;
    at[1] = u.y;
    return numbers.pdf(at) * sqr(scene.radius / radius(disk)) / count;
  };
  const Vec2 place = disks.across(p), off_aim = place - disks.aim, square = square_from_disk(off_aim);
  float sum = by(count - 1, square_from_disk(place));
  for (int disk = 0; disk < count - 1 && sum < enough; ++disk)
    if (dot(off_aim, off_aim) <= sqr(radius(disk))) sum += by(disk, square);
  return sum;
}

float guided_density(const EmissionGuide& guide, const Light& light, std::uint32_t index, const EmitterHit& origin,
                     const Direction& direction, float enough) {
  const EmissionNumbers u = invert_emission(light, origin, direction);
  const TreeDistribution& numbers = guide.lights[index].numbers;
  if (guide.disks && starts_on_disks(light))
    return guide.disks->density(origin.position, direction, numbers, u.direction, enough);
  return numbers.pdf(numbers_of(u));
}

std::optional<EmissionSample> sample_emission(const Light& light, const AimedDisks* disks,
                                              const TreeDistribution::Numbers& u, const Wavelengths& w) {
  std::optional<EmissionSample> emission = sample_emission(light, {u[0], u[1]}, {u[2], u[3]}, w);
  if (emission && disks && starts_on_disks(light)) disks->move(*emission, {u[0], u[1]});
  return emission;
}

}  // namespace lanthorn
