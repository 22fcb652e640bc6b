// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The radii of merging, on surfaces and in media. A pilot measures the radii of the first pass; from there they shrink
// with the passes (Knaus & Zwicker 2011).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "integrators/vcm/uniformity_tests.h"
#include "integrators/vcm/vcm_settings.h"
#include "path/mis.h"
#include "path/render_job.h"
#include "photon/gather/kernels.h"
#include "photon/gather/pilot_radius.h"
#include "photon/media/volume_gather.h"

namespace lanthorn {

/// The kernel of merging on surfaces.
inline constexpr Kernel merge_kernel{KernelShape::epanechnikov};

/// Radii of merging on surfaces in the first pass, for each place on the film and each class of photon flux.
class FirstMergeRadii {
 public:
  FirstMergeRadii() = default;
  FirstMergeRadii(const RenderJob& job, const VcmSettings& settings, const LightGuide* guide);

  /// Window of the pixels that have their own radii; eye paths may pass beside it.
  const PixelWindow& window() const { return window_; }

 private:
  friend class MergeRadii;
  FirstRadius radius_;
  PixelWindow window_;
};

/// Factor by which the radii of merging on surfaces have shrunk in a pass. `light_paths`: the pass's number of light
/// paths relative to the number that the first radii are measured for. Radii depend on the photons of all passes so
/// far.
float merge_radius_shrink(double alpha, std::uint32_t pass, double light_paths);

/// Radii of merging on surfaces in a pass, relative to the radii of the first pass: one number for all pixels, or one
/// for each.
///
/// A wide disc has little noise, and no bias where the density of photons is uniform. There radii hardly need to
/// shrink: after each test that a pixel passes, they follow the schedule with α = .9. After each failed test the area
/// is halved, down to the area of the schedule with `alpha`, α < .9. After the last test all radii shrink by the
/// schedule with α = 2/3, so that all bias vanishes, at the rate with the least mean squared error.
class MergeShrinks {
 public:
  /// One factor for all pixels.
  explicit MergeShrinks(float shrink) { by_history_.fill(shrink); }
  /// A factor for each pixel, from the tests that were made before the pass. Keeps a reference to `tests`.
  /// `light_paths`: as for merge_radius_shrink.
  MergeShrinks(const UniformityTests& tests, double alpha, std::uint32_t pass, double light_paths);

  float at(std::uint32_t pixel) const { return by_history_[tests_ ? tests_->passed(pixel) : 0]; }
  float largest() const { return by_history_.back(); }
  float mean() const;

 private:
  const UniformityTests* tests_ = nullptr;
  // Area factors, indexed by a pixel's test results so far; results of tests after this pass are ignored.
  std::array<float, UniformityTests::histories> by_history_{};
};

/// Radii of merging on surfaces in a pass, m. Keeps a reference to the radii of the first pass.
class MergeRadii {
 public:
  MergeRadii(const FirstMergeRadii& first, const MergeShrinks& shrinks) : first_(&first), shrinks_(shrinks) {}

  const FluxClasses& classes() const { return first_->radius_.classes(); }
  /// The pixel whose radii apply to eye paths through this place on the film.
  std::uint32_t pixel_at(const Vec2& raster) const { return first_->window_.pixel_at(raster); }
  /// Radius of all merges of eye paths through this place on the film with photons of a class.
  float at(const Vec2& raster, int flux_class = 0) const {
    const std::uint32_t pixel = pixel_at(raster);
    return PassRadii(first_->radius_, shrinks_.at(pixel)).at(pixel, flux_class);
  }
  float largest(int flux_class) const { return PassRadii(first_->radius_, shrinks_.largest()).largest(flux_class); }
  float typical() const { return PassRadii(first_->radius_, shrinks_.mean()).typical(); }

 private:
  const FirstMergeRadii* first_;
  MergeShrinks shrinks_;
};

/// The kernels of a pass for merging in media, by estimator. Empty: the estimator is not used.
struct VolumeKernels {
  std::optional<KernelIn> point, beam, photon_beam, beams;

  bool any() const { return point || beam || photon_beam || beams; }
  /// Radius of the widest equivalent box kernel, m; 0 if there is none.
  float widest_radius() const;
  bool uses_points() const { return point || beam; }
  bool uses_beams() const { return photon_beam || beams; }
  /// The data for MIS weights. `beam_share`: share of the light paths whose flights are kept.
  VolumeMerging merging(float light_paths, float beam_share) const;
};

/// The radii of the first pass in media, m. Empty for estimators that the method does not use or that find no photons.
class FirstVolumeRadii {
 public:
  FirstVolumeRadii() = default;
  FirstVolumeRadii(const RenderJob& job, const VcmSettings& settings, const LightGuide* guide);

  VolumeKernels kernels(std::uint32_t pass) const;

 private:
  std::optional<float> of(VolumeEstimator estimator) const { return radii_[static_cast<std::size_t>(estimator)]; }

  std::array<std::optional<float>, volume_estimator_count> radii_;  ///< by VolumeEstimator
};

}  // namespace lanthorn
