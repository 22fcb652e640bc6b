// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>

#include "lanthorn/error.h"
#include "lanthorn/rays.h"
#include "math/hash.h"
#include "scene/scene_data.h"
#include "scene/volume_lights.h"

namespace lanthorn {

namespace {

constexpr std::uint64_t flat_curve_seed = 0x68a17;  // distinguishes these hashes of rays from others

// At degenerate points, the position or normal may exceed single precision; such hits are ignored.
bool is_finite(const SurfaceGeometry& s) {
  const Vec3 sum = s.position + s.normal + s.shading_normal;
  return std::isfinite(sum.x + sum.y + sum.z) && std::isfinite(s.uv.x + s.uv.y);
}

// Completes a point of a flat curve: its axis, and the place across the width at which rays leave. That place is a
// function of the ray, because the same ray must meet the same scene.
void settle_flat_curve(SurfacePoint& p, const SurfaceGeometry& surface, const Ray& ray) {
  p.is_flat_curve = true;
  const float radius = 0.5f * std::sqrt(length_squared(surface.dpdv));
  const float side = dot(surface.dpdv, cross(p.normal, p.shading.s)) < 0 ? -1.0f : 1.0f;
  p.to_axis = side * radius * (1 - 2 * surface.uv.y);
  const float offset = 2 * unit_float(hash_vec(ray.direction, hash_vec(ray.origin, flat_curve_seed))) - 1;
  p.leaves_at = offset * radius;
  if (!is_fibre(p.bsdf)) return;
  p.is_hair = true;
  p.position = axis_of(p);
  p.to_axis = 0;
  if (const Hair* hair = std::get_if<Hair>(&p.bsdf.get())) {
    Hair facing = *hair;
    facing.h = 1 - 2 * surface.uv.y;  // v grows along the ray x the hair
    facing.h_out = offset;
    facing.is_on_surface = false;
    p.bsdf.emplace(facing);
  }
}

// Gives a point whose shading normal differs from the geometric one the closure of its facet. `smooth`: interpolated
// normal of the mesh; `rise`: of its smooth surface.
void bend_to_facet(SurfacePoint& p, const Normal& smooth, float rise) {
  // Below the error of the position, a ray that starts on the smooth surface would meet the facet.
  const bool bulges = std::fabs(rise) > position_error_across(p);
  const Normal& horizon = bulges ? smooth : p.normal;
  if (bend(p.bsdf, p.shading.to_local(p.normal), p.shading.to_local(horizon)) && bulges) p.rise = rise;
}

// The part of the surface that a footprint `width` metres wide across the ray covers at least.
Footprint footprint_of(const SurfaceGeometry& s, float width) {
  const float u = std::sqrt(length_squared(s.dpdu)), v = std::sqrt(length_squared(s.dpdv));
  return u > 0 && v > 0 ? Footprint{{width / u, width / v}} : Footprint{};
}

}  // namespace

Scene::Scene(SceneDescription description) : data_(build(std::move(description))) {}

std::optional<SurfacePoint> Scene::intersect(const Ray& ray, const Wavelengths& w) const {
  std::optional<SurfacePoint> result;
  const std::optional<GeometryHit> hit = data_->geometry->intersect(ray);
  if (!hit) return result;
  const SurfaceGeometry surface = data_->geometry->evaluate(*hit, ray);
  if (!is_finite(surface)) return result;
  const GeometryRecord& record = *hit->record;
  SurfacePoint& p = result.emplace();
  p.position = surface.position;
  p.position_error = surface.error;
  p.normal = surface.normal;
  p.uv = surface.uv;
  p.media = record.media;
  p.is_interface = record.is_interface;
  p.is_hidden = record.is_hidden;
  if (!record.is_interface) {
    TexturePoint at{surface.position, surface.normal, surface.uv, surface.color};
    if (record.wants_footprint) at.footprint = footprint_of(surface, ray.width + ray.spread * hit->t);
    const std::uint32_t material = data_->materials->table.resolve(record.material, at, -ray.direction);
    const Frame shading = record.wants_tangents ? data_->materials->table.shading_frame(material, surface, at)
                                                : Frame(surface.shading_normal);
    const bool tilted = shading.n != surface.normal;
    p.shading = shading;
    p.bsdf = data_->materials->table.evaluate(material, at, w);
    if (tilted && is_bendable(p.bsdf))
      bend_to_facet(p, surface.shading_normal, data_->geometry->rise(*hit, surface, ray));
    if (is_flat(record)) settle_flat_curve(p, surface, ray);
  }
  if (record.emits) p.light = hit->light();
  p.time = ray.time;
  return result;
}

bool Scene::visible(const Ray& ray) const { return !data_->geometry->occluded(ray); }

const std::vector<Light>& Scene::lights() const { return data_->lights->all; }
const LightBvh& Scene::light_bvh() const { return data_->lights->bvh; }
const RayLights& Scene::ray_lights() const { return data_->lights->ray_lights; }
const std::vector<std::uint32_t>& Scene::infinite_lights() const { return data_->lights->infinite; }
std::vector<Obstacle> Scene::obstacles() const { return find_obstacles(*data_->geometry, data_->materials->table); }
const Bounds& Scene::bounds() const { return data_->geometry->bounds(); }
BoundingSphere Scene::bounding_sphere() const { return data_->sphere; }
float Scene::largest_radiance() const { return data_->lights->largest_radiance; }
bool Scene::has_measured_spectra() const { return data_->has_measured_spectra; }
bool Scene::has_dispersion() const { return data_->has_dispersion; }
bool Scene::has_motion() const { return data_->geometry->moves(); }
bool Scene::may_be_specular() const { return data_->materials->table.may_be_specular(); }
bool Scene::has_fibres() const { return data_->materials->table.has_fibres(); }
bool Scene::has_media() const { return !data_->media->all.empty(); }
bool Scene::has_interfaces() const { return data_->shapes->has_interfaces; }
bool Scene::has_hidden_shapes() const { return data_->shapes->has_hidden_shapes; }
bool Scene::has_scattering_media() const {
  return has_media() &&
         std::any_of(data_->media->all.begin(), data_->media->all.end(), [](const Medium& m) { return scatters(m); });
}
float Scene::largest_medium_albedo() const {
  float largest = 0;
  for (std::size_t i = 0; i < data_->media->all.size(); ++i)
    if (!is_under_surface(*this, static_cast<MediumId>(i + 1)))
      largest = std::max(largest, largest_albedo(data_->media->all[i]));
  return largest;
}
bool Scene::has_emissive_media() const { return data_->has_emissive; }
std::optional<std::vector<Bounds>> Scene::scattering_boxes() const {
  std::vector<Bounds> boxes;
  for (std::size_t i = 0; i < data_->media->all.size(); ++i) {
    if (!scatters(data_->media->all[i])) continue;
    const auto id = static_cast<MediumId>(i + 1);
    if (const std::optional<MediumBox> place = place_of(*data_, id))
      boxes.push_back(place->to_medium.inverted().bounds(place->box));
    else if (is_endless(*data_, id))
      return {};
  }
  return boxes;
}
std::optional<std::uint32_t> Scene::volume_light(MediumId medium) const {
  const auto found = data_->lights->volume_lights.find(medium);
  return found != data_->lights->volume_lights.end() ? std::optional(found->second) : std::nullopt;
}
bool Scene::has_unlit_emission() const { return data_->lights->has_unlit_emission; }
bool Scene::lies_in(MediumId medium, const Ray& ray) const { return lanthorn::lies_in(*data_, medium, ray); }
const Medium& Scene::medium(MediumId id) const { return data_->media->all[static_cast<std::size_t>(id) - 1]; }
MediumInterface Scene::light_media(std::uint32_t light) const { return data_->lights->media[light]; }
std::optional<SourceLocation> Scene::locate(const Ray& ray) const {
  const std::optional<GeometryHit> hit = data_->geometry->intersect(ray);
  return hit ? std::optional(data_->geometry->location(*hit)) : std::nullopt;
}
const SourceLocation& Scene::light_location(std::uint32_t light) const { return data_->light_location(light); }
void Scene::require_textures() const { data_->materials->textures.require_readable(); }
TileCacheCounts Scene::texture_reads() const { return data_->materials->textures.reads(); }
const SceneStatistics& Scene::statistics() const { return data_->statistics; }
const std::vector<description::Warning>& Scene::warnings() const { return data_->description.warnings; }
const SceneDescription& Scene::description() const { return data_->description; }

Ray ray_in_scene(const Scene& scene, const SceneRay& ray, std::size_t index) {
  const float length = glm::length(ray.direction);
  const Point origin = Point(DVec3(ray.origin) - scene.description().origin);
  const bool is_usable = std::isfinite(length) && length > 0 && std::isfinite(glm::dot(origin, Vec3(1)));
  if (!is_usable)
    throw Error(fmt::format(
        "ray {}: expected finite numbers and a direction that is not 0, got origin ({}, {}, {}) "
        "and direction ({}, {}, {})",
        index, ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z));
  const description::Camera& camera = scene.description().view.camera;
  return {origin, ray.direction / length, infinity, camera.shutter_open};
}

bool is_under_surface(const Scene& scene, MediumId medium) {
  const std::vector<bool>& under = scene.data()->is_under_surface;
  return !under.empty() && medium != MediumId::vacuum && under[static_cast<std::size_t>(medium) - 1];
}

int most_under_surface(const Scene& scene) { return scene.data()->most_under_surface; }

int scatterings_until_dark(float albedo) {
  constexpr double least = 64, most = 4096, rest = 1e-3;
  const auto a = static_cast<double>(albedo);
  return static_cast<int>(std::clamp(a < 1 ? std::ceil(std::log(rest) / std::log(a)) : most, least, most));
}

}  // namespace lanthorn
