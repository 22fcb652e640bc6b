// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/photonmap/photonmap_settings.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/parameters.h"
#include "integrators/photonmap/gather_cache.h"
#include "integrators/progressive.h"
#include "lanthorn/error.h"

namespace lanthorn {

PhotonMapSettings::PhotonMapSettings(const Parameters& parameters, Search search)
    : emission(emission_choice(parameters)),
      volume(volume_estimator(parameters)),
      volume_radius(volume_radius_parameter(parameters)) {
  const Kernel kernel = kernel_parameter(parameters);
  const auto most = static_cast<double>(EstimateSettings::most_nearest);
  estimates.global = {kernel, static_cast<std::size_t>(parameters.number("nearest", 0, most)), 0};
  estimates.caustic = {kernel, static_cast<std::size_t>(parameters.number("caustic-nearest", 0, most)), 0};
  estimates.global.differential = estimates.caustic.differential =
      static_cast<float>(parameters.number("differential", 0, 1e6));
  estimates.gather_rays = static_cast<int>(parameters.number("gather", 1, 65536));
  guides_gathering = choice<bool, 2>(parameters, "guide", {{{"none", false}, {"photons", true}}});
  keeps_maps = choice<bool, 2>(parameters, "maps", {{{"fresh", false}, {"kept", true}}});
  if (search == Search::photons) {
    estimates.show = choice<Show, 7>(parameters, "show",
                                     {{{"image", Show::image},
                                       {"global", Show::global},
                                       {"caustic", Show::caustic},
                                       {"shadow", Show::shadow},
                                       {"radius", Show::radius},
                                       {"density", Show::density},
                                       {"records", Show::records}}});
    estimates.cache = gather_cache_settings(parameters);
    if (choice<bool, 2>(parameters, "final-gather", {{{"brute", true}, {"cached", false}}})) estimates.cache.reset();
    if (estimates.show == Show::records && !estimates.cache)
      throw Error("--set show=records: there are none without --set final-gather=cached");
    spares_shadow_rays = choice<bool, 2>(parameters, "shadows", {{{"rays", false}, {"photons", true}}});
    precomputes_irradiance = choice<bool, 2>(parameters, "irradiance", {{{"estimated", false}, {"precomputed", true}}});
  } else {
    reverse =
        choice<RadiusRule, 2>(parameters, "radii", {{{"nearest", RadiusRule::nearest}, {"leaf", RadiusRule::leaf}}});
  }
  caustic_photons = static_cast<std::uint64_t>(parameters.number("caustic-photons", 0, 1e9));
  if (parameters.text("max-radius") != "auto")
    radius = static_cast<float>(parameters.number("max-radius", 1e-30, 1e30));
}

MemoryUse PhotonMapSettings::memory_use(const RenderSettings& settings) const {
  const double paths = static_cast<double>(std::max<std::uint64_t>(1, settings.photons * settings.parts));
  // An upper bound, because light paths that are traced for caustics alone leave fewer photons.
  const double all_paths = (paths + static_cast<double>(caustic_photons)) / paths;
  MemoryUse use{bytes_per_photon * all_paths, bytes_per_light_path * all_paths, 0, 1};
  if (reverse) use.per_photon += sizeof(InfluencePhoton) + sizeof(Ball) + sizeof(float);
  if (shows_shadows() || spares_shadow_rays) use.per_photon += bytes_per_photon;
  use.media = medium_records();
  use.fills_the_rest = reverse.has_value();
  return use;
}

void PhotonMapSettings::check(const RenderJob& job) const {
  const bool has_motion = job.scene.has_motion() || job.view.camera.moves();
  if (keeps_maps && (job.settings.color != ColorMode::rgb || has_motion || job.scene.has_dispersion()))
    throw Error(
        "--set maps=kept: the passes of spectral colour, motion and dispersion each have wavelengths and a time of "
        "their own, which one map cannot have; use --color rgb and a still scene, or maps=fresh");
}

namespace {

std::vector<ParameterInfo> parameters_with(std::vector<ParameterInfo> own) {
  const std::array<ParameterInfo, 10> common{{
      {"nearest", "50", "photons of an estimate from the global map, up to 256; 0: all within the radius"},
      {"caustic-nearest", "50", "the same for the caustic map"},
      {"differential", "0",
       "end estimates of the nearest photons where light steadily changes by more than this share; 0: never"},
      {"max-radius", "auto", "largest radius of an estimate: auto, or a length in metres"},
      {"gather", "16", "rays of a final gather"},
      {"guide", "none",
       "gather rays: none (directions by materials alone), or photons (also towards where indirect photons came from)"},
      emission_info("projected"),
      {"caustic-photons", "0", "further light paths per pass, for caustics alone; 0: the caustics of --photons"},
      {"maps", "fresh", "fresh: new photons in each pass; kept: those of the first (RGB colour, still scenes)"},
      kernel_info(),
  }};
  own.insert(own.begin(), common.begin(), common.end());
  return with_volume_parameters(std::move(own));
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
            "brute: at every visible point; cached: at some points of diffuse surfaces, interpolated in between"},
           {"cache-error", "0.2",
            "estimated relative error up to which a record of the cache is used (Ward's a), up to 1"},
           {"cache-min-spacing", "3", "least distance of records, pixels"},
           {"cache-max-spacing", "40", "largest distance of records, pixels"},
           {"cache-rays", "auto",
            "approximate number of rays to gather a record, and at points that no record covers; auto: 128, or 512 "
            "with maps=kept"},
           {"show", "image",
            "image, or what a map holds: global, caustic, shadow (share of lit photons), radius (m) or density "
            "(photons/m^2); records: where the cache has records"}}),
      [](const Parameters& p) -> std::unique_ptr<Integrator> {
        return make_photon_mapper(PhotonMapSettings(p, Search::photons));
      }};
}

IntegratorInfo reversephotonmap_info() {
  return {"reversephotonmap",
          "photon mapping whose photons look for the ends of gather rays: faster with many of these",
          "Havran, Herzog & Seidel 2005",
          parameters_with({{"radii", "nearest",
                            "of photons: nearest (the distance to as many neighbours as --set nearest says), or leaf "
                            "(from their leaf of the tree)"}}),
          [](const Parameters& p) -> std::unique_ptr<Integrator> {
            return make_photon_mapper(PhotonMapSettings(p, Search::reverse_photons));
          }};
}

}  // namespace lanthorn
