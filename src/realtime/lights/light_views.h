// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The lights of a frame as points and directions from which a rasteriser sees the scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "math/sampler.h"
#include "math/vec.h"
#include "realtime/scene/layouts.h"
#include "realtime/scene/projection.h"
#include "scene/scene.h"

namespace lanthorn {

/// A point of a light, or a direction of one that is far away. Its maps cover all directions of its light.
struct LightView {
  enum class Kind : std::uint8_t { point = gpu::view_point, area = gpu::view_area, parallel = gpu::view_parallel };
  Kind kind = Kind::point;
  std::uint32_t light = 0;  ///< into Scene::lights()
  Point origin{0};
  float position_error = 0;  ///< bound of the distance between the origin and the surface of the light, metres
  Direction axis{0, 0, 1};   ///< of a spot; normal of a surface; towards a far light
  /// W/sr of a surface at normal incidence, or W/m² of a far light; divided by the probability of the point or
  /// direction.
  Vec3 colour{0};
  bool two_sided = false;
  float cone_start = 4, cone_end = 4;  ///< 1 - cos of a spot's angles; 4: no cone
  bool square_falloff = false;
  bool is_all_around = false;  ///< one direction of light all around
  /// The 6 faces of a cube around a point, 5 of them for a surface, otherwise 1. Parallel light in a large scene has 2
  /// windows: the first covers some whole texels of the second, around the focus.
  std::vector<WindowRays> windows;
  float power = 0;  ///< W, luminance: bound of the power that leaves it, by which photons are shared out
};

/// The region in which parallel light needs finer maps than the maps of the whole scene.
struct LightFocus {
  Point centre{0};
  float radius = 0;  ///< m

  friend bool operator==(const LightFocus&, const LightFocus&) = default;
};

/// Settings of the choice of views.
struct LightViewSettings {
  std::uint64_t seed = 0;
  std::uint32_t frame = 0;
  bool is_random = true;  ///< views of extended lights move from frame to frame, so that frames have the right mean
  int most_views = 16;    ///< at most this many, at least one
  int sky_views = 4;      ///< of each light all around
  int map_size = 256;     ///< texels along a side of a window
  std::optional<LightFocus> focus;

  friend bool operator==(const LightViewSettings&, const LightViewSettings&) = default;
};

/// Views of the frame. Lights have one each, lights all around `sky_views`; if there are too many, some are chosen at
/// random in proportion to their power. `light_limitations` names the lights that have no views.
std::vector<LightView> light_views(const Scene& scene, const LightViewSettings& settings);

/// Numbers of photons of the views, in proportion to their powers; their sum is `photons`, if any view has power.
std::vector<std::uint32_t> share_photons(const std::vector<LightView>& views, std::uint32_t photons);

/// Messages on the lights that have no views (projected images, goniometric lights, portals, media) and on those whose
/// views differ (area lights with a spread).
std::vector<std::string> light_limitations(const Scene& scene);

}  // namespace lanthorn
