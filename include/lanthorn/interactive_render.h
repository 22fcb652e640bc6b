// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A render that a user steers: it starts again after each change, coarse first, and refines while nothing changes.
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

/// A change of what an `InteractiveRender` shows. Empty members leave their part as it is. A new view or new options
/// need another film, and nothing of the scene is built again. A new scene costs what its function costs: `edit_scene`
/// replaces lights, materials and places in a fraction of a millisecond; `build_scene` builds geometry, and takes as
/// long as the first time.
struct RenderEdit {
  /// Makes the scene, on the render's thread. If it throws, the next edit calls it again, unless that edit brings
  /// another function. It must not return null.
  std::function<SharedScene()> scene{};
  std::optional<ViewDescription> view{};   ///< camera, film, filter
  std::optional<RenderOptions> options{};  ///< method and parameters, resolution, passes, time
  /// Another edit will follow soon, as while a camera is dragged: full passes wait for .3 s.
  bool is_moving = false;
};

struct InteractiveSettings {
  /// Each edit first shows one pass at a resolution that takes about 60 ms, then finer ones while a full pass would
  /// take long. Otherwise the first picture of an edit is that of its first full pass.
  bool coarse_first = true;
  /// Passes that are given up leave no trace in the sums, so that `state` can be saved. Costs a copy of the film before
  /// each pass.
  bool keeps_sums = false;
  bool denoises = false;  ///< see `InteractiveRender::denoise`
};

enum class InteractivePhase : std::uint8_t {
  preparing,    ///< there is no full pass of the last edit yet
  refining,     ///< each pass makes the picture better
  paused,       ///< by `pause`
  finished,     ///< all passes are done that the options, or else the scene, ask for, or the error is below their bound
  out_of_time,  ///< the time of the options is over
  failed,       ///< the last edit cannot be rendered; `problem` says why
};

struct InteractiveStatus {
  std::uint64_t revision = 0;  ///< of the last edit
  InteractivePhase phase = InteractivePhase::preparing;
  std::string problem{};  ///< what went wrong, if the phase is `failed`
};

/// A picture with what belongs to it.
struct InteractivePicture {
  Image image{};                   ///< all layers; unless it is coarse, with those of `with_noise`
  std::uint64_t revision = 0;      ///< of the edit that it shows
  bool is_coarse = false;          ///< one pass at a low resolution
  std::array<int, 2> full_size{};  ///< width, height of the picture that is not coarse
  StateSummary state{};            ///< passes, seconds, size, settings
  RenderStatistics statistics{};
  /// Of rendering, until the passes, the time or the bound of the error are reached that the options, or else the
  /// scene, ask for; 0 then. None: not known yet, coarse, or nothing ends the render.
  std::optional<double> seconds_left{};
  std::string limitation{};  ///< light that the method leaves out; empty: none
  /// What the method has found and chosen for this picture, as `Observer::remark`; empty: nothing, or coarse.
  std::string remark{};
};

/// A picture without its noise.
struct InteractiveDenoised {
  /// R, G, B, by `preview_without_noise`; or all layers, as `with_denoised_light` makes them of `denoise`.
  Image image{};
  bool is_preview = true;
  std::uint64_t passes = 0;  ///< of the picture that was denoised
};

/// What there is to see at a moment.
struct InteractiveSnapshot {
  std::uint64_t number = 0;  ///< grows with each new picture and each new phase
  InteractiveStatus status{};
  /// The last picture; null before the first. After a failed edit, it is that of an edit before.
  std::shared_ptr<const InteractivePicture> picture{};
  /// Of the edit that the picture shows, and of as many passes or fewer. Null if it is not wanted, or not there yet.
  std::shared_ptr<const InteractiveDenoised> denoised{};
};

/// A render in a thread of its own, for a window or a server. Any thread may call any function at any time. Only `wait`
/// and `stop` wait.
///
///     InteractiveRender render(scene, description_of(*scene).view, options);
///     render.edit({.view = moved});                      // the camera has moved: starts again
///     render.edit({.scene = [=] { return edit_scene(*scene, edits); }});
///     std::uint64_t shown = 0;
///     while (is_open) {
///       const InteractiveSnapshot now = render.wait(shown, std::chrono::milliseconds(50));
///       if (now.number != shown && now.picture) show(now.picture->image);
///       shown = now.number;
///     }
///
/// The picture of given scene, view, options and number of passes is the same, bit for bit, as that of a `Session`.
class InteractiveRender {
 public:
  /// Starts to render. Throws Error for unknown methods or parameters, values out of range, and what does not fit into
  /// memory.
  InteractiveRender(SharedScene scene, const ViewDescription& view, const RenderOptions& options = {},
                    const InteractiveSettings& settings = {});
  /// As `stop`.
  ~InteractiveRender();
  InteractiveRender(const InteractiveRender&) = delete;
  InteractiveRender& operator=(const InteractiveRender&) = delete;

  /// Gives up the running pass and starts again with what is changed, upon all edits before; of edits that come faster
  /// than they can be rendered, only the sum is. Returns the number of the edit. If the result cannot be rendered (the
  /// scene's function throws, the options do not fit), the last picture stays, and the status is `failed` with the
  /// reason until another edit comes: replace the part that was refused.
  std::uint64_t edit(RenderEdit edit);
  /// Rests after the running pass, or goes on. Coarse pictures of later edits are rendered all the same.
  void pause(bool is_paused);
  /// Whether pictures at rest are denoised, besides. While passes are rendered, that takes a quarter of the time at
  /// most, and is done again when there are half as many passes more: a preview. The picture of the end gets full
  /// quality. An edit gives up what is being denoised.
  void denoise(bool is_wanted);

  InteractiveSnapshot snapshot() const;
  /// The first snapshot with another number than `number`, or what there is when `patience` is over or after `stop`.
  InteractiveSnapshot wait(std::uint64_t number, std::chrono::milliseconds patience) const;

  /// What the first scene and view ask for and do not get, and light that the first method leaves out.
  const std::vector<description::Warning>& warnings() const;

  /// Gives up the running pass within milliseconds (a scene's function runs to its end) and ends the thread. Edits have
  /// no effect after it.
  void stop();
  /// The sums of the last edit, to be saved. Null before `stop`, without `keeps_sums`, and before the first full pass
  /// of the last edit.
  const RenderState* state() const;

 private:
  class Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace lanthorn
