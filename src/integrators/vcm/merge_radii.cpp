// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/vcm/merge_radii.h"

#include <algorithm>
#include <cmath>

#include "photon/gather/radius_schedule.h"
#include "photon/media/volume_radius.h"

namespace lanthorn {

FirstMergeRadii::FirstMergeRadii(const RenderJob& job, const VcmSettings& settings, const LightGuide* guide) {
  constexpr double photons_of_first_merge = 16;
  // With connections, MIS leaves light that only few photons carry to the connections; discs of equal size then have
  // less noise.
  const bool by_flux = !settings.switches.connections;
  View reach = job.view;
  reach.window = window_ = job.view.filter_reach();
  radius_ =
      choose_first_radius({job.scene, reach, job.settings}, settings.radius, photons_of_first_merge, guide, by_flux);
}

float merge_radius_shrink(double alpha, std::uint32_t pass, double light_paths) {
  const double passes = std::max(1.0, light_paths * (static_cast<double>(pass) + 1));
  return static_cast<float>(std::sqrt(RadiusSchedule{1, alpha}.shrink2_after(passes)));
}

MergeShrinks::MergeShrinks(const UniformityTests& tests, double alpha, std::uint32_t pass, double light_paths)
    : tests_(&tests) {
  const auto area_by = [&](double schedule, std::uint32_t in_pass) {
    return sqr(merge_radius_shrink(schedule, in_pass, light_paths));
  };
  const auto narrow = [&](std::uint32_t in_pass) { return area_by(alpha, in_pass); };
  const auto wide = [&](std::uint32_t in_pass) { return area_by(0.9, in_pass); };
  // The rate with the least mean squared error (Kaplanyan & Dachsbacher 2013).
  const auto best = [&](std::uint32_t in_pass) { return area_by(2.0 / 3, in_pass); };
  const std::uint32_t last = std::min(pass, UniformityTests::counted_passes);
  for (unsigned history = 0; history < UniformityTests::histories; ++history) {
    float area = pass == 0 ? narrow(0) : wide(0);
    for (unsigned t = 0; t < UniformityTests::tests && UniformityTests::pass_of_test(t) <= last; ++t) {
      const std::uint32_t until = std::min(last, UniformityTests::pass_of_test(t + 1) - 1);
      area = (history >> t & 1) != 0 ? std::min(area, wide(until)) : std::max(area / 2, narrow(until));
    }
    by_history_[history] = std::sqrt(area * best(pass) / best(last));
  }
}

float MergeShrinks::mean() const {
  if (!tests_) return by_history_[0];
  double sum = 0;
  for (std::uint32_t pixel = 0; pixel < tests_->pixel_count(); ++pixel) sum += static_cast<double>(at(pixel));
  return static_cast<float>(sum / static_cast<double>(tests_->pixel_count()));
}

float VolumeKernels::widest_radius() const {
  float widest = 0;
  for (const std::optional<KernelIn>* kernel : {&point, &beam, &photon_beam, &beams})
    if (*kernel) widest = std::max(widest, (*kernel)->radius());
  return widest;
}

VolumeMerging VolumeKernels::merging(float light_paths, float beam_share) const {
  // Size of the equivalent box kernel.
  const auto size = [](const std::optional<KernelIn>& kernel) { return kernel ? kernel->box_size() : 0.0f; };
  return {light_paths * size(point), light_paths * size(beam), light_paths * beam_share * size(photon_beam),
          light_paths * beam_share * size(beams)};
}

FirstVolumeRadii::FirstVolumeRadii(const RenderJob& job, const VcmSettings& settings, const LightGuide* guide) {
  if (!job.scene.has_scattering_media()) return;
  for (const VolumeEstimator estimator :
       {VolumeEstimator::point, VolumeEstimator::beam, VolumeEstimator::photon_beam, VolumeEstimator::beams}) {
    if (!settings.merges_by(estimator)) continue;
    const float radius = first_volume_radius(job, estimator, settings.volume_radius, merge_kernel, guide, 1);
    if (radius > 0) radii_[static_cast<std::size_t>(estimator)] = radius;
  }
}

VolumeKernels FirstVolumeRadii::kernels(std::uint32_t pass) const {
  // The first radius is chosen for this schedule (`first_volume_radius`).
  const RadiusSchedule schedule{.first_radius = 1, .alpha = 2.0 / 3};
  const auto kernel_of = [&](VolumeEstimator estimator) -> std::optional<KernelIn> {
    const std::optional<float> first = of(estimator);
    if (!first) return {};
    const int dimensions = kernel_dimensions(estimator);
    return KernelIn(dimensions, merge_kernel, *first * schedule.shrink(pass, dimensions));
  };
  return {kernel_of(VolumeEstimator::point), kernel_of(VolumeEstimator::beam), kernel_of(VolumeEstimator::photon_beam),
          kernel_of(VolumeEstimator::beams)};
}

}  // namespace lanthorn
