// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The classes of paths, which are layers of the film.
#pragma once

#include <cstddef>
#include <cstdint>

#include "film/film.h"
#include "path/vertex.h"
#include "scene/scene.h"

namespace lanthorn {

/// The layer that light belongs to. In Heckbert's notation, read from the eye, with D for any non-delta scattering:
/// E S* L is emission, E S* D L direct, E S* D S+ L caustic, everything else indirect.
enum class PathClass : std::uint8_t { emission, direct, indirect, caustic };
inline constexpr std::size_t path_class_count = 4;

/// The layer of all light that comes out of media: the last scattering before the eye, delta ones aside, was in a
/// medium, or a medium emitted the light that is seen. It repeats light of the path classes, and comes after them.
inline constexpr std::size_t media_layer = path_class_count;

/// The layers of methods that distinguish path classes: one for each class, and one for media if the scene has
/// scattering or emissive media.
inline FilmContents path_layers(const Scene& scene) {
  FilmContents contents{.light = {"emission", "direct", "indirect", "caustic"}};
  if (scene.has_scattering_media() || scene.has_emissive_media()) contents.repeated = {"media"};
  return contents;
}

/// Class of light that the walk finds by hitting an emitter, or of volumetric emission along a ray that it follows in
/// this state.
inline PathClass class_of_hit(const WalkState& state) {
  if (state.non_delta == 0) return PathClass::emission;
  if (state.non_delta > 1) return PathClass::indirect;
  return state.last_delta ? PathClass::caustic : PathClass::direct;
}
/// Class of light that next-event estimation finds at a vertex of a walk in this state.
inline PathClass class_of_next_event(const WalkState& state) {
  return state.non_delta == 0 ? PathClass::direct : PathClass::indirect;
}

}  // namespace lanthorn
