// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Default camera and light for model files without them.
#pragma once

#include <span>
#include <vector>

#include "lanthorn/scene_description.h"
#include "staging/stand_in_view.h"

namespace lanthorn {

/// True if the emissive surfaces of these area lights illuminate the rest of the scene. Only emitters with a radiance
/// above 1 count, since dimmer ones merely look bright: their light, spread evenly over all other surfaces, must be at
/// least a twentieth of the light of a sky of radiance 1.
bool is_lit_by(const SceneDescription& scene, std::span<const description::Index> lamps);

/// What a scene lacks.
struct StandIns {
  bool camera = false, light = false;
  OneSided one_sided = {};
  std::vector<Bounds> parts = {};  ///< boxes of the file's objects, if they are not shapes
  bool has_blind_camera = false;   ///< `camera` is set although it has one, which sees nothing
  bool gets_environment = false;   ///< the user's environment will replace the studio
  bool reflects_darkness = false;  ///< metal or glass is lit by its point, spot and distant lights alone
};

/// Result of a reader of model files.
struct ModelFile {
  SceneDescription scene;
  StandIns lacking;
};

/// Adds the camera and the lights that the scene lacks, with a single warning. The user's environment replaces only the
/// studio; it does not affect the camera.
///
/// The camera has a field of view of 40 degrees and +y up. It frames all triangle meshes except grounds from the best
/// side, whatever the film's aspect ratio (see `Grounds` in stand_ins.cpp, and `stand_in_view`). In a closed room it is
/// inside, with 60 degrees; an invisible lamp illuminates the room if there is no light.
///
/// The light is a studio: an environment of three large soft lights and a grey gradient, oriented by the camera. A
/// white wall there has about radiance 1, so that its pictures need no exposure; pictures in the scene's own light
/// measure it. Metal and glass that only point, spot and distant lights illuminate would reflect darkness, unlike in
/// viewers, which add image light: they get the studio at a third of the lights' typical irradiance, unless the camera
/// is in a closed room.
void add_stand_ins(SceneDescription& scene, const StandIns& lacking);
/// The file's scene, completed by default camera and light.
SceneDescription with_stand_ins(ModelFile file);

}  // namespace lanthorn
