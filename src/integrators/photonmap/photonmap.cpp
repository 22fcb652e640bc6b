// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photon mapping in two passes (Jensen 1996; 2001, chapter 9): photons into a global map and one of caustics, then eye
// paths (two_pass.h).
#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "base/parameters.h"
#include "integrators/photonmap/gather_cache.h"
#include "integrators/photonmap/reverse_gather.h"
#include "integrators/photonmap/two_pass.h"
#include "integrators/progressive.h"
#include "lanthorn/error.h"
#include "path/eye_pass.h"
#include "photon/emission_choice.h"
#include "photon/photon_pass.h"
#include "photon/pilot_radius.h"

namespace lanthorn {

namespace {

// Which looks for which where gather rays end.
enum class Search : std::uint8_t { photons, reverse_photons };

class PhotonMapper final : public Integrator {
 public:
  PhotonMapper(const Parameters& parameters, Search search);

  void prepare(const RenderJob& job) override;
  std::string limitation(const Scene& scene) const override { return photon_limitation(scene); }
  MemoryUse memory_use(const RenderSettings& settings) const override;
  FilmContents film_contents() const override {
    return {path_class_names(), {{"term.A", "term.B", "term.C", "term.D"}}};
  }
  bool passes_share_wavelengths() const override { return true; }
  PassReport render_pass(const RenderJob& job, std::uint32_t pass, Film& film, const PhaseObserver& begin) override;

 private:
  TwoPassMaps trace(const RenderJob& job, std::uint32_t pass, const PhaseObserver& begin);

