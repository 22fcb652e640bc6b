// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/guides/emission_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/parameters.h"
#include "light/light_sampler.h"
#include "path/direct_light.h"
#include "photon/gather/photon_gather.h"
#include "photon/gather/pilot_radius.h"
#include "photon/guides/learned_emission.h"
#include "photon/guides/projection_map.h"
#include "photon/guides/rare_light.h"
#include "photon/pilot_paths.h"

namespace lanthorn {

EmissionChoice emission_choice(const Parameters& parameters) {
  return choice<EmissionChoice, 4>(parameters, "emission",
                                   {{{"auto", EmissionChoice::automatic},
                                     {"power", EmissionChoice::power},
                                     {"projected", EmissionChoice::projected},
                                     {"learned", EmissionChoice::learned}}});
}

namespace {

constexpr int direct_light_grid = 64;
constexpr std::uint32_t direct_light_samples = 4;

/// Direct light of one sample at a visible point.
struct SeenLight {
  std::uint32_t light = 0;
  float brightness = 0;
};
using SeenLights = std::array<SeenLight, direct_light_samples>;

/// Samples the direct light at the first wide lobe of an eye path.
struct SeenLightVisitor {
  const PathContext& path;
  std::uint64_t seed;
  std::uint32_t number;  ///< of the path
  SeenLights& seen;

  Continuation operator()(const SurfaceVertex& vertex) const {
    if (!has_non_delta(vertex.at.bsdf) || wide_share(vertex) < 0.5f) return Continuation::go_on();
    for (std::uint32_t i = 0; i < direct_light_samples; ++i) {
      Sampler sampler = Sampler::for_pixel(seed, Stream::pilot_camera, number, i + 1);
      if (const auto event = sample_next_event(path.with(sampler), vertex))
        seen[i] = {event->light, sum_of(event->radiance)};
    }
    return Continuation::stop();
  }
  Continuation operator()(const MediumVertex&) const { return Continuation::go_on(); }
  void operator()(const EscapeVertex&) const {}
};

// Share of each light in the direct light of the visible points, where all points count alike.
std::vector<double> shares_of_direct_light(const RenderJob& job) {
  const PixelWindow film = job.view.film();
  const int columns = std::min(direct_light_grid, film.width()), rows = std::min(direct_light_grid, film.height());
  std::vector<SeenLights> of_paths(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for_each_pilot_path(job, draw_for_pass(job, 0), film, columns, rows,
                      [&](const PathContext& path, const Ray&, std::uint32_t index) {
                        return SeenLightVisitor{path, job.settings.seed, index, of_paths[index]};
                      });
  std::vector<double> shares(job.scene.lights().size());
  double lit = 0;
  for (const SeenLights& seen : of_paths) {
    double all = 0;
    for (const SeenLight& s : seen) all += static_cast<double>(s.brightness);
    if (!(all > 0)) continue;
    ++lit;
    for (const SeenLight& s : seen) shares[s.light] += static_cast<double>(s.brightness) / all;
  }
  for (double& share : shares) share /= std::max(1.0, lit);
  return shares;
}

// True if lights that matter to the picture would get next to no photons by power, and the picture needs photons
// because there are mirrors or clear glass.
bool strong_lights_hide_others(const RenderJob& job) {
  if (!has_specular_surfaces(job.scene)) return false;
  constexpr double next_to_none = 1e-3;  // of the photons that a share of the picture's light deserves
  constexpr double noticeable = 0.01;    // share of the picture's direct light
  const std::vector<float> by_power = emission_probabilities(job.scene.lights());
  const std::vector<double> seen = shares_of_direct_light(job);
  double hidden = 0;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (static_cast<double>(by_power[i]) < next_to_none * seen[i]) hidden += seen[i];
  return hidden > noticeable;
}

std::string remark_on(double in_view, bool hides_lights, PhotonUse use) {
  const char* fewer = use == PhotonUse::merging ? "" : "; auto needs fewer";
  if (hides_lights)
    return fmt::format(
        "strong lights would leave hardly any photons to weak ones that light a part of the picture: photons start "
        "where light paths into view have been found (--set emission=power starts them by power){}",
        fewer);
  const std::string share = in_view > 1e-6 ? fmt::format("one photon in {:.0f}", 1 / in_view) : "almost no photon";
  return fmt::format(
      "{} lands in view: photons start where light paths into view have been found "
      "(--set emission=power starts them everywhere){}",
      share, fewer);
}

// A learned guide, where photons by power would miss the view, or would come from lights that outshine others there.
// Learning takes a second or more, and can gain no more than the photons that it aims at the view.
Emission automatic_emission(PhotonUse use, const RenderJob& job, bool in_media) {
  constexpr double few = 0.02, unimportant = 0.025;
  const double in_view = photons_in_view(job);
  const bool hides_lights = in_view >= few && strong_lights_hide_others(job);
  if (in_view >= few && !hides_lights) return {};
  LearnedEmission learned = learn_emission(job, use, in_media);
  if (learned.share < unimportant) return {};
  return {std::move(learned.guide), remark_on(in_view, hides_lights, use)};
}

}  // namespace

Emission choose_emission(EmissionChoice choice, PhotonUse use, const RenderJob& job, MediumRecords media) {
  const bool in_media = media != MediumRecords::none && job.scene.has_scattering_media();
  switch (choice) {
    case EmissionChoice::power:
      return {};
    case EmissionChoice::automatic:
      return automatic_emission(use, job, in_media);
    case EmissionChoice::learned:
      return {learn_emission(job, use, in_media).guide, {}};
    case EmissionChoice::projected: {
      const PhotonTarget landings = in_media ? PhotonTarget::surfaces_and_media : PhotonTarget::surfaces;
      const PhotonTarget target = use == PhotonUse::caustics ? PhotonTarget::specular : landings;
      return {LightGuide{make_projection_map(job.scene, target)}, {}};
    }
  }
  return {};
}

}  // namespace lanthorn
