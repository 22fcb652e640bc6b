// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The interactive render that pages see and steer.
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
#include "lanthorn/light_names.h"

namespace lanthorn::program {

/// What decides the picture.
struct ViewerScene {
  SceneChanges changes{};
  RenderOptions options{};
  EnvironmentChoice environment{};
};

/// What a page asks for; what is missing stays as it is.
struct ViewerEdit {
  bool home = false;  ///< camera, lens and lights as at the start, before the edits below
  std::optional<std::string> method{};
  std::optional<std::array<int, 2>> size{};  ///< width, height in pixels
  std::optional<LookAt> look{};
  LensChanges lens{};
  std::optional<Vec2> focus_at{};  ///< makes sharp what this pixel of the picture at full size sees
  std::optional<EnvironmentChoice> environment{};
  std::optional<LightFactors> lights{};
  std::optional<bool> paused{}, denoise{};
  bool moving = false;  ///< more edits will follow at once: coarse pictures will do
};

struct ViewerSettings {
  /// The command line that renders this picture after so many passes, and denoises it or not.
  std::function<std::string(const ViewerScene&, std::uint64_t, bool)> command;
  ViewerScene start{};
  bool denoises = false;    ///< at the start
  bool keeps_sums = false;  ///< a pass that is given up leaves no trace, so that the sums can be saved
};

/// Renders as long as somebody has looked within the last half minute, or the sums are kept. Any thread may call.
class Viewer {
 public:
  /// `scene` was read with the environment of the start. Throws Error as `InteractiveRender` does, and for lights that
  /// the scene does not have.
  Viewer(const SharedScene& scene, ViewerSettings settings);

  /// Rests if nobody has looked for long, and takes back what cannot be rendered. To be called now and then.
  void tend();
  /// Ends the running pass and the render.
  void end();
  /// After `end`: the sums of what was seen last; null if there is no whole pass of it.
  const RenderState* state() const { return render_.state(); }
  /// Pictures at rest are denoised.
  bool denoises() const;

  /// Returns the revision of the pictures that will show the edit. Throws Error for cameras, lenses, environments,
  /// lights, methods and sizes that cannot be.
  std::uint64_t apply(const ViewerEdit& edit);
  /// The first frame with another number than `after`; null if none comes for ten seconds, or `is_gone`.
  std::shared_ptr<const PageFrame> wait_for_frame(std::uint64_t after, const IsGone& is_gone);
  /// Null before the first.
  std::shared_ptr<const PageFrame> last_frame();

  /// Those at the start.
  const std::vector<description::Warning>& warnings() const { return render_.warnings(); }
  /// Those of the last environment that was asked for.
  std::vector<NamedLight> lights() const;
  /// The sources of environments that may be asked for: the scene's own (empty), those without a file, and the one that
  /// the server was started with.
  std::vector<std::string> environments() const;
  const Scene& scene() const { return *scene_; }
  /// What is seen at the start.
  ViewDescription first_view() const { return view_of(*scene_, settings_.start.changes, settings_.start.options); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Shown {
    ViewerScene scene;
    ViewDescription view;  ///< that follows from it
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

  mutable std::mutex mutex_;                         // of all below
  std::map<std::string, SharedScene> surroundings_;  // by source: the first scene in each, whose picture others share
  std::vector<NamedLight> lights_;
  Shown wanted_;
  std::map<std::uint64_t, Shown> scenes_;  // by revision, from that of the last frame on
  std::string problem_;                    // with what was taken back
  std::string first_method_;
  std::optional<LookAt> home_;
  bool is_paused_ = false, denoises_, has_ended_ = false;
  Clock::time_point watched_until_{};
  std::shared_ptr<const PageFrame> frame_;
};

}  // namespace lanthorn::program
