// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A render under way.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/image.h"
#include "lanthorn/render_options.h"
#include "lanthorn/scene.h"
#include "lanthorn/state.h"
#include "lanthorn/statistics.h"

namespace lanthorn {

struct Team;

/// What is kept so that running passes can be given up.
enum class Undo : std::uint8_t {
  /// A copy of the film if the passes take at least a second and 50 times as long as the copy, and if a quarter of the
  /// free memory holds it.
  if_cheap,
  always,  ///< a copy of the film
  never,   ///< nothing: giving up a pass gives up the render
};

/// When to stop; whatever comes first. The flags may be set at any time, by any thread or signal handler.
struct StopRule {
  PassRange passes{0, 1};           ///< passes to have done; end may be "never" (the largest number)
  std::optional<double> seconds{};  ///< of this call, wall clock
  /// Bound of the picture's error (`ErrorEstimate::is_below`). Looked at after numbers of passes that are fixed in
  /// advance, so that the picture does not depend on the machine's speed.
  std::optional<double> noise{};
  /// After the running passes; one pass is always rendered.
  const std::atomic<bool>* interrupted = nullptr;
  /// At once: the running passes are given up and leave no trace if `undo` allows it, and are finished otherwise.
  const std::atomic<bool>* drop = nullptr;
  Undo undo = Undo::if_cheap;
  /// Processes that share the passes (lanthorn/team.h). Those of other ranks than 0 obey that rank's rule. Until the
  /// render ends, `Session::picture` has the passes of this process alone.
  Team* team = nullptr;
};

/// How far a call of `Session::render` has come.
struct RenderProgress {
  double fraction = 0;                         ///< of the work, by whatever of the stop rule comes first
  std::optional<double> seconds_left{};        ///< 0 at the end; none: not known yet, or nothing ends the render
  std::optional<std::uint64_t> passes_left{};  ///< none: as many as the time or the bound of the error asks for
};
/// `state` and `statistics`: as an observer's `progress` has them.
RenderProgress progress_of(const StopRule& stop, const RenderState& state, const RenderStatistics& statistics);

/// What the pass loop reports. All are called on the thread that renders, between passes, or between batches of passes
/// that are rendered at once. Of a team, rank 0 reports; its states have the passes whose sums have been gathered.
struct Observer {
  /// Before the preparation and before every pass: whether `StopRule::drop` will stop it.
  std::function<void(bool)> can_drop = [](bool) {};
  /// After the preparation, if the method has found something that the user should know.
  std::function<void(const std::string&)> remark = [](const auto&) {};
  /// After the preparation. The settings of the state have what it found (`StateSummary::settings`).
  std::function<void(const RenderState&)> prepared = [](const auto&) {};
  /// After every pass.
  std::function<void(const RenderState&, const RenderStatistics&)> progress = [](const auto&, const auto&) {};
  /// After every pass, with the seconds since the last checkpoint. Returns true if it made one.
  std::function<bool(const RenderState&, double)> checkpoint = [](const auto&, double) { return false; };
};

/// Checks camera, film and crop window without a scene. Throws Error.
void check_view(const ViewDescription& view, const ViewOptions& options = {});
/// Width and height of the full film in pixels. A resolution whose height is 0 has that of the scene's shape. Throws
/// Error as `check_view` does.
std::array<int, 2> film_size(const ViewDescription& view, const ViewOptions& options = {});
/// Camera to world when the shutter opens, of a camera that frames a subject (`description::Camera::subject`) too.
/// Throws Error as `check_view` does.
Transform camera_placement(const ViewDescription& view, const ViewOptions& options = {});

/// A render of a scene: as many passes as wanted, and the picture at any time.
///
/// One thread at a time may call the functions that are not const. `picture`, `pass_count` and `stop` may be called
/// by any thread at any time.
class Session {
 public:
  /// Throws Error for unknown methods or parameters, values out of range, and what does not fit into memory.
  explicit Session(const SharedScene& scene, const RenderOptions& options = {});
  /// With another view than that of the scene's file. Its shutter must be the file's if anything moves.
  Session(SharedScene scene, const ViewDescription& view, const RenderOptions& options = {});
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  /// The passes and the time that options and scene ask for.
  const StopRule& plan() const;
  /// What the scene asks for and does not get, and light that the method leaves out.
  std::vector<description::Warning> warnings() const;

  /// Renders the passes of `stop.passes` that are not done yet.
  RenderStatistics render(const StopRule& stop, const Observer& observer = {});
  /// Renders what the plan asks for.
  RenderStatistics render(const Observer& observer = {}) { return render(plan(), observer); }
  /// Renders the next pass. False if `stop` ended it: the picture is that of the passes before.
  bool render_pass();
  /// Gives up the running pass of `render_pass` within milliseconds, or the next one if none is running.
  void stop();

  std::uint64_t pass_count() const;
  /// The picture of the passes done, with all its layers. Waits at most for the end of a short pass: long ones
  /// keep a copy of the film. Throws Error before the end of the first pass.
  Image picture() const;

  /// The sums so far; not while a pass is running.
  const RenderState& state() const;
  /// Goes on from a saved state, whose sums move into the session. Throws Error, naming the first difference, if it
  /// belongs to another render; `name` is that of its file, for the message.
  void resume(const std::shared_ptr<RenderState>& state, const std::string& name);

  /// Starts anew with another scene. The options and the view are kept: of a file's new scene, `set_view` takes its
  /// camera and film over. Passes, picture and sums of before are gone; states that were saved of them are not.
  void set_scene(SharedScene scene);
  /// Starts anew with another view of the same scene, which is not built again. The options are kept.
  void set_view(const ViewDescription& view);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lanthorn
