// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The interactive render that pages show and control.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "../scene_changes.h"
#include "frame.h"
#include "http_server.h"
#include "lanthorn/interactive_render.h"
#include "lanthorn/scene.h"

namespace lanthorn::program {

/// Everything that determines the picture.
struct ViewerScene {
  SceneChanges changes{};
  RenderOptions options{};
  EnvironmentChoice environment{};
};

/// A page's edit; missing members stay unchanged.
struct ViewerEdit {
  bool home = false;  ///< resets camera, lens and lights to the start, before the edits below
  std::optional<std::string> method{};
  std::optional<std::array<int, 2>> size{};  ///< width, height in pixels
  std::optional<LookAt> look{};
  LensChanges lens{};
  std::optional<Vec2> focus_at{};  ///< focuses on the surface in this pixel of the picture at full size
  std::optional<EnvironmentChoice> environment{};
  std::optional<LightFactors> lights{};
  std::optional<bool> paused{}, denoise{};
  bool moving = false;  ///< more edits will follow immediately: coarse pictures suffice
};

struct ViewerSettings {
  /// The command line that renders this picture with the given number of passes, denoised or not.
  std::function<std::string(const ViewerScene&, std::uint64_t, bool)> command;
  ViewerScene start{};
  bool denoises = false;    ///< initially
  bool keeps_sums = false;  ///< an abandoned pass leaves no trace, so that the sums can be saved
};

/// Renders as long as a page was active within the last half minute, or the sums are kept. Any thread may call.
class Viewer {
 public:
  /// `scene` was read with the initial environment. Throws Error as `InteractiveRender` does, and for lights that the
  /// scene does not have.
  Viewer(const SharedScene& scene, ViewerSettings settings);

  /// Pauses if no page was active for a while, and reverts edits that cannot be rendered. Call it periodically.
  void tend();
  /// Ends the current pass and the render.
  void end();
  /// After `end`: the film's sums of the last view; null if it has no complete pass.
  const RenderState* state() const { return render_.state(); }
  /// Whether finished pictures are denoised.
  bool denoises() const;

  /// Applies an edit and returns the revision of the pictures that will show it. Throws Error for invalid cameras,
  /// lenses, environments, lights, methods and sizes.
  std::uint64_t apply(const ViewerEdit& edit);
  /// The first frame whose number differs from `after`; null if none appears within ten seconds, or `is_gone`.
  std::shared_ptr<const PageFrame> wait_for_frame(std::uint64_t after, const IsGone& is_gone);
  /// Null before the first frame.
  std::shared_ptr<const PageFrame> last_frame();

  /// Warnings of the initial scene and view.
  const std::vector<description::Warning>& warnings() const { return render_.warnings(); }
  /// Lights under the last environment requested.
  std::vector<NamedLight> lights() const;
  /// The environment sources that may be requested: the scene's own (empty), the built-in ones, and the one that the
  /// server was started with.
  std::vector<std::string> environments() const;
  const Scene& scene() const { return *scene_; }
  /// The initial view.
  ViewDescription first_view() const { return view_of(*scene_, settings_.start.changes, settings_.start.options); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Shown {
    ViewerScene scene;
    ViewDescription view;  ///< follows from the scene
  };

  void look();
  std::uint64_t submit(ViewerScene scene, bool is_moving);
  RenderOptions edited_options(const ViewerEdit& edit) const;
  void edit_lens(ViewerScene& next, const ViewerEdit& edit) const;
  void edit_environment(ViewerScene& next, const EnvironmentChoice& choice);
  SharedScene in_environment(const EnvironmentChoice& choice);
  bool is_watched() const { return settings_.keeps_sums || Clock::now() < watched_until_; }
  std::shared_ptr<const PageFrame> frame_of(const InteractiveSnapshot& snapshot);
  nlohmann::json about(const InteractiveSnapshot& snapshot);
  const LookAt& home(const Image& image);

  SharedScene scene_;
  ViewerSettings settings_;
  bool is_mirrored_;
  InteractiveRender render_;

  mutable std::mutex mutex_;                         // guards all members below
  std::map<std::string, SharedScene> surroundings_;  // by source: the first scene with it; later ones share its image
  std::vector<NamedLight> lights_;
  Shown wanted_;
  std::map<std::uint64_t, Shown> scenes_;  // by revision, starting with that of the last frame
  std::string problem_;                    // names the reverted edit
  std::string first_method_;
  std::optional<LookAt> home_;
  bool is_paused_ = false, denoises_, has_ended_ = false;
  Clock::time_point watched_until_{};
  std::shared_ptr<const PageFrame> frame_;
};

}  // namespace lanthorn::program
