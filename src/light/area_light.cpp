// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/area_light.h"

#include <algorithm>

#include "light/emitter_sampling.h"
#include "math/frame.h"
#include "math/sampling.h"

namespace lanthorn {

namespace {

/// True if `from` lies on the dark side of a flat emitter: tested before any sampling.
bool is_behind(const AreaLight& light, const Point& from) {
  const auto height = [&](const Point& on_plane, const Normal& n) {
    return dot(from - on_plane, light.flip_normal ? -n : n);
  };
  if (const auto* triangle = std::get_if<TriangleEmitter>(&light.shape))
    return height(triangle->p[0], triangle->normal) <= 0;
  if (const auto* flat = std::get_if<ParallelogramEmitter>(&light.shape)) return height(flat->p00, flat->normal) <= 0;
  if (const auto* disk = std::get_if<DiskEmitter>(&light.shape)) return height(disk->centre, disk->normal) <= 0;
  return false;
}

struct LeavingRay {
  EmitterPoint at;
  Direction direction{0, 0, 1};
};

/// A ray that leaves a round sphere of radius R on the side given by `outward`: first its direction, then its position
/// on the disk that the sphere projects along it. The density, 1 / 4π times cos / πR², equals the density of a uniform
/// point and a cosine-distributed direction, 1 / 4πR² times cos / π. Here the direction depends on two of the numbers
/// only, which guides can therefore learn.
LeavingRay sample_leaving_ray(const SphereEmitter& sphere, bool outward, const Vec2& u_position,
                              const Vec2& u_direction) {
  const Direction direction = sample_uniform_sphere(u_direction);
  const Vec2 d = sample_concentric_disk(u_position);
  const Normal facing = Frame(direction).to_world({d.x, d.y, safe_sqrt(1 - dot(d, d))});
  const Normal natural = outward ? facing : -facing;
  return {{sphere.centre + sphere.world_radius * natural, natural}, direction};
}

}  // namespace

Spectrum AreaLight::radiance_at(const Point& drawn, const Normal& normal, const Wavelengths& w) const {
  return pattern != nullptr ? pattern->drawn(primitive, drawn, normal, w) * pattern_scale : radiance.evaluate(w);
}

float AreaLight::density_at(const Point& point) const {
  const std::optional<Vec2> u = brightness != nullptr ? invert_sample_area(shape, point) : std::nullopt;
  return u ? brightness->pdf(*u) : 1;
}

EmitterPoint AreaLight::sample_position(const Vec2& u) const {
  const std::optional<PiecewiseConstant2d::Sample> s = brightness != nullptr ? brightness->sample(u) : std::nullopt;
  return sample_area(shape, s ? s->at : u);
}

// Half of the points follow the pattern's brightness, half are drawn as if the pattern were uniform: close to the
// light, solid angles matter more than brightness.
std::optional<EmitterDirection> AreaLight::draw_towards(const Point& from, const Vec2& u) const {
  if (brightness == nullptr) return sample_towards(shape, from, u);
  const bool even = u.x >= 0.5f;
  const Vec2 rest(2 * u.x - (even ? 1.0f : 0.0f), u.y);
  std::optional<EmitterDirection> s =
      even ? sample_towards(shape, from, rest) : direction_to(sample_position(rest), area(shape), from);
  if (s) s->pdf = pdf_of_drawn(from, s->point, s->normal);
  return s;
}

float AreaLight::pdf_of_drawn(const Point& from, const Point& hit, const Normal& normal) const {
  const float even = pdf_towards(shape, from, hit, normal);
  if (brightness == nullptr) return even;
  return 0.5f * (even + density_at(hit) * pdf_by_area(area(shape), from, hit, normal));
}

std::optional<LightSample> AreaLight::sample_direct(const Point& from, const Vec2& u, const Wavelengths& w) const {
  std::optional<LightSample> result;
  if (!two_sided && is_behind(*this, from)) return result;
  const std::optional<EmitterDirection> s = draw_towards(from, u);
  if (!s) return result;
  const Normal normal = flip_normal ? -s->normal : s->normal;
  const float factor = factor_towards(normal, -s->wi);
  if (!(factor > 0)) return result;
  LightSample& sample = result.emplace();
  sample.wi = s->wi;
  sample.position = s->point;
  sample.normal = normal;
  sample.distance = s->distance;
  sample.position_error = position_error + tracing_error * s->distance;
  sample.radiance = radiance_at(s->point, normal, w) * factor;
  sample.pdf = s->pdf;
  sample.delta = invisible;
  return result;
}

float AreaLight::pdf_direct(const Point& from, const EmitterHit& hit) const {
  return pdf_of_drawn(from, hit.position, hit.normal);
}

Spectrum AreaLight::emitted(const EmitterHit& hit, const Direction& direction, const Wavelengths& w) const {
  const float factor = factor_towards(hit.normal, direction);
  if (!(factor > 0)) return {};
  return (pattern != nullptr ? pattern->seen(primitive, hit, w) * pattern_scale : radiance.evaluate(w)) * factor;
}

const SphereEmitter* AreaLight::leaves_by_direction() const {
  const auto* const sphere = std::get_if<SphereEmitter>(&shape);
  return sphere != nullptr && sphere->world_radius > 0 && !two_sided && brightness == nullptr && spread.is_diffuse()
             ? sphere
             : nullptr;
}

std::optional<EmissionSample> AreaLight::sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                         const Wavelengths& w) const {
  std::optional<EmissionSample> result;
  if (!(area(shape) > 0)) return result;
  if (const SphereEmitter* const sphere = leaves_by_direction()) {
    const LeavingRay ray = sample_leaving_ray(*sphere, !flip_normal, u_position, u_direction);
    emit(ray.at, 1, ray.direction, w, result.emplace());
    return result;
  }
  const EmitterPoint at = sample_position(u_position);
  // One half of the random numbers for each side.
  const bool back = two_sided && u_direction.x >= 0.5f;
  const Vec2 u = two_sided ? Vec2(2 * u_direction.x - (back ? 1.0f : 0.0f), u_direction.y) : u_direction;
  const Normal normal = flip_normal ? -at.normal : at.normal;
  const Direction direction = Frame(back ? -normal : normal).to_world(spread.sample(u));
  emit(at, density_at(at.point), direction, w, result.emplace());
  return result;
}

