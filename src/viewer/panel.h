// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Plain data that the window and the viewer exchange: the window is a separate module, which links nothing of the
// library.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/vec.h"
#include "lanthorn/viewer.h"
#include "realtime/techniques/technique_info.h"
#include "viewer/edited_scene.h"
#include "viewer/realtime_view.h"

namespace lanthorn {

/// The user's input in a frame. Positions and motions over the picture are in pixels of the picture, y down.
struct Input {
  bool closed = false;
  float seconds = 0;    ///< since the frame before
  bool inside = false;  ///< the pointer is over the picture, and the panel does not want it
  Vec2 pointer{0};
  Vec2 moved{0};  ///< of the pointer since the frame before, or since a button was pressed in this frame
  float wheel = 0;
  bool left = false, middle = false, right = false;       ///< buttons that are held
  bool pressed = false, released = false, shift = false;  ///< the left or another button, now
  Vec3 fly{0};                                            ///< keys: to the right, up, forward; each -1, 0 or 1
  bool forget = false;                                    ///< Escape: clear the selection
};

/// Actions that the user asks for now.
struct Wishes {
  bool save_png = false, save_exr = false, save_scene = false, copy_command = false;
  bool reset_camera = false, reset_scene = false;
};

/// A light in the picture, for the window to draw a mark there.
struct LightMark {
  Vec2 at{0};  ///< pixels of the picture
  std::size_t light = 0;
};

/// The data that the panel shows and changes.
struct Panel {
  // The user changes these members:
  std::vector<std::string> methods;  ///< names; first those of the techniques
  std::size_t method = 0;
  RealtimeSettings settings;
  float exposure = 0;  ///< stops
  bool measures_exposure = false;
  bool denoises = false;  ///< pictures of offline methods
  ToneCurve curve = ToneCurve::none;
  int layer = 0;  ///< 0: all of them; else 1 + index of emission, direct, indirect, caustic
  std::vector<LightRow> lights;
  std::optional<std::size_t> selected_light;
  std::optional<description::Index> selected_object;
  Wishes wishes;

  // These members are only shown:
  std::vector<TechniqueDescription> techniques;  ///< with all their parameters, those of lights included
  std::string scene, driver, object_name, message, command;
  std::string error;     ///< of the picture, of an offline method; empty: not known yet
  std::string left;      ///< time until an offline method has reached its bounds; empty: not known yet, or reached
  std::string denoised;  ///< how far the picture is denoised; empty: it is not
  std::string remark;    ///< findings and choices of an offline method; empty: none
  std::string notice;    ///< over the picture: why it differs from the request
  std::vector<std::string> notes;
  std::vector<LightMark> marks;
  std::vector<FrameStage> stages;
  std::vector<std::uint64_t> photons_per_bounce;
  double frame_milliseconds = 0;
  std::uint64_t frames = 0;  ///< in the picture; passes, of an offline method
  bool is_offline = false;   ///< the picture is that of an offline method
  float scene_radius = 1;    ///< m
  bool can_save_scene = false;

  bool wants_offline() const { return method >= techniques.size(); }
};

/// The module's functions. A window is opaque to the viewer; the OpenGL context of the last one that was opened is
/// current.
struct WindowFunctions {
  /// Opens a window. Returns null on failure, with the reason in `failure`.
  void* (*open)(const char* title, int width, int height, std::string& failure);
  void (*close)(void* window);
  /// Waits for events if `may_wait`, at most a tenth of a second. `width`, `height`: of the picture.
  Input (*read)(void* window, bool may_wait, int width, int height, Panel& panel);
  /// Shows the picture, its first row first in the texture's memory, and the panel beside it.
  void (*show)(void* window, unsigned texture, int width, int height, Panel& panel);
  void (*copy)(void* window, const char* text);
};

/// The function of the module that returns them.
constexpr const char* window_symbol = "lanthorn_window";
using WindowSymbol = const WindowFunctions* (*)();

/// Loads the module if this has not been done. Throws ViewerUnavailable if it cannot be loaded.
const WindowFunctions& window_functions();

}  // namespace lanthorn
