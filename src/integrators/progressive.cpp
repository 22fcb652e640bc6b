// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/progressive.h"

namespace lanthorn {

Kernel kernel_parameter(const Parameters& parameters) {
  return {choice<KernelShape, 4>(parameters, "kernel",
                                 {{{"box", KernelShape::box},
                                   {"cone", KernelShape::cone},
                                   {"epanechnikov", KernelShape::epanechnikov},
                                   {"gaussian", KernelShape::gaussian}}})};
}

FilmContents progressive_layers(const Scene& scene) {
  FilmContents contents = path_layers(scene);
  contents.bias = true;
  return contents;
}

std::string photon_limitation(const Scene& scene, VolumeEstimator estimator) {
  if (!scene.has_scattering_media() || estimator != VolumeEstimator::path) return {};
  return "without photons in media, only eye paths find light that glass and mirrors focus into a medium; they find "
         "none from point, spot and distant lights";
}

void PassPhotonSource::prepare(const RenderJob& job) {
  emission_ = choose_emission(choice_, PhotonUse::indirect, job, records_for(estimator_));
  volume_schedule_.first_radius =
      static_cast<double>(first_volume_radius(job, estimator_, given_volume_radius_, kernel_, emission_.get()));
}

PassPhotons PassPhotonSource::trace(const RenderJob& job, std::uint32_t pass, const FluxClasses& classes, float support,
                                    const PhaseObserver& begin, const LightPathBlock& block) {
  const RenderSettings& settings = job.settings;
  PassPhotons photons{draw_for_pass(job, pass), {}, {}, {}, block.begin == 0};
  begin(Phase::photons);
  const auto tracer = tracers_.borrow();
  tracer->trace(job.scene, {settings.seed, Stream::light, pass, settings.photons, nullptr, block},
                {.max_depth = settings.max_depth, .classes = classes, .media = records_for(estimator_)}, photons.draw,
                emission_.get());
  begin(Phase::build);
  for (int c = 0; c < classes.count(); ++c) {
    photons.maps.push_back(PhotonMap<HashGrid>::build(tracer->chunks(static_cast<std::size_t>(c)), settings.color,
                                                      support * FluxClasses::radius_factor(c)));
    photons.report.photon_map_bytes += photons.maps.back().memory_bytes();
  }
  if (!tracer->medium_chunks().empty()) {
    const float radius = static_cast<float>(volume_schedule_.first_radius) *
                         volume_schedule_.shrink(pass, kernel_dimensions(estimator_));
    photons.volume.emplace(estimator_, kernel_, radius, tracer->medium_chunks(), settings.color);
    photons.report.photon_map_bytes += photons.volume->memory_bytes();
    photons.report.volume_radius = photons.volume->radius();
  }
  begin(Phase::eye);
  photons.report.rays = tracer->rays();
  photons.report.light_paths = tracer->emitted();
  photons.report.photons_stored = tracer->stored();
  return photons;
}

}  // namespace lanthorn
