// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Shows a scene in a window, or renders the window's frames off-screen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/image.h"
#include "lanthorn/image_file.h"
#include "lanthorn/methods.h"
#include "lanthorn/render_options.h"
#include "lanthorn/scene.h"

namespace lanthorn {

/// OpenGL 4.5 or a display is missing, or the library was built without the viewer (LANTHORN_BUILD_VIEWER=OFF). The
/// message says which.
class ViewerUnavailable : public Error {
 public:
  using Error::Error;
};

/// The offline render that corresponds to the picture in the window.
struct ShownRender {
  std::filesystem::path scene;                 ///< its file
  RenderOptions options;                       ///< method and parameters, resolution, photons, seed, depth
  std::optional<LookAt> look;                  ///< nullopt: the camera of the file
  std::map<std::string, float> light_factors;  ///< factors that are not 1, by the names of lights
  DisplaySettings display;
  bool measures_exposure = false;  ///< measure the exposure instead of using the display's
  bool denoises = false;
  std::string picture;  ///< suggested name for its file, with .png
};

/// Initial state of a viewer.
struct ViewerOptions {
  /// One of `realtime_methods`, or an offline method (`methods`), which refines while the camera is at rest.
  std::string method = "ispm";
  /// Resolution, seed, photons, depth; `set` holds parameters of the chosen method.
  RenderOptions render;
  DisplaySettings display;
  /// `run_viewer` only: measures the initial exposure from the picture instead of using the display's.
  bool measures_exposure = false;
  /// Denoises pictures of offline methods; in `run_viewer` the initial setting, which the user can change.
  bool denoises = false;
  /// `run_viewer` only: initial brightness factors, by the names of lights (`name_of_light`, `name_of_area_light`).
  std::map<std::string, float> light_factors;
  /// `run_viewer` only: returns the command line for a render, which the panel shows and copies.
  std::function<std::string(const ShownRender&)> command = [](const ShownRender&) { return std::string(); };
  std::filesystem::path scene_file;  ///< supplies folder and name of files that are saved
  std::uint32_t frames = 0;          ///< of `render_frames`; `run_viewer`: closes after as many, 0: never
};

/// Duration of one stage of a frame.
struct FrameStage {
  std::string name;
  double milliseconds = 0;
};

/// Statistics of the frames shown.
struct ViewerReport {
  std::string method;
  std::string driver;     ///< OpenGL's name for its renderer
  bool software = false;  ///< true if the CPU draws
  int width = 0, height = 0;
  std::uint64_t frames = 0;  ///< passes, for an offline method
  double seconds = 0;
  std::vector<FrameStage> stages;                 ///< means over the frames; first on the GPU, then on the CPU
  std::vector<std::uint64_t> photons_per_bounce;  ///< of the last frame
  std::vector<std::string> limitations;           ///< differences from the picture of `render`
};

/// The methods that draw with OpenGL, in the order of the window's list, with their parameters.
std::vector<MethodInfo> realtime_methods();

struct ViewerFrames {
  /// Mean of the frames: R, G, B and the layers emission, direct, indirect, caustic. For an offline method: all layers
  /// including those of `with_noise`, and those of `denoise` if the options request it.
  Image image;
  ViewerReport report;
};

/// The first `options.frames` frames for a camera at rest. Equal bytes on every run with the same driver, if that
/// driver renders in software. Throws ViewerUnavailable, or Error for unknown methods and settings.
ViewerFrames render_frames(const SharedScene& scene, const ViewDescription& view, const ViewerOptions& options);

/// Turns meshes of a glTF file that stand in a single place into objects with one instance each, so that `run_viewer`
/// can move them like instanced ones. Leaves files of more than 4096 meshes unchanged.
void make_nodes_movable(SceneDescription& scene);

/// Shows the scene until the window is closed. Throws as `render_frames` does. Call it on the main thread.
ViewerReport run_viewer(const SharedScene& scene, const ViewDescription& view, const ViewerOptions& options);

}  // namespace lanthorn
