// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A picture of fewer pixels takes the place of a first pass that the time limit does not allow.
#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "lanthorn/session.h"
#include "render/plan.h"

namespace lanthorn {

/// Renders the passes of a plan: `render` without stand-ins. `may_be_none`: the time may end it before its first pass
/// is complete.
using RenderPasses = std::function<RenderStatistics(RenderPlan& plan, const StopRule& stop, bool may_be_none)>;

/// Renders pictures of fewer pixels until it is known whether a pass of the whole picture fits into the time. The last
/// one can be enlarged into the film of the whole picture, which then has its passes. Such a state merges only with
/// states of the same size, because its size is a part of its identity.
class StandIn {
 public:
  /// A picture of so few pixels needs none: even if each takes .1 ms, a pass takes only half a second.
  static constexpr double fewest_pixels = 4096;

  StandIn(const Scene& scene, const RenderPlan& plan, RenderPasses render);

  /// Renders the coarse pictures. Returns false if a pass of the whole picture is not expected to fit into the rest of
  /// the time, `seconds_left()`. `drop` abandons the first picture, `deadline` all others; both may be null.
  bool allows_pass(const std::function<double()>& seconds_left, const std::atomic<bool>* drop,
                   const std::atomic<bool>* deadline);
  /// Uses the rest of the time for a picture that is as fine as possible, and for more of its passes.
  void refine(double seconds, const StopRule& stop);

  bool has_picture() const { return coarse_.has_value(); }
  /// Makes the picture the state of the plan, whose state must be without passes. Precondition: there is one.
  void put_into(RenderPlan& plan, RenderStatistics& statistics);

 private:
  bool render(double pixels, const StopRule& stop);

  const Scene& scene_;
  const RenderPlan& plan_;
  RenderPasses render_passes_;
  double full_;                       // pixels
  std::optional<RenderPlan> coarse_;  // with the passes of its picture
  RenderStatistics statistics_;       // of it
  double seconds_per_pixel_ = 0;      // of its passes
};

/// Removes a stand-in from the plan's state, so that the render can begin.
void remove_stand_in(RenderPlan& plan);

}  // namespace lanthorn