  TwoPassSettings settings_;
  std::optional<RadiusRule> reverse_;  // of the photons that look for reverse photons
  std::optional<float> radius_;
  std::uint64_t caustic_photons_ = 0;
  bool keeps_ = false, precomputes_ = false, guides_ = false, spares_shadow_rays_ = false;
  EmissionChoice emission_choice_;
  std::optional<EmissionGuide> emission_guide_, caustic_guide_;
  std::optional<TwoPassMaps> kept_;
  PhotonTracer tracer_, caustic_tracer_;
};

const EmissionGuide* pointer_to(const std::optional<EmissionGuide>& guide) { return guide ? &*guide : nullptr; }

PhotonMapper::PhotonMapper(const Parameters& parameters, Search search)
    : emission_choice_(emission_choice(parameters)) {
  const Kernel kernel = kernel_parameter(parameters);
  const auto most = static_cast<double>(EstimateSettings::most_nearest);
  settings_.global = {kernel, static_cast<std::size_t>(parameters.number("nearest", 0, most)), 0};
  settings_.caustic = {kernel, static_cast<std::size_t>(parameters.number("caustic-nearest", 0, most)), 0};
  settings_.global.differential = settings_.caustic.differential =
      static_cast<float>(parameters.number("differential", 0, 1e6));
  settings_.gather_rays = static_cast<int>(parameters.number("gather", 1, 65536));
  guides_ = choice<bool, 2>(parameters, "guide", {{{"none", false}, {"photons", true}}});
  keeps_ = choice<bool, 2>(parameters, "maps", {{{"fresh", false}, {"kept", true}}});
  if (search == Search::photons) {
    settings_.show = choice<Show, 7>(parameters, "show",
                                     {{{"image", Show::image},
                                       {"global", Show::global},
                                       {"caustic", Show::caustic},
                                       {"shadow", Show::shadow},
                                       {"radius", Show::radius},
                                       {"density", Show::density},
                                       {"records", Show::records}}});
    settings_.cache = gather_cache_settings(parameters);
    if (choice<bool, 2>(parameters, "final-gather", {{{"brute", true}, {"cached", false}}})) settings_.cache.reset();
    if (settings_.show == Show::records && !settings_.cache)
      throw Error("--set show=records: there are none without --set final-gather=cached");
    spares_shadow_rays_ = choice<bool, 2>(parameters, "shadows", {{{"rays", false}, {"photons", true}}});
    precomputes_ = choice<bool, 2>(parameters, "irradiance", {{{"estimated", false}, {"precomputed", true}}});
  } else {
    reverse_ =
        choice<RadiusRule, 2>(parameters, "radii", {{{"nearest", RadiusRule::nearest}, {"leaf", RadiusRule::leaf}}});
  }
  caustic_photons_ = static_cast<std::uint64_t>(parameters.number("caustic-photons", 0, 1e9));
  if (parameters.text("max-radius") != "auto")
    radius_ = static_cast<float>(parameters.number("max-radius", 1e-30, 1e30));
}

MemoryUse PhotonMapper::memory_use(const RenderSettings& settings) const {
  const double paths = static_cast<double>(std::max<std::uint64_t>(1, settings.photons));
  // Those for caustics alone leave fewer photons than others do.
  const double all_paths = (paths + static_cast<double>(caustic_photons_)) / paths;
  MemoryUse use{bytes_per_photon * all_paths, bytes_per_light_path * all_paths, 0, 1};
  if (reverse_) use.per_photon += sizeof(InfluencePhoton) + sizeof(Ball) + sizeof(float);
  if (settings_.show == Show::shadow || spares_shadow_rays_) use.per_photon += bytes_per_photon;
  use.fills_the_rest = reverse_.has_value();
  return use;
}

void PhotonMapper::prepare(const RenderJob& job) {
  const bool has_motion = job.scene.has_motion() || job.view.camera.moves();
  if (keeps_ && (job.settings.color != ColorMode::rgb || has_motion || job.scene.has_dispersion()))
    throw Error(
        "--set maps=kept: the passes of spectral colour, motion and dispersion each have wavelengths and a time of "
        "their own, which one map cannot have; use --color rgb and a still scene, or maps=fresh");
  emission_guide_ = choose_emission(emission_choice_, PhotonUse::gathering, job);
  if (caustic_photons_ > 0) caustic_guide_ = choose_emission(emission_choice_, PhotonUse::caustics, job);
  // As far as twice the photons that are asked for lie apart where most of the picture is: beyond, few would be enough.
  const float radius =
      radius_
          ? *radius_
          : 2 * choose_first_radius(job, {}, static_cast<double>(std::max<std::size_t>(settings_.global.nearest, 50)),
                                    pointer_to(emission_guide_))
                    .typical();
  settings_.global.radius = settings_.caustic.radius = radius;
  settings_.shortest = radius / 2;
  if (!keeps_) return;
  kept_ = trace(job, 0, [](Phase) {});
  kept_->report.rays = {};  // no pass's
  kept_->report.light_paths = 0;
  kept_->report.cache_records = 0;
}

TwoPassMaps PhotonMapper::trace(const RenderJob& job, std::uint32_t pass, const PhaseObserver& begin) {
  const Scene& scene = job.scene;
  const RenderSettings& settings = job.settings;
  TwoPassMaps maps;
  maps.draw = draw_for_pass(job, pass);
  begin(Phase::photons);
  tracer_.trace(scene, {settings.seed, Stream::light, pass, settings.photons, pointer_to(emission_guide_)},
                {.first_depth = 1, .max_depth = settings.max_depth}, maps.draw);
  if (caustic_photons_ > 0)
    caustic_tracer_.trace(scene, {settings.seed, Stream::caustic, pass, caustic_photons_, pointer_to(caustic_guide_)},
                          {.max_depth = settings.max_depth, .caustics_alone = true}, maps.draw);
  RayCounts shadow_rays;
  begin(Phase::build);
  maps.global = TwoPassMaps::Map::build(tracer_.chunks(), settings.color);
  std::vector<Photon> caustics;
  for (const std::vector<Photon>& chunk : (caustic_photons_ > 0 ? caustic_tracer_ : tracer_).chunks())
    std::copy_if(chunk.begin(), chunk.end(), std::back_inserter(caustics),
                 [](const Photon& photon) { return photon.flags.caustic; });
  maps.caustic = TwoPassMaps::Map::build(caustics, settings.color);
  if (precomputes_)
    maps.irradiance = IrradiancePhotons::build(maps.global, tracer_.chunks(), settings_.global, maps.draw.w);
  if (settings_.show == Show::shadow || (spares_shadow_rays_ && !scene.has_media()))
    maps.shadows =
        ShadowPhotons::trace(scene, {settings.seed, Stream::shadow, pass, settings.photons}, maps.draw, shadow_rays);
  if (guides_)
    maps.guides = GuidePhotons::build(tracer_.chunks(), maps.draw.w,
                                      [](const PhotonFlags& flags) { return !flags.direct && !flags.caustic; });
  maps.report.rays = tracer_.rays();
  maps.report.rays += caustic_tracer_.rays();
  maps.report.rays += shadow_rays;
  maps.report.light_paths = tracer_.emitted() + caustic_tracer_.emitted();
  maps.report.photons_stored = maps.global.size() + maps.caustic.size();
  maps.report.photon_map_bytes = maps.global.memory_bytes() + maps.caustic.memory_bytes() +
                                 (maps.irradiance ? maps.irradiance->memory_bytes() : 0) +
                                 (maps.guides ? maps.guides->memory_bytes() : 0) +
                                 (maps.shadows ? maps.shadows->memory_bytes() : 0);
  if (settings_.cache && (settings_.show == Show::image || settings_.show == Show::records))
    fill_gather_caches(job, settings_, pass, maps);
  return maps;
}

PassReport PhotonMapper::render_pass(const RenderJob& job, std::uint32_t pass, Film& film, const PhaseObserver& begin) {
  std::optional<TwoPassMaps> fresh;
  if (!kept_) fresh = trace(job, pass, begin);
  const TwoPassMaps& maps = kept_ ? *kept_ : *fresh;
  if (reverse_) return gather_in_reverse(job, settings_, maps, *reverse_, pass, film, begin);
  begin(Phase::eye);
  PassReport report = maps.report;
  report.radius = settings_.global.radius;
  std::atomic<std::uint64_t> misses{0};
  report.rays += trace_eye_paths(
      job, {pass, {job.settings.max_depth, 3}, &maps.draw}, film,
      [&](const PathContext& path, const EyeStart& start, const PixelPlace& place, LightLayers& layers) {
        const TwoPassContext context{job, settings_, maps, job.view.pixel_key(place.x, place.y), pass, &misses};
        walk_from_camera(path, start.camera, job.view.medium, TwoPassVisitor({path, layers}, context));
      });
  report.cache_misses = misses;
  return report;
}

std::vector<ParameterInfo> parameters_with(std::vector<ParameterInfo> own) {
  const std::array<ParameterInfo, 10> common{{
      {"nearest", "50", "photons of an estimate from the global map, up to 256; 0: all within the radius"},
      {"caustic-nearest", "50", "the same for the caustic map"},
      {"differential", "0",
       "end estimates of the nearest photons where light steadily changes by more than this share; 0: never"},
      {"max-radius", "auto", "largest radius of an estimate: auto, or a length in metres"},
      {"gather", "16", "rays of a final gather"},
      {"guide", "none",
       "gather rays: none (by materials alone), or also to where photons of indirect light came from: photons"},
      emission_info("projected"),
      {"caustic-photons", "0", "further light paths per pass, for caustics alone; 0: the caustics of --photons"},
      {"maps", "fresh", "fresh: new photons in each pass; kept: those of the first (RGB colour, still scenes)"},
      kernel_info,
  }};
  own.insert(own.begin(), common.begin(), common.end());
  return own;
}

}  // namespace

IntegratorInfo photonmap_info() {
  return {
      "photonmap", "photon mapping in two passes: global and caustic map, final gathering", "Jensen 1996",
      parameters_with(
          {{"irradiance", "precomputed",
            "where gather rays end on diffuse surfaces: precomputed (at one photon in four), or estimated each time"},
           {"shadows", "rays",
            "rays: a shadow ray for each light sample; photons: only where shadow photons do not agree (not with "
            "media)"},
           {"final-gather", "brute",
            "brute: at every point that is seen; cached: at some on diffuse surfaces, then interpolated"},
           {"cache-error", "0.2",
            "estimated relative error up to which a record of the cache is used (Ward's a), up to 1"},
           {"cache-min-spacing", "3", "least distance of records, pixels"},
           {"cache-max-spacing", "40", "largest distance of records, pixels"},
           {"cache-rays", "auto",
            "rays of a record's final gather, about, and of points where there is no record; auto: 128, or 512 with "
            "maps=kept"},
           {"show", "image",
            "image, or what a map holds: global, caustic, shadow (share of lit photons), radius (m) or density "
            "(photons/m^2); records: where the "
            "cache's are"}}),
      [](const Parameters& p) -> std::unique_ptr<Integrator> {
        return std::make_unique<PhotonMapper>(p, Search::photons);
      }};
}

IntegratorInfo reversephotonmap_info() {
  return {
      "reversephotonmap", "photon mapping whose photons look for the ends of gather rays: faster with many of these",
      "Havran, Herzog & Seidel 2005",
      parameters_with({{"radii", "nearest",
                        "of photons: nearest (the distance to as many others), leaf (from their leaf of the tree)"}}),
      [](const Parameters& p) -> std::unique_ptr<Integrator> {
        return std::make_unique<PhotonMapper>(p, Search::reverse_photons);
      }};
}

}  // namespace lanthorn
