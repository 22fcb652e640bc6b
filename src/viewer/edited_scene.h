// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A scene whose lights and objects the user edits, and its pbrt file with these edits.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lanthorn/scene.h"
#include "viewer/camera_motion.h"

namespace lanthorn {

/// A light as a user sees it: one of the description's lights, or one of its area lights, which follow them.
struct LightRow {
  std::string name;
  std::string id;  ///< name_of_light or name_of_area_light
  bool is_area = false;
  description::Index index = 0;   ///< into the description's lights or area lights
  std::optional<Point> position;  ///< in the world; nothing: it is far away, or a surface
  bool has_colour = false;        ///< no image or texture decides its colour
  Rgb colour{1};                  ///< largest component 1; white if a spectrum is none of RGB
  float strength = 1;             ///< factor of the strength in the file
  bool on = true;

  friend bool operator==(const LightRow&, const LightRow&) = default;
};

class EditedScene {
 public:
  explicit EditedScene(SharedScene scene);
  /// Also sets the strengths of lights, by their `id`.
  EditedScene(SharedScene scene, const std::map<std::string, float>& strengths);

  const SharedScene& scene() const { return scene_; }
  const std::vector<LightRow>& lights() const { return lights_; }
  /// With all edits; lights that are off have strength 0.
  const SceneDescription& description() const { return description_of(*scene_); }
  bool is_edited() const { return scene_ != original_; }

  /// Sets a light's colour and strength, and whether it is on. Throws Error if the scene rejects this; nothing then
  /// changes.
  void set_light(std::size_t row, const LightRow& values);
  /// Throws Error for lights without a position.
  void move_light(std::size_t row, const Vec3& metres);
  /// Throws Error for objects that emit.
  void move_instance(description::Index instance, const Vec3& metres);

 private:
  void apply(SceneDescription edited) { scene_ = build_scene(std::move(edited), scene_); }
  SceneDescription with_light(const LightRow& row) const;

  SharedScene original_, scene_;
  std::vector<LightRow> lights_;
};

/// The text of a pbrt file with the camera in this place and with edited lights, area lights and instances; everything
/// else stays letter by letter. `scene`: the description that was read from it. Throws Error if the file has no camera,
/// or if an edited part is described in another file that it includes.
std::string edited_pbrt(std::string_view text, const SceneDescription& scene, const CameraPose& camera,
                        const SceneDescription& edited);

}  // namespace lanthorn
