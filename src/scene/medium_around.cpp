// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/medium_around.h"

#include "base/parallel.h"
#include "math/hash.h"
#include "scene/scene_data.h"
#include "scene/volume_lights.h"

namespace lanthorn {

namespace {

// Largest number of shapes at which the rays from a point aim, and number of these rays; each shape gets at least one
// ray.
constexpr std::size_t most_targets = 256, rays_of_point = 64;

// The medium at the ray's origin; empty if no interface or clear surface bounds it.
std::optional<MediumId> medium_before(const Scene& scene, Ray ray) {
  constexpr int most_surfaces = 64;  // coincident surfaces could hold a ray for ever
  for (int i = 0; i < most_surfaces; ++i) {
    const std::optional<SurfacePoint> at = scene.intersect(ray, Wavelengths::rgb(0.5f));
    if (!at || !lets_through(*at)) return {};
    if (at->media.is_transition()) return medium_towards(*at, -ray.direction, MediumId::vacuum);
    ray = pass_surface(*at, ray);
  }
  return {};
}

// The medium around the origins of the camera's rays; nullopt if it is unknown at one of them or differs between them.
std::optional<MediumId> medium_around_camera(const Scene& scene, const Camera& camera) {
  const Vec2 film(static_cast<float>(camera.width()), static_cast<float>(camera.height()));
  const float time = camera.time(0.5f);
  const MediumFinder media(scene);
  std::optional<MediumId> found;
  for (const Vec2 part : {Vec2(0.5f), Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
    const CameraRay start = camera.sample_ray(part * film, Vec2(0.5f), time);
    if (!(start.weight > 0)) continue;
    const std::optional<MediumId> here = media.around(start.ray.origin, time);
    if (!here || (found && *found != *here)) return {};
    found = here;
  }
  return found;
}

}  // namespace

bool lets_through(const SurfacePoint& at) { return at.is_interface || transmits(at.bsdf); }

MediumFinder::MediumFinder(const Scene& scene) : scene_(scene) {
  std::vector<Bounds> boxes;
  for_each_bounding_box(*scene.data()->geometry,
                        [&](const MediumInterface&, const Bounds& box) { boxes.push_back(box); });
  const std::size_t step = 1 + boxes.size() / most_targets;
  for (std::size_t i = 0; i < boxes.size(); i += step) targets_.push_back(boxes[i]);
}

std::optional<MediumId> MediumFinder::around(const Point& p, float time) const {
  HashRng rng(0);
  std::optional<MediumId> found;
  for (const Bounds& box : targets_)
    for (std::size_t i = 0; i <= rays_of_point / targets_.size(); ++i) {
      const Vec3 to = box.min + Vec3(rng.next2(), rng.next()) * box.extent() - p;
      if (to == Vec3(0)) continue;
      const std::optional<MediumId> here = medium_before(scene_, {p, normalize(to), infinity, time});
      if (here && found && *here != *found) return {};
      if (here) found = here;
    }
  return found;
}

std::string name_of_medium(const Scene& scene, MediumId id) {
  if (id == MediumId::vacuum) return "vacuum";
  return "medium \"" + scene.description().media[static_cast<std::size_t>(id) - 1].name + '"';
}

void settle_light_media(const Scene& scene, LightPart& lights) {
  const description::Table<description::Light>& described = scene.description().lights;
  if (described.empty()) return;
  const MediumFinder media(scene);
  const float time = shutter_middle(scene.description());
  const std::size_t first = scene.data()->first_described_light();
  parallel_for(std::size_t{0}, described.size(), [&](std::size_t i) {
    const Light& light = lights.all[first + i];
    // Light from infinitely far away has travelled through vacuum.
    MediumId medium = is_infinite(light) ? MediumId::vacuum : medium_id(described[i].medium);
    if (is_point(light)) medium = media.around(emission_bounds(light)->box.min, time).value_or(medium);
    lights.media[first + i] = {medium, medium};
  });
  for (std::size_t i = 0; i < described.size(); ++i) {
    const MediumId around = lights.media[first + i].outside, claimed = medium_id(described[i].medium);
    if (around != claimed && is_point(lights.all[first + i]))
      warn_once(lights.warnings, described[i].location,
                "the light is declared to be in " + name_of_medium(scene, claimed) +
                    ", but the shapes around it put it in " + name_of_medium(scene, around) + ", which is used");
  }
}

View view_in(const Scene& scene, const ViewDescription& description, const ViewOptions& options) {
  View view = make_view(description, options);
  view.medium = medium_around_camera(scene, view.camera).value_or(view.medium);
  return view;
}

}  // namespace lanthorn
