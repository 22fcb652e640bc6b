// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The stand-in camera and light of model files that have none.
#pragma once

#include <span>

#include "io/stand_in_view.h"
#include "lanthorn/scene_description.h"

namespace lanthorn {

/// True if the scene's emissive surfaces of these area lights light its other surfaces: those with a radiance above 1,
/// since others only glow, if their light, spread evenly over all other surfaces, were at least a twentieth of what a
/// sky of radiance 1 sends there.
bool is_lit_by(const SceneDescription& scene, std::span<const description::Index> lamps);

/// What a scene lacks.
struct StandIns {
  bool camera = false, light = false;
  OneSided one_sided = {};
  bool has_blind_camera = false;  ///< `camera`: it has one, which sees nothing
  bool gets_environment = false;  ///< the user's will take the place of the studio
};

/// What a reader of models returns.
struct ModelFile {
  SceneDescription scene;
  StandIns lacking;
};

/// Gives the scene what it lacks; one warning says so. The user's environment changes nothing of where the camera
/// stands, and takes the place of the studio alone.
///
/// The camera has a field of view of 40 degrees and +y up, and frames all triangle meshes whatever the film's aspect
/// ratio but grounds, from the best side (see `Grounds` and `stand_in_view`). In a closed room it stands inside, with
/// 60 degrees, and an invisible lamp lights the room in place of a missing light.
///
/// The light is a studio: an environment of three large soft lamps and a grey gradient, turned to the camera. A white
/// wall there has about radiance 1, so that its pictures need no exposure; those in the scene's own light measure it.
void add_stand_ins(SceneDescription& scene, const StandIns& lacking);
/// The file's scene, with what it lacks.
SceneDescription with_stand_ins(ModelFile file);

}  // namespace lanthorn
