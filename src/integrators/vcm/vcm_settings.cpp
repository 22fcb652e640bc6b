// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/vcm/vcm_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "base/parameters.h"
#include "integrators/vcm/uniformity_tests.h"
#include "lanthorn/error.h"
#include "path/eye_pass.h"
#include "path/light_vertices.h"
#include "photon/media/volume_radius.h"

namespace lanthorn {

namespace {

std::optional<Strategy> parse_strategy(const std::string& text) {
  if (text == "all") return {};
  Strategy strategy;
  int read = 0;
  if (std::sscanf(text.c_str(), "%3d,%3d%n", &strategy.s, &strategy.t, &read) != 2 ||
      read != static_cast<int>(text.size()) || strategy.s < 0 || strategy.t < 1 || strategy.s + strategy.t < 2)
    throw Error(fmt::format(
        "--set strategy={}: expected all, or S,T: at least 0 vertices of the light walk, 1 of the eye's and 2 of both",
        text));
  return strategy;
}

ParameterInfo roulette_depth_info() {
  return {"roulette-depth", "3", "scattering event from which Russian roulette may end an eye path, from 1"};
}
ParameterInfo strategy_info() {
  return {"strategy", "all", "all, or S,T: only light of paths with S vertices made from the light and T from the eye"};
}
ParameterInfo merge_volume_info() {
  return {"volume", "beam",
          "merging in media: by photons around the eye's rays (beam) or around points on them (point), by photons' "
          "flights around rays (beams) or points (photon-beam), by several under one weight, such as point+beam, or "
          "not at all (path)"};
}

std::array<bool, volume_estimator_count> merged_in_media(const Parameters& parameters) {
  using enum VolumeEstimator;
  constexpr std::array known{point, beam, photon_beam, beams};
  std::array<bool, volume_estimator_count> result{};
  for (const VolumeEstimator e : volume_estimators(parameters, known)) result[static_cast<std::size_t>(e)] = true;
  return result;
}

// Every light vertex costs a connection to the lens and one to an eye path: more light paths than pixels do not pay.
constexpr LightPathRange light_path_range{.fewest = 10'000};

ParameterInfo merge_reduction_info(const char* default_alpha) {
  return {
      "alpha", default_alpha,
      "radius reduction on surfaces in (0,1]: r^2 shrinks by (i+alpha)/(i+1); small: sharper, noisier; in media 2/3"};
}

template <bool connections, bool merging>
std::unique_ptr<Integrator> make(const Parameters& p) {
  return make_vertex_connection_and_merging(VcmSettings(p, {connections, merging}));
}

}  // namespace

VcmSettings::VcmSettings(const Parameters& parameters, VcmSwitches techniques)
    : switches(techniques), roulette_depth(static_cast<int>(parameters.number("roulette-depth", 1, 1e6))) {
  if (!switches.merging) {
    only = parse_strategy(parameters.text("strategy"));
    return;
  }
  emission = emission_choice(parameters);
  alpha = parameters.number("alpha", 1e-3, 1);
  radius = RadiusChoice::from(parameters);
  volume_radius = volume_radius_parameter(parameters);
  volume = merged_in_media(parameters);
}

FilmContents VcmSettings::film_contents(const Scene& scene) const {
  using technique::hit, technique::nee, technique::splat, technique::vc, technique::vm;
  FilmContents contents = path_layers(scene);
  if (!plan_effort)
    contents.decomposition = {{"technique.hit", "technique.nee", "technique.vc", "technique.vm"},
                              "technique.splat",
                              Decomposition::Shares{"technique.share", {{{vm}, {vc, nee, splat}, {hit}}}}};
  contents.splats = switches.connections;
  contents.bias = switches.merging;
  return contents;
}

std::string VcmSettings::limitation(const Scene& scene) const {
  if (switches.connections || merges_in_media() || !scene.has_scattering_media()) return {};
  return "without merging in media (volume=beam), none of the light that they scatter is found";
}

MemoryUse VcmSettings::memory_use(const RenderSettings& settings) const {
  constexpr double spare = 1.25;  // of vectors that grow; measured: 1.02
  const double merged = switches.merging ? bytes_per_photon : 0;
  const double of_vertex = spare * sizeof(LightVertex);
  const double most_light_paths = plan_effort ? 4 : 1;  // over those of `RenderSettings::photons`
  const auto block = static_cast<double>(settings.photon_block);
  return {.per_photon = most_light_paths * (of_vertex + merged),
          .per_light_path = most_light_paths * bytes_per_light_path,
          .per_pixel = static_cast<double>(sizeof(float) + (plan_effort ? UniformityTests::bytes_per_pixel : 0)),
          .first_depth = 1,
          .media = MediumRecords::points,
          .per_medium_photon =
              most_light_paths * (of_vertex + (switches.merging ? bytes_of_medium_photon(MediumRecords::points) : 0)),
          .photon_block = static_cast<std::uint64_t>(std::max(block / most_light_paths, 1.0)),
          .per_pixel_of_blocks = PartialLight::bytes_per_pixel};
}

IntegratorInfo vcm_info() {
  return {"vcm",
          "vertex connection and merging: bidirectional paths and photons under one weight; all kinds of light",
          "Georgiev et al. 2012; Hachisuka et al. 2012",
          {merge_reduction_info("0.5"), first_radius_info(), roulette_depth_info(), emission_info("auto"),
           merge_volume_info(), volume_radius_info()},
          make<true, true>,
          light_path_range};
}

IntegratorInfo bdpt_info() {
  return {"bdpt",
          "bidirectional path tracing: unbiased; caustics, but not their reflections from small lights",
          "Veach 1997; Lafortune & Willems 1993",
          {strategy_info(), roulette_depth_info()},
          make<true, false>,
          light_path_range};
}

IntegratorInfo bpm_info() {
  return {"bpm",
          "bidirectional photon mapping: photons merged at every vertex of the eye path",
          "Vorba 2011; Georgiev et al. 2012",
          {merge_reduction_info("0.75"), first_radius_info(), roulette_depth_info(), emission_info("auto"),
           merge_volume_info(), volume_radius_info()},
          make<false, true>};
}

}  // namespace lanthorn
