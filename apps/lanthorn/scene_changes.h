// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Changes of a scene from the command line or from the page of `serve`: where the camera stands, and how bright each
// light is. Both make the same picture of the same changes.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/scene.h"
#include "lanthorn/session.h"

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
}  // namespace CLI

namespace lanthorn::program {

/// A camera at `eye` that looks at `target`; metres, world space. `up` is upwards in the picture, of any length.
struct LookAt {
  Point eye{0}, target{0, 0, 1};
  Vec3 up{0, 1, 0};
  friend bool operator==(const LookAt&, const LookAt&) = default;
};

/// "ex,ey,ez,tx,ty,tz,ux,uy,uz"; numbers are written so that reading gives the same ones.
std::string to_text(const LookAt& look);
/// Throws Error unless there are nine finite numbers that are a direction of view and an upward direction.
LookAt parse_look_at(const std::string& text);
/// Throws Error as `parse_look_at` does.
void check(const LookAt& look);

/// How a view looks: from its camera's place when the shutter opens to a point `distance` before it.
LookAt look_of(const ViewDescription& view, const ViewOptions& options, float distance);
/// Moves the camera. Its lens and the mirroring and scale of its transformation stay; it no longer moves or frames a
/// subject by itself.
void place_camera(ViewDescription& view, const LookAt& look);

/// A light of a scene that a user can name.
struct NamedLight {
  std::string name;         ///< light1, light2 ... of the scene's lights, area1 ... of its emitting surfaces
  std::string description;  ///< its kind and line in the file, for people
};
std::vector<NamedLight> lights_of(const SceneDescription& scene);

/// Factors of brightness by the names of lights; missing: 1.
using LightFactors = std::map<std::string, float>;

/// Adds "NAME=FACTOR". Throws Error unless the factor is finite and not negative.
void parse_light_factor(const std::string& text, LightFactors& factors);
/// The scene with its lights multiplied. Equal factors give equal scenes, whose states belong together. Throws Error
/// for names that are not among `lights_of`.
SharedScene scale_lights(const SharedScene& scene, const LightFactors& factors);

/// What the options --look-at and --light say.
struct SceneChanges {
  std::optional<LookAt> look{};
  LightFactors lights{};
};
/// The scene's own view with the camera of `changes`.
ViewDescription view_of(const Scene& scene, const SceneChanges& changes);
/// Adds --look-at and --light. `changes` must outlive the parsing.
void add_scene_changes(CLI::App& command, SceneChanges& changes);

}  // namespace lanthorn::program
