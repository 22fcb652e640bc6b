// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photon mapping in two passes (Jensen 1996; 2001, chapter 9). The first pass traces photons into a global map and a
// caustic map (chapters 5 and 6); the second follows eye paths and estimates the light at their vertices as a sum of
// four terms, from these maps (two_pass.h).
#include <algorithm>
#include <atomic>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "base/pool.h"
#include "integrators/photonmap/gather_cache.h"
#include "integrators/photonmap/photonmap_settings.h"
#include "integrators/photonmap/two_pass.h"
#include "integrators/progressive.h"
#include "path/eye_pass.h"
#include "photon/gather/pilot_radius.h"
#include "photon/photon_pass.h"

namespace lanthorn {

namespace {

class PhotonMapper final : public Integrator {
 public:
  explicit PhotonMapper(const PhotonMapSettings& settings) : settings_(settings) {}

  void prepare(const RenderJob& job) override;
  std::string limitation(const Scene& scene) const override { return photon_limitation(scene, settings_.volume); }
  bool knows_bias() const override { return false; }
  MemoryUse memory_use(const RenderSettings& settings) const override { return settings_.memory_use(settings); }
  FilmContents film_contents(const Scene& scene) const override {
    FilmContents contents = path_layers(scene);
    contents.decomposition.parts = {"term.A", "term.B", "term.C", "term.D"};
    return contents;
  }
  bool passes_share_wavelengths() const override { return true; }
  bool passes_may_overlap() const override { return true; }
  bool crops_are_exact() const override { return !settings_.estimates.cache; }
  PassReport render_pass(const RenderJob& job, std::uint32_t pass, const FilmPass& film,
                         const PhaseObserver& begin) override;

 private:
  TwoPassMaps trace(const RenderJob& job, std::uint32_t pass, const PhaseObserver& begin);