void AreaLight::emit(const EmitterPoint& at, float density, const Direction& direction, const Wavelengths& w,
                     EmissionSample& sample) const {
  const float total = area(shape), sides = two_sided ? 2.0f : 1.0f;
  sample.origin = at.point;
  sample.normal = flip_normal ? -at.normal : at.normal;
  sample.position_error = position_error;
  sample.direction = direction;
  sample.cos_origin = std::fabs(dot(sample.normal, direction));
  // The cosine cancels: all photons of a diffuse light carry the same flux (about the same if it has a pattern).
  const float cone = spread.is_diffuse() ? 1.0f : sqr(spread.sin()) * spread.factor(sample.cos_origin);
  sample.flux = radiance_at(sample.origin, sample.normal, w) * (pi * total * sides * cone / density);
  sample.pdf_position = density / total;
  sample.pdf_direction = spread.pdf(sample.cos_origin) / sides;
}

EmissionPdf AreaLight::pdf_emission(const EmitterHit& origin, const Direction& direction) const {
  const float cos = dot(origin.normal, direction);
  const float pdf = two_sided ? 0.5f * spread.pdf(std::fabs(cos)) : spread.pdf(std::max(0.0f, cos));
  return {density_at(origin.position) / area(shape), pdf};
}

EmissionNumbers AreaLight::invert_emission(const EmitterHit& origin, const Direction& direction) const {
  if (leaves_by_direction() != nullptr) {
    const Vec3 facing = Frame(direction).to_local(origin.normal);
    return {invert_concentric_disk({facing.x, facing.y}), invert_uniform_sphere(direction)};
  }
  const bool back = two_sided && dot(origin.normal, direction) < 0;
  const Vec3 local = Frame(back ? -origin.normal : origin.normal).to_local(direction);
  Vec2 u = spread.invert(local);
  if (two_sided) u.x = 0.5f * (u.x + (back ? 1.0f : 0.0f));
  const std::optional<Vec2> even = invert_sample_area(shape, origin.position);
  return {even && brightness != nullptr ? brightness->invert(*even) : even, u};
}

float AreaLight::power() const { return luminance(radiance.rgb) * pi * area(shape) * (two_sided ? 2.0f : 1.0f); }

float AreaLight::largest_radiance(float /*has extent*/) const { return spread.peak() * largest_value(radiance); }

EmissionBounds AreaLight::bounds() const {
  NormalCone cone = normal_cone(shape);
  if (flip_normal) cone.axis = -cone.axis;
  // A surface with normals in all directions shows about a quarter of its area to any side (Cauchy's formula, exact for
  // the sphere).
  const float shown = cone.cos > -1 ? 1.0f : 0.25f;
  const float intensity = spread.peak() * luminance(radiance.rgb) * area(shape) * shown;
  return {lanthorn::bounds(shape), cone, spread.cos(), intensity, two_sided};
}

}  // namespace lanthorn
