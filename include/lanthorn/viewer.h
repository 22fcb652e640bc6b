// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A scene in a window, or the frames of that window without one.
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

/// There is no OpenGL 4.5 or no display here, or the library was built without what needs them
/// (LANTHORN_BUILD_VIEWER=OFF). The message says which.
class ViewerUnavailable : public Error {
 public:
  using Error::Error;
};

/// The offline render of what the window shows.
struct ShownRender {
  std::filesystem::path scene;                 ///< its file
  RenderOptions options;                       ///< method and parameters, resolution, photons, seed, depth
  std::optional<LookAt> look;                  ///< none: the camera of the file
  std::map<std::string, float> light_factors;  ///< by the names of lights, that are not 1
  DisplaySettings display;
  bool measures_exposure = false;  ///< instead of the display's
  bool denoises = false;
  std::string picture;  ///< a name for its file, with .png
};

/// What a viewer starts with.
struct ViewerOptions {
  /// One of `realtime_methods`, or an offline method (`methods`), which refines while the camera rests.
  std::string method = "ispm";
  /// Resolution, seed, photons, depth; `set`: of the methods that draw by OpenGL, or of the offline method.
  RenderOptions render;
  DisplaySettings display;
  /// Of `run_viewer`: the exposure at first is measured from the picture, instead of the display's.
  bool measures_exposure = false;
  /// Pictures of offline methods are denoised: by `run_viewer` at first, until the user changes that.
  bool denoises = false;
  /// Of `run_viewer`: factors of brightness at first, by the names of lights (`name_of_light`, `name_of_area_light`).
  std::map<std::string, float> light_factors;
  /// Of `run_viewer`: the text of a command that makes this render, which the panel shows and copies.
  std::function<std::string(const ShownRender&)> command = [](const ShownRender&) { return std::string(); };
  std::filesystem::path scene_file;  ///< its folder and name are those of files that are saved
  std::uint32_t frames = 0;          ///< `render_frames`: this many; `run_viewer`: closes after as many, 0: never
};

/// Milliseconds of a part of a frame.
struct FrameStage {
  std::string name;
  double milliseconds = 0;
};

/// What was shown.
struct ViewerReport {
  std::string method;
  std::string driver;     ///< OpenGL's own name
  bool software = false;  ///< the CPU draws
  int width = 0, height = 0;
  std::uint64_t frames = 0;  ///< passes, of an offline method
  double seconds = 0;
  std::vector<FrameStage> stages;                 ///< means over the frames; of the GPU, then of the CPU
  std::vector<std::uint64_t> photons_per_bounce;  ///< of the last frame
  std::vector<std::string> limitations;           ///< what is shown differently than by `render`
};

/// The methods that draw by OpenGL, in the order of the window's list, with their parameters.
std::vector<MethodInfo> realtime_methods();

struct ViewerFrames {
  /// Mean of the frames: R, G, B and the layers emission, direct, indirect, caustic. Of an offline method: all layers,
  /// with those of `with_noise`, and those of `denoise` if the options ask for it.
  Image image;
  ViewerReport report;
};

/// The first `options.frames` frames for a camera at rest. The same bytes on every run with the same driver, if that
/// draws in software. Throws ViewerUnavailable, or Error for unknown methods and settings.
ViewerFrames render_frames(const SharedScene& scene, const ViewDescription& view, const ViewerOptions& options);

/// Makes objects with an instance of the meshes of a glTF file that stand in one place, so that `run_viewer` can move
/// them as it moves those that stand in several. A file of more than 4096 meshes stays as it is.
void make_nodes_movable(SceneDescription& scene);

/// Shows the scene until the window is closed. Throws as `render_frames` does. Call it on the program's first thread.
ViewerReport run_viewer(const SharedScene& scene, const ViewDescription& view, const ViewerOptions& options);

}  // namespace lanthorn
