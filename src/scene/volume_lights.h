// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Media with volumetric emission, as lights.
#pragma once

#include "scene/scene_data.h"

namespace lanthorn {

/// Calls `visit(media, box)` for each shape that bounds media, with a box around it.
template <class Visit>
void for_each_bounding_box(const Geometry& geometry, Visit&& visit) {
  for (const auto& shape : geometry.shapes())
    if (shape->record.media.is_transition()) visit(shape->record.media, shape->bounds());
  for (std::size_t i = 0; i < geometry.placement_count(); ++i) {
    const PlacedGroup& placed = geometry.placed_group(i);
    for (const auto& shape : geometry.groups()[placed.group])
      if (shape->record.media.is_transition())
        visit(shape->record.media, geometry.swept_bounds(placed, shape->bounds()));
  }
}

/// True if rays from outside of the scene meet the medium.
bool is_endless(const SceneData& scene, MediumId medium);
/// Where the medium can be found; nullopt if it is unbounded, or if no surface bounds it.
std::optional<MediumBox> place_of(const SceneData& scene, MediumId medium);
/// True if the medium is around the ray's origin: asks the first surface along the ray that bounds media.
bool lies_in(const SceneData& scene, MediumId medium, const Ray& ray);

/// Appends the light of a medium to the lights.
void add_volume_light(const SceneData& scene, LightPart& lights, MediumId medium, const Light& light);
/// Finds the unbounded media, makes a light of each emissive medium, and appends these lights to the list. `lights`: of
/// the scene, while it is built. Unbounded media, and media that no surface bounds, do not become lights: only eye
/// paths find their emission (`has_unlit_emission`). `time`: when moving surfaces bound the media.
void make_volume_lights(const SceneData& scene, LightPart& lights, float time);

}  // namespace lanthorn
