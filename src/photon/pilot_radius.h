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
/// `wanted_photons`, but is at most a twentieth of the scene's radius and, where the surface is not flat and clear that
/// far, ten pixels: where photons are too few, noise is better than the dark that a disc over an edge would make.
/// Depends on scene, view, seed and photon count only. `guide` is the emission guide of the passes, or null.
FirstRadius choose_first_radius(const RenderJob& job, const RadiusChoice& choice, double wanted_photons,
                                const EmissionGuide* guide = nullptr);

/// Measures in the same way the radius that holds `wanted_photons` where photons are dense, m. At most a twentieth of
/// the scene's radius.
float radius_of_photons(const RenderJob& job, double wanted_photons, const EmissionGuide* guide = nullptr);

/// Measures how many photons land in view for each one that is emitted, without an emission guide: the median over the
/// picture of photons per pixel, times the pixels. About 1 in a closed room. Indirect light and caustics only. 1 if no
/// surface that gathers photons is in view.
double photons_in_view(const RenderJob& job);

}  // namespace lanthorn
