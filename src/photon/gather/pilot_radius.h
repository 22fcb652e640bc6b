// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "base/parameters.h"
#include "path/render_job.h"
#include "photon/flux_classes.h"
#include "photon/guides/guide_photons.h"

namespace lanthorn {

/// The parameter "radius" of methods with a radius for each pixel.
inline ParameterInfo first_radius_info() {
  return {"radius", "pixel",
          "first radius: pixel (one for each pixel), auto (one for the scene), or a length in metres"};
}
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
  FirstRadius(float largest, float typical, const FluxClasses& classes)
      : largest_(largest), typical_(typical), classes_(classes) {}
  /// Adds the next pixel of the window. `widest`: the largest radius that fits the surface, m.
  void add_pixel(float radius, float widest) {
    per_pixel_.push_back(radius);
    if (classes_.count() > 1) widest_.push_back(widest);
  }

  float at(std::uint32_t pixel) const { return per_pixel_.empty() ? typical_ : per_pixel_[pixel]; }
  /// Classes of the photons' flux; radii refer to the first class.
  const FluxClasses& classes() const { return classes_; }
  /// Ratio of a class's radius to the first class's radius, which currently is `radius`.
  float class_factor(int flux_class, std::uint32_t pixel, float radius) const {
    if (flux_class == 0) return 1;
    return std::clamp(widest_[pixel] / radius, 1.0f, FluxClasses::radius_factor(flux_class));
  }
  float largest() const { return largest_; }
  float typical() const { return typical_; }

 private:
  std::vector<float> per_pixel_;
  std::vector<float> widest_;  // by pixel, if there are several classes
  float largest_ = 0, typical_ = 0;
  FluxClasses classes_;
};

/// The radii of a pass, m: those of the first pass times `shrink`. Keeps a reference to the radii of the first pass.
class PassRadii {
 public:
  PassRadii(const FirstRadius& first, float shrink) : first_(&first), shrink_(shrink) {}

  const FluxClasses& classes() const { return first_->classes(); }
  float at(std::uint32_t pixel, int flux_class = 0) const {
    const float radius = first_->at(pixel) * shrink_;
    return radius * first_->class_factor(flux_class, pixel, radius);
  }
  float largest(int flux_class = 0) const {
    return first_->largest() * shrink_ * FluxClasses::radius_factor(flux_class);
  }
  float typical() const { return first_->typical() * shrink_; }

 private:
  const FirstRadius* first_;
  float shrink_;
};

/// Measures the first radius by a pilot pass: photons are stored in a kd-tree, and eye paths on a grid of pixels
/// measure the distance to their nearest photons. The distance is scaled so that a gather of the first pass finds about
/// `wanted_photons`. It is at most a twentieth of the scene's radius and, where the surface is not flat and clear that
/// far, at most ten pixels: where photons are few, noise is better than the darkening by a disc that reaches over an
/// edge. Depends on scene, view, seed and photon count only. `guide`: of the passes, or null. With `by_flux`, photons
/// of uneven flux have radii that depend on their flux.
FirstRadius choose_first_radius(const RenderJob& job, const RadiusChoice& choice, double wanted_photons,
                                const LightGuide* guide = nullptr, bool by_flux = false);

/// Measures in the same way the radius that holds `wanted_photons` where photons are dense, m. At most a twentieth of
/// the scene's radius.
float radius_of_photons(const RenderJob& job, double wanted_photons, const LightGuide* guide = nullptr);

/// Measures how many photons land in view for each one that is emitted, without an emission guide: the median over the
/// picture of photons per pixel, times the pixels. About 1 in a closed room. Indirect light and caustics only. 1 if no
/// surface that gathers photons is in view.
double photons_in_view(const RenderJob& job);

}  // namespace lanthorn