  PhotonMapSettings settings_;
  Emission emission_, caustic_emission_;
  float volume_radius_ = 0;  // m, of all passes
  std::optional<TwoPassMaps> kept_;
  Pool<PhotonTracer> tracers_;
};

// The report on maps that are kept, without the cost of making them.
PassReport report_of(const TwoPassMaps& maps) {
  PassReport report;
  report.photons_stored = maps.global.size() + maps.caustic.size();
  report.photon_map_bytes =
      maps.global.memory_bytes() + maps.caustic.memory_bytes() +
      (maps.irradiance ? maps.irradiance->memory_bytes() : 0) + (maps.guides ? maps.guides->memory_bytes() : 0) +
      (maps.shadows ? maps.shadows->memory_bytes() : 0) + (maps.volume ? maps.volume->memory_bytes() : 0);
  if (maps.volume) report.volume_radius = maps.volume->radius();
  return report;
}

void PhotonMapper::prepare(const RenderJob& job) {
  settings_.check(job);
  emission_ = choose_emission(settings_.emission, PhotonUse::gathering, job, settings_.medium_records());
  if (settings_.caustic_photons > 0) caustic_emission_ = choose_emission(settings_.emission, PhotonUse::caustics, job);
  // Twice the radius that holds the wanted photons where photons are dense.
  const float radius =
      settings_.radius
          ? *settings_.radius
          : 2 * radius_of_photons(job,
                                  static_cast<double>(std::max<std::size_t>(settings_.estimates.global.nearest, 50)),
                                  emission_.get());
  settings_.estimates.global.radius = settings_.estimates.caustic.radius = radius;
  settings_.estimates.shortest = radius / 2;
  volume_radius_ = first_volume_radius(job, settings_.volume, settings_.volume_radius,
                                       settings_.estimates.global.kernel, emission_.get());
  if (!settings_.keeps_maps) return;
  kept_ = trace(job, 0, [](Phase) {});
  kept_->report.rays = {};  // they belong to no pass
  kept_->report.light_paths = 0;
  kept_->report.cache_records = 0;
}

TwoPassMaps PhotonMapper::trace(const RenderJob& job, std::uint32_t pass, const PhaseObserver& begin) {
  const Scene& scene = job.scene;
  const RenderSettings& settings = job.settings;
  TwoPassMaps maps;
  maps.draw = draw_for_pass(job, pass);
  const auto tracer = tracers_.borrow(), caustic_tracer = tracers_.borrow();
  begin(Phase::photons);
  tracer->trace(scene, {settings.seed, Stream::light, pass, settings.photons},
                {.first_depth = 1, .max_depth = settings.max_depth, .media = settings_.medium_records()}, maps.draw,
                emission_.get());
  const std::uint64_t caustic_photons = (settings_.caustic_photons + settings.parts - 1) / settings.parts;
  if (caustic_photons > 0)
    caustic_tracer->trace(scene, {settings.seed, Stream::caustic, pass, caustic_photons},
                          {.max_depth = settings.max_depth, .caustics_alone = true}, maps.draw,
                          caustic_emission_.get());
  RayCounts shadow_rays;
  begin(Phase::build);
  maps.global = TwoPassMaps::Map::build(tracer->chunks(), settings.color);
  std::vector<Photon> caustics;
  for (const std::vector<Photon>& chunk : (caustic_photons > 0 ? caustic_tracer : tracer)->chunks())
    std::copy_if(chunk.begin(), chunk.end(), std::back_inserter(caustics),
                 [](const Photon& photon) { return photon.flags.caustic; });
  maps.caustic = TwoPassMaps::Map::build(caustics, settings.color);
  if (settings_.precomputes_irradiance && IrradiancePhotons::has_records_for(settings_.estimates.global))
    maps.irradiance = IrradiancePhotons::build(maps.global, tracer->chunks(), settings_.estimates.global, maps.draw.w);
  if (settings_.shows_shadows() || (settings_.spares_shadow_rays && !scene.has_media()))
    maps.shadows =
        ShadowPhotons::trace(scene, {settings.seed, Stream::shadow, pass, settings.photons}, maps.draw, shadow_rays);
  if (settings_.guides_gathering)
    maps.guides = GuidePhotons::build(tracer->chunks(), maps.draw.w,
                                      [](const PhotonFlags& flags) { return !flags.direct && !flags.caustic; });
  if (!tracer->medium_chunks().empty())
    maps.volume.emplace(settings_.volume, settings_.estimates.global.kernel, volume_radius_, tracer->medium_chunks(),
                        settings.color);
  maps.report = report_of(maps);
  maps.report.rays = tracer->rays();
  maps.report.light_paths = tracer->emitted();
  if (caustic_photons > 0) {
    maps.report.rays += caustic_tracer->rays();
    maps.report.light_paths += caustic_tracer->emitted();
  }
  maps.report.rays += shadow_rays;
  if (settings_.fills_cache()) fill_gather_caches(job, settings_.estimates, pass, maps);
  return maps;
}

PassReport PhotonMapper::render_pass(const RenderJob& job, std::uint32_t pass, const FilmPass& film,
                                     const PhaseObserver& begin) {
  std::optional<TwoPassMaps> fresh;
  if (!kept_) fresh = trace(job, pass, begin);
  const TwoPassMaps& maps = kept_ ? *kept_ : *fresh;
  if (settings_.reverse)
    return gather_in_reverse(job, settings_.estimates, maps, *settings_.reverse, pass, film, begin);
  begin(Phase::eye);
  PassReport report = maps.report;
  report.radius = settings_.estimates.global.radius;
  std::atomic<std::uint64_t> misses{0};
  report.rays += trace_eye_paths(
      job, {pass, {job.settings.max_depth, 3}}, film,
      [&](Sampler& sampler, const PixelPlace& place) { return maps.draw.of_eye_path(sampler, place.x, place.y); },
      [&](const PathContext& path, const EyeStart& start, const PixelPlace& place, LightLayers& layers) {
        const TwoPassContext context{job,    settings_.estimates, maps, job.view.pixel_key(place.x, place.y), pass,
                                     &misses};
        walk_from_camera(path, start.camera, job.view.medium, TwoPassVisitor({path, layers}, context));
      });
  report.cache_misses = misses;
  return report;
}

}  // namespace

std::unique_ptr<Integrator> make_photon_mapper(const PhotonMapSettings& settings) {
  return std::make_unique<PhotonMapper>(settings);
}

}  // namespace lanthorn
