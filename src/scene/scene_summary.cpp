// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <variant>
#include <vector>

#include "camera/view.h"
#include "lanthorn/scene.h"
#include "scene/medium_around.h"
#include "scene/scene.h"
#include "scene/scene_data.h"

namespace lanthorn {

SharedScene build_scene(SceneDescription description, const SharedScene& previous) {
  return std::make_shared<const Scene>(build(std::move(description), previous ? previous->data().get() : nullptr));
}

const SceneDescription& description_of(const Scene& scene) { return scene.description(); }

std::vector<description::Warning> warnings_of(const Scene& scene, const ViewDescription& view) {
  std::vector<description::Warning> all = scene.warnings();
  const SourceLocation file{scene.description().filename, 0, 0};
  const bool is_dark = scene.lights().empty() && !scene.has_emissive_media();
  const bool is_empty = scene.bounds().empty();
  if (is_dark) all.push_back({file, "the scene has no light: the picture will be black"});
  if (is_empty && !is_dark) all.push_back({file, "the scene has no shapes: the picture shows only lights at infinity"});
  const View placed = view_in(scene, view);
  if (const MediumId claimed = medium_id(view.camera.medium); placed.medium != claimed)
    all.push_back({view.camera.location, "the camera is declared to be in " + name_of_medium(scene, claimed) +
                                             ", but the shapes around it put it in " +
                                             name_of_medium(scene, placed.medium) + ", which is used"});
  for (description::Warning& warning : media_warnings(scene, placed)) all.push_back(std::move(warning));
  return all;
}

namespace {

Bounds moved(Bounds box, const DVec3& way) {
  for (Point* const corner : {&box.min, &box.max}) *corner = Point(DVec3(*corner) + way);
  return box;
}

}  // namespace

SceneSummary summarize(const Scene& scene) {
  const SceneStatistics& s = scene.statistics();
  SceneSummary summary{.triangles = s.triangles,
                       .patches = s.patches,
                       .quadrics = s.quadrics,
                       .curves = s.curves,
                       .instances = s.instances,
                       .textures = s.textures,
                       .lights = {},
                       .materials = {},
                       .bounds = moved(scene.bounds(), scene.description().origin),
                       .geometry_bytes = s.geometry_bytes,
                       .bvh_bytes = s.bvh_bytes,
                       .texture_bytes = s.texture_bytes,
                       .texture_disk_bytes = s.texture_disk_bytes,
                       .texture_tiles_read = scene.texture_reads().tiles_read,
                       .build_seconds = s.build_seconds,
                       .has_dispersion = scene.has_dispersion(),
                       .has_measured_spectra = scene.has_measured_spectra(),
                       .has_motion = scene.has_motion() || make_view(scene.description().view).camera.moves()};
  for (const Light& light : scene.lights()) ++summary.lights[name_of(light)];
  for (const description::Material& m : scene.description().materials)
    ++summary.materials[std::visit([](const auto& material) { return material.kind; }, m.node)];
  return summary;
}

}  // namespace lanthorn
