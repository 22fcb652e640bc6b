// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A render that starts anew whenever somebody moves the camera or a light: coarse at once, then finer and finer.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "../scene_changes.h"
#include "frame.h"
#include "http_server.h"
#include "lanthorn/session.h"

namespace lanthorn::program {

/// What a page asks for; what is missing stays as it is.
struct ViewerEdit {
  bool home = false;  ///< camera and lights as at the start, before the edits below
  std::optional<LookAt> look{};
  std::optional<LightFactors> lights{};
  std::optional<bool> paused{};
  bool moving = false;  ///< more edits will follow at once: coarse pictures will do
};

struct ViewerSettings {
  /// The command line that renders the picture of these changes after so many passes.
  std::function<std::string(const SceneChanges&, std::uint64_t)> command;
  RenderOptions options{};
  SceneChanges changes{};   ///< at the start
  bool keeps_sums = false;  ///< a pass that is given up leaves no trace, so that the sums can be saved
};

/// One thread runs it; any others edit and look.
class Viewer {
 public:
  /// Throws Error as `Session` does, and for lights that the scene does not have.
  Viewer(const SharedScene& scene, ViewerSettings settings);

  /// Renders until `end`, as long as somebody has looked within the last half minute, or the sums are kept.
  void run();
  /// Ends the running pass and `run`.
  void end();
  /// After `run`: the full picture; null if what was seen last is only there as a coarse one.
  const Session* session() const;

  /// Throws Error for cameras and lights that cannot be.
  void apply(const ViewerEdit& edit);
  /// The first frame after the one with number `after`; null if none comes for ten seconds, or `is_gone`.
  std::shared_ptr<const PageFrame> wait_for_frame(std::uint64_t after, const IsGone& is_gone);
  /// Null before the first.
  std::shared_ptr<const PageFrame> last_frame() const;

  /// The session's warnings and the scene's lights do not change.
  const std::vector<description::Warning>& warnings() const { return warnings_; }
  const std::vector<NamedLight>& lights() const { return lights_; }
  const Scene& scene() const { return *scene_; }
  /// What is seen at the start.
  ViewDescription first_view() const { return view_of(*scene_, settings_.changes, settings_.options); }

 private:
  using Clock = std::chrono::steady_clock;
  using Lock = std::unique_lock<std::mutex>;

  // What decides the picture; the revision tells two of them apart.
  struct Wanted {
    SceneChanges changes{};
    std::uint64_t revision = 0;
  };
  enum class Step { coarse, refine, wait, end };

  Step next_step() const;
  void render_coarse(const Wanted& wanted);
  double render_coarse(const Wanted& wanted, double pixels);
  void refine(const Wanted& wanted);
  bool is_wanted(const Wanted& wanted) const;
  bool is_watched() const { return settings_.keeps_sums || Clock::now() < watched_until_; }
  SharedScene scene_of(const SceneChanges& changes) const { return scale_lights(scene_, changes.lights); }
  RenderOptions coarse_options(double pixels) const;

  void show(const Wanted& wanted, const RenderState& state, const RenderStatistics& statistics, bool is_coarse);
  void show_status();
  nlohmann::json status() const;
  void fail(const Wanted& wanted, const std::string& problem);

  SharedScene scene_;
  ViewerSettings settings_;
  Session session_;
  std::vector<description::Warning> warnings_;
  std::vector<NamedLight> lights_;
  LightFactors session_lights_;  // of the session's scene
  double full_pixels_ = 1, full_photons_ = 0, aspect_ = 1;
  bool is_mirrored_ = false;
  double coarse_pixels_;  // that a coarse pass in time has
  Clock::time_point next_frame_{};

  mutable std::mutex mutex_;  // of all below
  std::condition_variable edited_, framed_;
  Wanted wanted_;
  LookAt home_;
  bool has_home_ = false, is_paused_ = false, is_finished_ = false;
  std::uint64_t coarse_revision_ = 0, full_revision_ = 0, failed_revision_ = 0;
  std::string problem_;
  Clock::time_point moving_until_{}, watched_until_{};
  std::shared_ptr<const PageFrame> frame_;
  nlohmann::json progress_ = nlohmann::json::object();  // of the last picture
  std::atomic<bool> has_ended_{false};
  std::atomic<bool> drop_{false};  // the running pass: another picture is wanted
  std::atomic<bool> rest_{false};  // after the running pass
};

}  // namespace lanthorn::program
