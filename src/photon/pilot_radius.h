// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/parameters.h"
#include "light/emission_guide.h"
#include "path/render_job.h"

namespace lanthorn {

/// The parameter "radius" of methods with a radius for each pixel.
inline const ParameterInfo first_radius_info{
    "radius", "pixel", "first radius: pixel (one for each pixel), auto (one for the scene), or a length in metres"};
/// The parameter "alpha" of methods whose radii follow `RadiusSchedule`.
inline ParameterInfo radius_reduction_info(const char* default_alpha) {
  return {"alpha", default_alpha, "radius reduction in (0,1]: r^2 shrinks by (i+alpha)/(i+1); small: sharper, noisier"};
}

/// The choice of a progressive method's first radius.
struct RadiusChoice {
  enum class Kind : std::uint8_t { scene, pixel, given };
  Kind kind = Kind::scene;
  float given = 0;  ///< metres

  /// Reads the parameter "radius": auto, pixel, or a length in metres.
  static RadiusChoice from(const Parameters& parameters);
};

/// The radius of the first pass: one for all pixels, or one for each pixel of the window.
class FirstRadius {
 public:
  FirstRadius() = default;
  explicit FirstRadius(float radius) : largest_(radius), typical_(radius) {}
  FirstRadius(std::vector<float> per_pixel, float largest, float typical)
      : per_pixel_(std::move(per_pixel)), largest_(largest), typical_(typical) {}

  float at(std::uint32_t pixel) const { return per_pixel_.empty() ? typical_ : per_pixel_[pixel]; }
  float largest() const { return largest_; }
  float typical() const { return typical_; }

 private:
  std::vector<float> per_pixel_;
  float largest_ = 0, typical_ = 0;
};

/// Measures the first radius by a pilot pass: photons are stored in a kd-tree, and eye paths on a grid of pixels
/// measure the distance to their nearest photons. The distance is scaled so that a gather of the first pass finds about
/// `wanted_photons`. Depends on scene, seed, photon count and resolution only. `guide` is the emission guide of the
/// passes, or null.
FirstRadius choose_first_radius(const RenderJob& job, const RadiusChoice& choice, double wanted_photons,
                                const EmissionGuide* guide = nullptr);

}  // namespace lanthorn
