// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/volume_lights.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "base/parallel.h"
#include "math/hash.h"
#include "math/sampling.h"

namespace lanthorn {

namespace {

// The surface at a hit, as far as media need it.
SurfacePoint bounding_point(const SceneData& scene, const GeometryHit& hit, const Ray& ray) {
  const SurfaceGeometry surface = scene.geometry->evaluate(hit, ray);
  SurfacePoint p;
  p.position = surface.position;
  p.position_error = surface.error;
  p.normal = surface.normal;
  p.media = hit.record->media;
  p.time = ray.time;
  return p;
}

// The medium at the ray's origin; empty if no surface along the ray bounds media.
std::optional<MediumId> medium_at(const SceneData& scene, Ray ray) {
  constexpr int most_surfaces = 64;  // coincident surfaces could hold a ray for ever
  for (int i = 0; i < most_surfaces; ++i) {
    const std::optional<GeometryHit> hit = scene.geometry->intersect(ray);
    if (!hit) return {};
    const SurfacePoint at = bounding_point(scene, *hit, ray);
    if (at.media.is_transition()) return medium_towards(at, -ray.direction, MediumId::vacuum);
    ray = spawn_ray(at, ray.direction);
  }
  return {};
}

// The media that rays from outside of the scene meet; the camera's medium if no surface bounds a medium.
std::vector<MediumId> find_endless_media(const SceneData& scene, float time) {
  constexpr int rays = 256;
  std::vector<MediumId> found;
  HashRng rng(0);
  for (int i = 0; i < rays; ++i) {
    const Direction outwards = sample_uniform_sphere(rng.next2());
    const Point origin = scene.sphere.centre + 2 * scene.sphere.radius * outwards;
    const Point target = scene.sphere.centre + scene.sphere.radius * rng.next() * sample_uniform_sphere(rng.next2());
    if (const auto medium = medium_at(scene, {origin, normalize(target - origin), infinity, time}))
      found.push_back(*medium);
  }
  if (found.empty()) return {medium_id(scene.description.view.camera.medium)};
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

// A box around all surfaces that bound the medium.
Bounds bounds_of_surfaces(const Geometry& geometry, MediumId medium) {
  Bounds all;
  for_each_bounding_box(geometry, [&](const MediumInterface& media, const Bounds& box) {
    if (media.inside == medium || media.outside == medium) all.extend(box);
  });
  return all;
}

// Measurements of a medium's emission.
struct MeasuredEmission {
  BlockGrid blocks;     // mean emission, of all channels together
  float watts = 0;      // luminance
  float brightest = 0;  // radiance per metre, of any channel
};

MeasuredEmission measure(const SceneData& scene, MediumId id, const MediumBox& place, int resolution, float time) {
  const Medium& medium = scene.media->all[static_cast<std::size_t>(id) - 1];
  const Transform to_world = place.to_medium.inverted();
  const Wavelengths white = Wavelengths::rgb(0.5f);
  constexpr int parts = 2;  // points along each axis of a block
  constexpr auto points = static_cast<float>(parts * parts * parts);
  MeasuredEmission result{BlockGrid(place.box, resolution)};
  const std::span<float> values = result.blocks.values();
  std::vector<float> luminances(values.size()), brightest(values.size());
  parallel_for(std::size_t{0}, values.size(), [&](std::size_t i) {
    const Bounds block = result.blocks.block(i);
    HashRng rng(hash_words({i}));
    for (int k = 0; k < parts * parts * parts; ++k) {
      const int z = k / 4;
      const Vec3 part(static_cast<float>(k % 2), static_cast<float>(k / 2 % 2), static_cast<float>(z));
      const Vec3 within = (part + Vec3(rng.next2(), rng.next())) / static_cast<float>(parts);
      const Point p = to_world.point(block.min + within * block.extent());
      const Spectrum emission = emission_at(medium, p, white);
      const Direction anywhere = sample_uniform_sphere(rng.next2());
      if (emission.is_black() || !lies_in(scene, id, Ray{p, anywhere, infinity, time})) continue;
      values[i] += sum_of(emission) / points;
      luminances[i] += luminance({emission[0], emission[1], emission[2]}) / points;
      brightest[i] = std::max(brightest[i], max_component(emission));
    }
  });
  double luminance_sum = 0;
  for (const float l : luminances) luminance_sum += static_cast<double>(l);
  const double mean = luminance_sum / static_cast<double>(values.size());
  result.watts = static_cast<float>(4 * std::numbers::pi * place.volume() * mean);
  result.brightest = *std::max_element(brightest.begin(), brightest.end());
  return result;
}

std::optional<VolumeLight> make_volume_light(const SceneData& scene, MediumId id, float time) {
  const Medium& medium = scene.media->all[static_cast<std::size_t>(id) - 1];
  const std::optional<MediumBox> place = place_of(scene, id);
  if (!place) return {};
  // If the emission is uniform, only the shape of the medium has to be found.
  const bool is_even = std::holds_alternative<HomogeneousMedium>(medium);
  MeasuredEmission measured = measure(scene, id, *place, is_even ? 16 : 32, time);
  if (!(measured.watts > 0)) return {};
  const float diagonal = static_cast<float>(std::cbrt(place->volume()) * std::numbers::sqrt3);
  return VolumeLight{&medium, std::make_shared<const EmissionTable>(std::move(measured.blocks), *place), measured.watts,
                     measured.brightest * diagonal};
}

}  // namespace

bool is_endless(const SceneData& scene, MediumId medium) {
  const std::vector<MediumId>& endless = scene.lights->endless_media;
  return std::find(endless.begin(), endless.end(), medium) != endless.end();
}

std::optional<MediumBox> place_of(const SceneData& scene, MediumId id) {
  if (const auto box = box_of(scene.media->all[static_cast<std::size_t>(id) - 1])) return box;
  const Bounds bounds = bounds_of_surfaces(*scene.geometry, id);
  if (is_endless(scene, id) || bounds.empty()) return {};
  return MediumBox{bounds, {}};
}

bool lies_in(const SceneData& scene, MediumId medium, const Ray& ray) {
  const std::optional<MediumId> found = medium_at(scene, ray);
  return found ? *found == medium : is_endless(scene, medium);
}

void add_volume_light(const SceneData& scene, LightPart& lights, MediumId medium, const Light& light) {
  const auto index = static_cast<std::uint32_t>(lights.all.size());
  lights.locations[index] = scene.description.media[static_cast<std::size_t>(medium) - 1].location;
  lights.volume_lights[medium] = index;
  lights.media.push_back({medium, medium});
  lights.all.push_back(light);
}

void make_volume_lights(const SceneData& scene, LightPart& lights, float time) {
  if (!scene.media->all.empty()) lights.endless_media = find_endless_media(scene, time);
  for (std::size_t i = 0; i < scene.media->all.size(); ++i) {
    if (!is_emissive(scene.media->all[i])) continue;
    const auto id = static_cast<MediumId>(i + 1);
    const std::optional<VolumeLight> light = make_volume_light(scene, id, time);
    lights.has_unlit_emission = lights.has_unlit_emission || !light;
    if (!light) continue;
    check_power(*light, scene.description.media[i].location);
    add_volume_light(scene, lights, id, *light);
  }
}

}  // namespace lanthorn
