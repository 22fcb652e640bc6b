// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photon mapping in two passes (Jensen 1996; 2001, chapter 9): photons into a global map and one of caustics, then eye
// paths (two_pass.h).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cache/photon_pass.h"
#include "integrators/gather_cache.h"
#include "integrators/pilot_radius.h"
#include "integrators/progressive.h"
#include "integrators/two_pass.h"
#include "lanthorn/error.h"
#include "path/eye_pass.h"

namespace lanthorn {

namespace {

class PhotonMapper final : public Integrator {
 public:
  explicit PhotonMapper(const Parameters& parameters);

  void prepare(const Scene& scene, const RenderSettings& settings) override;
  std::string limitation(const Scene& scene) const override { return photon_limitation(scene); }
  Parting parting() const override { return Parting::terms; }
  PassReport render_pass(const Scene& scene, const RenderSettings& settings, std::uint32_t pass, Film& film,
                         const PhaseObserver& begin) override;

 private:
  TwoPassMaps trace(const Scene& scene, const RenderSettings& settings, std::uint32_t pass, const PhaseObserver& begin);

  TwoPassSettings settings_;
  std::optional<float> radius_;
  std::uint64_t caustic_photons_ = 0;
  bool keeps_ = false, precomputes_ = false;
  std::optional<TwoPassMaps> kept_;
  PhotonTracer tracer_, caustic_tracer_;
};

template <class Value, std::size_t n>
Value choice(const Parameters& parameters, const char* name,
             const std::array<std::pair<const char*, Value>, n>& known) {
  const std::string& text = parameters.text(name);
  std::string names;
  for (const auto& [known_name, value] : known) {
    if (text == known_name) return value;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", known_name);
  }
  throw Error(fmt::format("--set {}={}: expected one of {}", name, text, names));
}

PhotonMapper::PhotonMapper(const Parameters& parameters) {
  const Kernel kernel = kernel_parameter(parameters);
  const auto most = static_cast<double>(EstimateSettings::most_nearest);
  settings_.global = {kernel, static_cast<std::size_t>(parameters.number("nearest", 0, most)), 0};
  settings_.caustic = {kernel, static_cast<std::size_t>(parameters.number("caustic-nearest", 0, most)), 0};
  settings_.gather_rays = static_cast<int>(parameters.number("gather", 1, 65536));
  settings_.show = choice<Show, 6>(parameters, "show",
                                   {{{"image", Show::image},
                                     {"global", Show::global},
                                     {"caustic", Show::caustic},
                                     {"radius", Show::radius},
                                     {"density", Show::density},
                                     {"records", Show::records}}});
  precomputes_ = choice<bool, 2>(parameters, "irradiance", {{{"estimated", false}, {"precomputed", true}}});
  keeps_ = choice<bool, 2>(parameters, "maps", {{{"fresh", false}, {"kept", true}}});
  settings_.cache = gather_cache_settings(parameters);
  if (choice<bool, 2>(parameters, "final-gather", {{{"brute", true}, {"cached", false}}})) settings_.cache.reset();
  if (settings_.show == Show::records && !settings_.cache)
    throw Error("--set show=records: there are none without --set final-gather=cached");
  caustic_photons_ = static_cast<std::uint64_t>(parameters.number("caustic-photons", 0, 1e9));
  if (parameters.text("max-radius") != "auto")
    radius_ = static_cast<float>(parameters.number("max-radius", 1e-30, 1e30));
}

void PhotonMapper::prepare(const Scene& scene, const RenderSettings& settings) {
  if (keeps_ && (settings.color != ColorMode::rgb || scene.has_motion() || scene.has_dispersion()))
    throw Error(
        "--set maps=kept: the passes of spectral colour, motion and dispersion each have wavelengths and a time of "
        "their own, which one map cannot have; use --color rgb and a still scene, or maps=fresh");
  // As far as twice the photons that are asked for lie apart where most of the picture is: beyond, few would be enough.
  const float radius =
      radius_ ? *radius_
              : 2 * choose_first_radius(scene, settings, {},
                                        static_cast<double>(std::max<std::size_t>(settings_.global.nearest, 50)))
                        .typical();
  settings_.global.radius = settings_.caustic.radius = radius;
  settings_.shortest = radius / 2;
  if (!keeps_) return;
  kept_ = trace(scene, settings, 0, [](Phase) {});
  kept_->report.rays = {};  // no pass's
  kept_->report.light_paths = 0;
  kept_->report.cache_records = 0;
}

TwoPassMaps PhotonMapper::trace(const Scene& scene, const RenderSettings& settings, std::uint32_t pass,
                                const PhaseObserver& begin) {
  Sampler pass_sampler = Sampler::for_pass(settings.seed, pass);
  TwoPassMaps maps{draw_time_and_wavelengths(scene, settings.color, pass_sampler), {}, {}, {}, {}, {}};
  begin(Phase::photons);
  tracer_.trace(scene, {settings.seed, Stream::light, pass, settings.photons},
                {.first_depth = 1, .max_depth = settings.max_depth}, maps.draw);
  if (caustic_photons_ > 0)
    caustic_tracer_.trace(scene, {settings.seed, Stream::caustic, pass, caustic_photons_},
                          {.max_depth = settings.max_depth, .caustics_alone = true}, maps.draw);
  begin(Phase::build);
  maps.global = TwoPassMaps::Map::build(tracer_.chunks(), settings.color);
  std::vector<Photon> caustics;
  for (const std::vector<Photon>& chunk : (caustic_photons_ > 0 ? caustic_tracer_ : tracer_).chunks())
    std::copy_if(chunk.begin(), chunk.end(), std::back_inserter(caustics),
                 [](const Photon& photon) { return photon.flags.caustic; });
  maps.caustic = TwoPassMaps::Map::build(caustics, settings.color);
  if (precomputes_)
    maps.irradiance = IrradiancePhotons::build(maps.global, tracer_.chunks(), settings_.global, maps.draw.w);
  maps.report.rays = tracer_.rays();
  maps.report.rays += caustic_tracer_.rays();
  maps.report.light_paths = tracer_.emitted() + caustic_tracer_.emitted();
  maps.report.photons_stored = maps.global.size() + maps.caustic.size();
  maps.report.photon_map_bytes = maps.global.memory_bytes() + maps.caustic.memory_bytes() +
                                 (maps.irradiance ? maps.irradiance->memory_bytes() : 0);
  if (settings_.cache && (settings_.show == Show::image || settings_.show == Show::records))
    fill_gather_caches(scene, settings, settings_, pass, maps);
  return maps;
}

PassReport PhotonMapper::render_pass(const Scene& scene, const RenderSettings& settings, std::uint32_t pass, Film& film,
                                     const PhaseObserver& begin) {
  std::optional<TwoPassMaps> fresh;
  if (!kept_) fresh = trace(scene, settings, pass, begin);
  const TwoPassMaps& maps = kept_ ? *kept_ : *fresh;
  begin(Phase::eye);
  const PixelWindow& window = settings.window;
  PassReport report = maps.report;
  report.radius = settings_.global.radius;
  std::atomic<std::uint64_t> misses{0};
  report.rays += for_each_pixel(
      window.x0, window.y0, window.width(), window.height(), [&](const PixelPlace& place, RayCounts& counts) {
        const std::uint32_t key = pixel_key(scene, place);
        Sampler sampler = Sampler::for_pixel(settings.seed, Stream::camera, key, pass);
        const EyeStart start = start_eye_path(scene, settings.filter, place, maps.draw.time, sampler);
        LightLayers layers(maps.draw.w);
        const TwoPassContext context{scene, settings, settings_, maps, key, pass, counts, layers, misses};
        walk_from_camera(scene, start.camera, {settings.max_depth, 3}, maps.draw.w, sampler, counts,
                         TwoPassVisitor(context, sampler));
        film.add(place.index, layers.sample(start.filter_weight));
      });
  report.cache_misses = misses;
  return report;
}

}  // namespace

IntegratorInfo photonmap_info() {
  return {
      "photonmap",
      "photon mapping in two passes: global and caustic map, final gathering",
      "Jensen 1996",
      {{"nearest", "50", "photons of an estimate from the global map, up to 256; 0: all within the radius"},
       {"caustic-nearest", "50", "the same for the caustic map"},
       {"max-radius", "auto", "largest radius of an estimate: auto, or a length in metres"},
       {"gather", "16", "rays of a final gather"},
       {"irradiance", "precomputed",
        "where gather rays end on diffuse surfaces: precomputed (at one photon in four), or estimated each time"},
       {"final-gather", "brute",
        "brute: at every point that is seen; cached: at some on diffuse surfaces, then interpolated"},
       {"cache-error", "0.2", "estimated relative error up to which a record of the cache is used (Ward's a), up to 1"},
       {"cache-min-spacing", "3", "least distance of records, pixels"},
       {"cache-max-spacing", "40", "largest distance of records, pixels"},
       {"cache-rays", "512", "rays of a record's final gather, about; and of points where there is no record"},
       {"caustic-photons", "0", "further light paths per pass, for caustics alone; 0: the caustics of --photons"},
       {"maps", "fresh", "fresh: new photons in each pass; kept: those of the first (RGB colour, still scenes)"},
       {"show", "image",
        "image, or what a map holds: global, caustic, radius (m) or density (photons/m^2); records: where the cache's "
        "are"},
       kernel_info},
      [](const Parameters& p) -> std::unique_ptr<Integrator> { return std::make_unique<PhotonMapper>(p); }};
}

}  // namespace lanthorn
