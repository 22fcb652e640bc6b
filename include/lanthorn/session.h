// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Renders a scene pass by pass.
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

/// Which backup of the film a render keeps, so that it can abandon running passes.
enum class Undo : std::uint8_t {
  /// A copy of the film, if the passes take at least a second and 50 times as long as the copy, and if the copy fits
  /// into a quarter of the free memory.
  if_cheap,
  always,  ///< a copy of the film
  never,   ///< no backup: abandoning a pass abandons the render
};

/// When to stop: at whichever limit is reached first. Any thread or signal handler may set the flags at any time.
///
/// There is always a picture, unless `drop` ends the first pass. If the time is limited, a render without a team that
/// begins with no passes, of 4096 pixels or more, first renders pictures of few pixels. If the time does not allow a
/// pass of the whole picture, such a picture, as fine as the time allows, takes its place (`RenderStatistics::coarse`).
/// The next call begins anew. Other renders without passes complete at least one.
struct StopRule {
  PassRange passes{0, 1};  ///< passes to complete; end may be "never" (the largest number)
  /// Wall-clock time of this call. No pass begins that is expected to end later than 5 % or half a second after it, and
  /// passes that can be abandoned are abandoned 10 % or half a second after it.
  std::optional<double> seconds{};
  /// Bound of the picture's error (`ErrorEstimate::is_below`). Checked only at predetermined numbers of passes, so that
  /// the picture does not depend on the machine's speed.
  std::optional<double> noise{};
  /// Estimates the error that `noise` bounds; empty: the error of the noisy picture is used. `DenoisedLooks` estimates
  /// the error of the denoised picture. Called after every third of the predetermined numbers of passes.
  std::function<ErrorEstimate(const RenderState&)> error_of{};
  /// Stops after the running passes.
  const std::atomic<bool>* interrupted = nullptr;
  /// Stops immediately: the running passes are abandoned without a trace if `undo` allows it, and completed otherwise.
  const std::atomic<bool>* drop = nullptr;
  Undo undo = Undo::if_cheap;
  /// Processes that share the passes (lanthorn/team.h). Ranks other than 0 follow the rule of rank 0. Until the render
  /// ends, `Session::picture` has only the passes of this process.
  Team* team = nullptr;
};

/// Progress of a call of `Session::render`.
struct RenderProgress {
  double fraction = 0;                         ///< of the work, in [0,1], by the limit of the stop rule that is nearest
  std::optional<double> seconds_left{};        ///< 0 at the end; nullopt: not yet known, or nothing ends the render
  std::optional<std::uint64_t> passes_left{};  ///< nullopt: as many as the time or the error bound requires
};
/// `state` and `statistics` are the arguments of an observer's `progress`.
RenderProgress progress_of(const StopRule& stop, const RenderState& state, const RenderStatistics& statistics);

/// Callbacks of the pass loop. All are called on the rendering thread, between passes or between batches of concurrent
/// passes. In a team, rank 0 calls them; its states have the passes whose sums have been gathered.
struct Observer {
  /// Before the preparation and before every pass: whether `StopRule::drop` will be able to stop it.
  std::function<void(bool)> can_drop = [](bool) {};
  /// After the preparation, with a message for the user about what the method measured and chose, if anything.
  std::function<void(const std::string&)> remark = [](const auto&) {};
  /// After the preparation. The state's record contains its results (`RenderRecord::findings`).
  std::function<void(const RenderState&)> prepared = [](const auto&) {};
  /// After every pass.
  std::function<void(const RenderState&, const RenderStatistics&)> progress = [](const auto&, const auto&) {};
  /// After every pass, with the seconds since the last checkpoint. Returns true if it wrote one.
  std::function<bool(const RenderState&, double)> checkpoint = [](const auto&, double) { return false; };
};

/// Checks camera, film and crop window without a scene. Throws Error.
void check_view(const ViewDescription& view, const ViewOptions& options = {});
/// Width and height of the full film in pixels. If the requested height is 0, it follows from the scene's aspect ratio.
/// Throws Error as `check_view` does.
std::array<int, 2> film_size(const ViewDescription& view, const ViewOptions& options = {});
/// Camera to world when the shutter opens, including the framing of a subject (`description::Camera::subject`). Throws
/// Error as `check_view` does.
Transform camera_placement(const ViewDescription& view, const ViewOptions& options = {});

/// Renders a scene: as many passes as wanted, with the picture available at any time.
///
/// Only one thread at a time may call non-const functions. Any thread may call `picture`, `pass_count` and `stop` at
/// any time.
class Session {
 public:
  /// Throws Error for unknown methods or parameters, values out of range, and if memory does not suffice.
  explicit Session(const SharedScene& scene, const RenderOptions& options = {});
  /// Replaces the view of the scene's file. The shutter times must be those of the file if anything moves.
  Session(SharedScene scene, const ViewDescription& view, const RenderOptions& options = {});
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  /// The stop rule that follows from options and scene.
  const StopRule& plan() const;
  /// Unsupported features of the scene, and light that the method cannot render.
  std::vector<description::Warning> warnings() const;

  /// Renders those passes of `stop.passes` that are not done yet.
  RenderStatistics render(const StopRule& stop, const Observer& observer = {});
  /// Renders according to `plan`.
  RenderStatistics render(const Observer& observer = {}) { return render(plan(), observer); }
  /// Renders the next pass. Returns false if `stop` ended it: the picture then contains only the earlier passes.
  bool render_pass();
  /// Abandons the running pass of `render_pass` within milliseconds, or the next one if none is running.
  void stop();

  std::uint64_t pass_count() const;
  /// The picture of the completed passes with all its layers. Waits at most until a short pass ends: long passes keep a
  /// copy of the film. Throws Error before the end of the first pass.
  Image picture() const;

  /// The film's sums so far; do not call it while a pass is running.
  const RenderState& state() const;
  /// Continues from a saved state, whose sums move into the session. Throws Error, naming the first difference, if it
  /// belongs to another render; `name` is its file name, for the message.
  void resume(const std::shared_ptr<RenderState>& state, const std::string& name);

  /// Restarts with another scene. Options and view are kept; use `set_view` to apply the camera and film of the new
  /// scene's file. Discards passes, picture and sums; states that were saved remain.
  void set_scene(SharedScene scene);
  /// Restarts with another view of the same scene, which is not rebuilt. The options are kept.
  void set_view(const ViewDescription& view);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lanthorn
