// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The pass loop: one for all methods.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "integrators/integrator.h"
#include "render/pass_undo.h"
#include "render/state.h"

namespace lanthorn {

/// When to stop; whatever comes first. The flags may be set at any time, by any thread or signal handler.
struct StopRule {
  PassRange passes{0, 1};         ///< passes to have done; end may be "never" (max)
  std::optional<double> seconds;  ///< of this call, wall clock
  /// After the running pass; one pass is always rendered.
  const std::atomic<bool>* interrupted = nullptr;
  /// At once: the running pass is given up and leaves no trace, where `undo` allows it; else it is finished.
  const std::atomic<bool>* drop = nullptr;
  Undo undo = Undo::if_cheap;
};

/// Sums over the passes of this call.
struct RenderStatistics {
  std::uint64_t passes = 0;
  double seconds = 0;  ///< wall clock, preparation included
  double prepare_seconds = 0;
  std::array<double, phase_count> phase_seconds{};  ///< by Phase
  double first_pass_seconds = 0;                    ///< from the call to the end of the first pass
  RayCounts rays;
  std::uint64_t light_paths = 0, photons_stored = 0;
  std::size_t photon_map_bytes = 0;  ///< largest
  std::uint64_t cache_records = 0, cache_misses = 0;
  float radius = 0;  ///< of the last pass, metres; 0 if the method has none
};

/// What the loop tells the outside. All are called between passes, on the calling thread.
struct Observer {
  /// Before the preparation and before every pass: whether `StopRule::drop` will stop it.
  std::function<void(bool)> can_drop = [](bool) {};
  /// After every pass.
  std::function<void(const RenderState&, const RenderStatistics&)> progress = [](const auto&, const auto&) {};
  /// Asked after every pass with the seconds since the last checkpoint; true if one was made.
  std::function<bool(const RenderState&, double)> checkpoint = [](const auto&, double) { return false; };
};

/// Renders the passes of `stop.passes` that `state` has not done yet, in order, and returns the state with them.
/// `integrator` is made ready by this function; it must be a new one. The state has no passes if the first was dropped.
RenderState render(const RenderJob& job, Integrator& integrator, RenderState state, const StopRule& stop,
                   const Observer& observer, RenderStatistics& statistics);

/// What the film could not add exactly, as a line for the user; nothing if all is well.
std::optional<std::string> describe_problems(const FilmReport& report);

}  // namespace lanthorn
