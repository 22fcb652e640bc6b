// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A render that a user steers: it restarts after each change, coarse first, and refines while nothing changes.
#pragma once

#include <array>
#include <chrono>
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

/// A change to the picture of an `InteractiveRender`. Empty members leave their part unchanged. A new view or new
/// options only replace the film; the scene is not rebuilt. A new scene takes as long as its function: with a previous
/// scene, `build_scene` replaces lights, materials and transforms in a fraction of a millisecond.
struct RenderEdit {
  /// Makes the scene, on the render's thread. If it throws, the next edit calls it again, unless that edit brings
  /// another function. Must not return null.
  std::function<SharedScene()> scene{};
  std::optional<ViewDescription> view{};   ///< camera, film, filter
  std::optional<RenderOptions> options{};  ///< method and parameters, resolution, passes, time
  /// Another edit will follow soon, as while a camera is dragged: full passes are delayed by 0.3 s.
  bool is_moving = false;
};

struct InteractiveSettings {
  /// Each edit first shows one pass at a resolution that takes about 60 ms, then finer ones if a full pass takes long.
  /// If false, the first picture of an edit is its first full pass.
  bool coarse_first = true;
  /// Abandoned passes leave no trace in the film's sums, so that `state` can be saved. Costs a copy of the film before
  /// each pass.
  bool keeps_sums = false;
  bool denoises = false;  ///< see `InteractiveRender::denoise`
};

enum class InteractivePhase : std::uint8_t {
  preparing,    ///< the last edit has no full pass yet
  refining,     ///< each pass improves the picture
  paused,       ///< by `pause`
  finished,     ///< all passes are done that the options, or else the scene, ask for, or the error is below their bound
  out_of_time,  ///< the options' time limit is reached
  failed,       ///< the last edit cannot be rendered; `problem` says why
};

struct InteractiveStatus {
  std::uint64_t revision = 0;  ///< number of the last edit, see `InteractiveRender::edit`
  InteractivePhase phase = InteractivePhase::preparing;
  std::string problem{};  ///< what went wrong, if the phase is `failed`
};

/// A picture and its status.
struct InteractivePicture {
  Image image{};                   ///< all layers; if not coarse, also those of `with_noise`
  std::uint64_t revision = 0;      ///< number of the edit that it shows
  bool is_coarse = false;          ///< one pass at a low resolution
  std::array<int, 2> full_size{};  ///< width, height at full resolution
  StateSummary state{};            ///< passes, seconds, size, settings
  RenderStatistics statistics{};
  /// Estimated rendering time until the number of passes, the time limit or the error bound of the options (by default
  /// of the scene) is reached; 0 once it is reached. nullopt: not yet known, a coarse picture, or nothing ends the
  /// render.
  std::optional<double> seconds_left{};
  std::string limitation{};  ///< light that the method cannot render; empty: none
  /// The method's measurements and choices for this picture, see `Observer::remark`; empty: none, or a coarse picture.
  std::string remark{};
};

/// A denoised picture.
struct InteractiveDenoised {
  /// R, G, B by `preview_without_noise` if `is_preview`; otherwise all layers, as `with_denoised_light` makes them from
  /// a result of `denoise`.
  Image image{};
  bool is_preview = true;
  std::uint64_t passes = 0;  ///< of the picture that was denoised
};

/// The state of the render at one moment.
struct InteractiveSnapshot {
  std::uint64_t number = 0;  ///< increases with each new picture and each new phase
  InteractiveStatus status{};
  /// The last picture; null before the first. After a failed edit, a picture of an earlier edit.
  std::shared_ptr<const InteractivePicture> picture{};
  /// Denoised version of the edit that `picture` shows, from as many passes or fewer. Null if not requested or not
  /// ready.
  std::shared_ptr<const InteractiveDenoised> denoised{};
};

/// A render in its own thread, for a window or a server. Any thread may call any function at any time. Only `wait` and
/// `stop` block.
///
///     InteractiveRender render(scene, description_of(*scene).view, options);
///     render.edit({.view = moved});                      // the camera has moved: restarts
///     render.edit({.scene = [=] { return build_scene(changed, scene); }});
///     std::uint64_t shown = 0;
///     while (is_open) {
///       const InteractiveSnapshot now = render.wait(shown, std::chrono::milliseconds(50));
///       if (now.number != shown && now.picture) show(now.picture->image);
///       shown = now.number;
///     }
///
/// For given scene, view, options and number of passes, the picture equals that of a `Session` bit for bit.
class InteractiveRender {
 public:
  /// Starts to render. Throws Error for unknown methods or parameters, values out of range, and if memory does not
  /// suffice.
  InteractiveRender(SharedScene scene, const ViewDescription& view, const RenderOptions& options = {},
                    const InteractiveSettings& settings = {});
  /// Calls `stop`.
  ~InteractiveRender();
  InteractiveRender(const InteractiveRender&) = delete;
  InteractiveRender& operator=(const InteractiveRender&) = delete;

  /// Abandons the current pass and restarts with the change, applied on top of all earlier edits; edits that arrive
  /// faster than they can be rendered are combined. Returns the number of the edit. If the result cannot be rendered
  /// (the scene's function throws, the options are invalid), the last picture stays and the status is `failed` with the
  /// reason, until another edit replaces the rejected part.
  std::uint64_t edit(RenderEdit edit);
  /// Pauses after the current pass, or resumes. Later edits still show coarse pictures.
  void pause(bool is_paused);
  /// Turns denoising on or off. While passes are rendered, previews use at most a quarter of the time and are repeated
  /// whenever the number of passes has grown by half. The final picture is denoised at full quality. An edit cancels
  /// the denoising in progress.
  void denoise(bool is_wanted);

  InteractiveSnapshot snapshot() const;
  /// Waits for a snapshot whose number differs from `number`; returns the current one after `patience` or `stop`.
  InteractiveSnapshot wait(std::uint64_t number, std::chrono::milliseconds patience) const;

  /// Unsupported features of the first scene and view, and light that the first method cannot render.
  const std::vector<description::Warning>& warnings() const;

  /// Abandons the current pass within milliseconds (but a scene's function runs to its end) and ends the thread. Later
  /// edits have no effect.
  void stop();
  /// The film's sums for the last edit, ready to be saved. Null before `stop`, without `keeps_sums`, or if the last
  /// edit has no full pass yet.
  const RenderState* state() const;

 private:
  class Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace lanthorn
