// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// An environment as its image stores it, and its representation before any filtering: a cube map, and suns.
//
// A sun is the part of a texel that is far brighter than its surroundings. A filter's few samples rarely hit it, and
// those that do get too much weight. Therefore the excess is removed from the texels and stored separately, as light
// from points, which every filter adds exactly.
#pragma once

#include <cstdint>
#include <vector>

#include "ibl/cube_map.h"
#include "lanthorn/ibl.h"
#include "lanthorn/image.h"
#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// Light from one direction: `flux` through a surface that faces it, that is, radiance times solid angle.
struct PointFlux {
  Direction direction{0, 1, 0};
  Spectrum flux;
};

class Environment {
 public:
  /// `image`: a result of `read_environment`. Values that are negative, not finite or above
  /// `largest_environment_radiance` count as 0.
  explicit Environment(const Image& image);

  EnvironmentLayout layout() const { return layout_; }
  int width() const { return image_.width; }
  int height() const { return image_.height; }
  /// Number of values that count as 0: negative, not finite or too large.
  std::uint64_t unusable_values() const { return unusable_; }
  /// Texels per right angle.
  float texels_per_face() const;

  Direction direction_at(float x, float y) const;    ///< at a position in the image, in texels
  Direction direction_of_texel(int x, int y) const;  ///< of its centre
  float solid_angle(int x, int y) const;             ///< of a texel, sr
  /// Solid angle of a square around a position, `cell` texels wide.
  float solid_angle_of_cell(float x, float y, float cell) const;
  Spectrum texel(int x, int y) const;
  /// Points across a texel that cosine-weighted sums need: one, unless the image is small.
  int pieces_for_smooth_kernels() const;
  /// Calls `visit(PointFlux)` for `pieces`² points of each texel of a row. The fourth component of the flux is the
  /// solid angle.
  template <class Visit>
  void for_points_of_row(int y, int pieces, Visit&& visit) const;
  /// Bilinear; texels exclude their suns' excess.
  Spectrum radiance_without_suns(const Direction& direction) const;

  /// A map of the environment without its suns, seams closed: `samples`² look-ups per texel.
  CubeMap cube_without_suns(int size) const;

  struct Sun {
    int x = 0, y = 0;
    Spectrum excess;  ///< radiance above the threshold
  };
  const std::vector<Sun>& suns() const { return suns_; }
  /// Luminance above which light belongs to suns.
  float sun_threshold() const { return threshold_; }
  /// The suns as points about `spacing` radians apart: large texels are split, close ones merged.
  std::vector<PointFlux> sun_points(float spacing) const;

 private:
  Spectrum texel_without_sun(int x, int y) const;
  Vec2 place_of(const Direction& direction) const;
  void find_suns();

  // Directions of the texels of equirectangular images: cosine and sine by column and by row.
  struct Angle {
    float cos, sin;
  };

  const Image& image_;
  std::vector<Angle> azimuths_, polar_angles_;
  float solid_angle_by_sine_ = 0;  // divided by the sine of the polar angle
  EnvironmentLayout layout_ = EnvironmentLayout::equirectangular;
  std::size_t red_ = 0, green_ = 0, blue_ = 0;  // channel indices
  std::uint64_t unusable_ = 0;
  float threshold_ = infinity;
  std::vector<Sun> suns_;
};

template <class Visit>
void Environment::for_points_of_row(int y, int pieces, Visit&& visit) const {
  const float step = 1 / static_cast<float>(pieces);
  const auto place = [&](int texel, int piece) {
    return static_cast<float>(texel) + (static_cast<float>(piece) + 0.5f) * step;
  };
  const auto visit_point = [&](const Direction& direction, const Spectrum& radiance, float omega) {
    Spectrum flux = omega * radiance;
    flux[3] = omega;
    visit(PointFlux{direction, flux});
  };
  for (int x = 0; x < width(); ++x) {
    const Spectrum radiance = texel(x, y);
    if (pieces == 1) {
      visit_point(direction_of_texel(x, y), radiance, solid_angle(x, y));
      continue;
    }
    for (int j = 0; j < pieces; ++j)
      for (int i = 0; i < pieces; ++i) {
        const float u = place(x, i), v = place(y, j);
        visit_point(direction_at(u, v), radiance, solid_angle_of_cell(u, v, step));
      }
  }
}

}  // namespace lanthorn
