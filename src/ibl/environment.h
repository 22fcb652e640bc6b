// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// An environment as its image file has it, and what is made of it before any filtering: a cube map, and suns.
//
// A sun is what of a texel is brighter than its surroundings by far. Few samples of a filter find it, and those that do
// weigh too much. So the excess is taken out of the texels and kept by itself: as light from points, which every filter
// adds exactly.
#pragma once

#include <cstdint>
#include <vector>

#include "ibl/cube_map.h"
#include "lanthorn/ibl.h"
#include "lanthorn/image.h"
#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// Light from one direction: `flux` through a surface that faces it, that is radiance times solid angle.
struct PointFlux {
  Direction direction{0, 1, 0};
  Spectrum flux;
};

class Environment {
 public:
  /// `image` as `read_environment` returns it. Negative and non-finite values count as 0.
  explicit Environment(const Image& image);

  EnvironmentLayout layout() const { return layout_; }
  int width() const { return image_.width; }
  int height() const { return image_.height; }
  /// Values that count as 0 because they are negative or not finite.
  std::uint64_t unusable_values() const { return unusable_; }
  /// Texels across a right angle.
  float texels_per_face() const;

  Direction direction_at(float x, float y) const;  ///< of a place in the image, in texels
  float solid_angle(int x, int y) const;           ///< of a texel, sr
  Spectrum texel(int x, int y) const;
  /// Bilinear; of each texel what is left without suns.
  Spectrum radiance_without_suns(const Direction& direction) const;

  /// A map of the environment without its suns, seams closed: `samples`² look-ups for each texel.
  CubeMap cube_without_suns(int size) const;

  struct Sun {
    int x = 0, y = 0;
    Spectrum excess;  ///< radiance
  };
  const std::vector<Sun>& suns() const { return suns_; }
  /// Luminance above which light belongs to suns.
  float sun_threshold() const { return threshold_; }
  /// The suns as points about `spacing` radians apart: large texels give several, close ones share one.
  std::vector<PointFlux> sun_points(float spacing) const;

 private:
  Spectrum texel_without_sun(int x, int y) const;
  Vec2 place_of(const Direction& direction) const;
  void find_suns();

  const Image& image_;
  EnvironmentLayout layout_ = EnvironmentLayout::equirectangular;
  std::size_t red_ = 0, green_ = 0, blue_ = 0;  // channels
  std::uint64_t unusable_ = 0;
  float threshold_ = infinity;
  std::vector<Sun> suns_;
};

}  // namespace lanthorn
