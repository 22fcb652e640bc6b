// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The render that shows the window's picture offline.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/image_file.h"
#include "lanthorn/viewer.h"
#include "viewer/camera_motion.h"
#include "viewer/edited_scene.h"
#include "viewer/realtime_view.h"

namespace lanthorn {

/// The picture in the window, with its settings.
struct ShownPicture {
  std::filesystem::path scene;
  std::string method;
  RealtimeSettings settings;
  DisplaySettings display;
  bool measures_exposure = false, denoises = false;
  std::optional<CameraPose> camera;        ///< nothing: that of the file
  std::map<std::string, float> strengths;  ///< of lights, by LightRow::id, that differ from those of the file
  int width = 0, height = 0;
  DVec3 origin{0.0};  ///< of the scene's coordinates (`SceneDescription::origin`)
};

/// The name of a scene file without folder and endings.
std::string stem_of(const std::filesystem::path& scene);

/// Strengths that are not 1; 0 of lights that are off.
std::map<std::string, float> strengths_of(const std::vector<LightRow>& lights);

/// `options`: those with which the window was opened.
ShownRender offline_render(const ShownPicture& shown, const ViewerOptions& options);

}  // namespace lanthorn
