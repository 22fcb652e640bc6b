// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Frames by OpenGL, and their times. Those of a camera at rest each have their own random numbers, so that their mean
// gets smoother.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "camera/view.h"
#include "lanthorn/viewer.h"
#include "realtime/frame/renderer.h"
#include "realtime/techniques/technique.h"
#include "viewer/accumulation.h"

namespace lanthorn {

/// Settings of the methods that draw by OpenGL.
struct RealtimeSettings {
  std::string technique = "ispm";
  ParameterValues values;  ///< of all parameters of all techniques, by their names
  std::uint32_t photons = 20000;
  int max_depth = 64;
  std::uint64_t seed = 0;

  friend bool operator==(const RealtimeSettings&, const RealtimeSettings&) = default;
};

/// The technique whose frames stand for an offline method until its first pass is done.
inline constexpr const char* stand_in_technique = "ambient";

/// Settings from a viewer's options. Values that are "auto" follow the size and the lights of the scene, or of its
/// visible part. Throws Error for settings that no technique has.
RealtimeSettings realtime_settings(const Scene& scene, const View& view, const ViewerOptions& options);

/// Settings of frame `frame` (0: the first after a change) of the view.
FrameSettings frame_settings(const RealtimeSettings& settings, const View& view, std::uint32_t frame);

/// The view of a camera that a rasteriser can draw: spherical and realistic ones become perspective ones.
ViewDescription drawable(ViewDescription view);
bool is_drawable(const ViewDescription& view);

/// Differences between frames and the pictures of `render`, as text for the user.
std::vector<std::string> limitations_of(const Renderer& renderer, const Scene& scene, const RealtimeSettings& settings);

/// Spacing of eye paths while the eye moves (FrameSettings::eye_path_spacing), such that they take `budget` of a frame:
/// the processor follows some hundreds of them in a millisecond.
class EyePathSpacing {
 public:
  int pixels() const { return pixels_; }
  /// Adapts to the time of a frame that had this spacing.
  void learn(const FrameReport& report, int spacing);

 private:
  static constexpr double budget = 25;  // ms
  static constexpr int most = 8;        // pixels: coarser pictures show nothing any more
  int pixels_ = 1;
};

/// The resolution of frames while the eye or an object moves, chosen such that there are 10 to 17 frames a second.
class MovingResolution {
 public:
  /// The share of width and height.
  double share() const { return share_; }
  /// Adapts to the time until a frame with this share was shown, s.
  void learn(double seconds, double share);

 private:
  double share_ = 1;
};

/// For times of frames and of pauses.
using ViewerClock = std::chrono::steady_clock;

inline double seconds_since(ViewerClock::time_point start) {
  return std::chrono::duration<double>(ViewerClock::now() - start).count();
}

/// Adds the times of a frame to sums by the name of the stage, in the order in which stages first came.
class StageSums {
 public:
  void add(const FrameReport& report);
  /// Mean of the frames so far.
  std::vector<FrameStage> means() const;

 private:
  std::vector<FrameStage> sums_;
  std::uint64_t frames_ = 0;
};

}  // namespace lanthorn
