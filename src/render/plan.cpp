// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "base/memory.h"
#include "film/film.h"
#include "integrators/integrator.h"
#include "lanthorn/error.h"
#include "lanthorn/text.h"
#include "path/path_draw.h"
#include "photon/photon_pass.h"
#include "render/method_of_file.h"
#include "scene/medium_around.h"
#include "scene/scene.h"

namespace lanthorn {

namespace {

// Light paths traced to measure how many photons each stores: 4096 give the mean to a few percent.
constexpr std::uint64_t probed_paths = 4096;

// Mean storage of a light path, on surfaces and in media.
struct Stored {
  double photons = 0, bytes = 0;
};

Stored stored_per_light_path(const RenderJob& job, const MemoryUse& use) {
  const RenderSettings& settings = job.settings;
  const PassDraw draw = draw_for_pass(job, 0);
  PhotonTracer tracer;
  tracer.trace(job.scene, {settings.seed, Stream::pilot_light, 0, std::min(probed_paths, settings.photons)},
               {.first_depth = use.first_depth, .max_depth = settings.max_depth, .media = use.media}, draw);
  const double paths = static_cast<double>(std::max<std::uint64_t>(1, tracer.emitted()));
  const double all = static_cast<double>(tracer.stored()), in_media = static_cast<double>(tracer.stored_in_media());
  const double in_medium = use.per_medium_photon > 0 ? use.per_medium_photon : bytes_of_medium_photon(use.media);
  return {all / paths, ((all - in_media) * use.per_photon + in_media * in_medium) / paths};
}

// The memory available, and its name in messages.
struct Limit {
  double bytes;
  std::string words;
};

Limit limit_of(std::optional<std::uint64_t> option) {
  if (option) return {static_cast<double>(*option), "--memory allows " + memory_text(static_cast<double>(*option))};
  const auto available = available_memory();
  if (!available) return {std::numeric_limits<double>::infinity(), {}};
  return {static_cast<double>(*available), "there are only " + memory_text(static_cast<double>(*available))};
}

std::string too_many_photons(const RenderSettings& settings, const MemoryUse& use, const Stored& per_path, double bytes,
                             double film, const Limit& limit) {
  const bool has_blocks = use.photon_block < settings.photons;
  const char* const of = has_blocks ? " at a time" : settings.parts > 1 ? " of a part of a pass" : " a pass";
  return fmt::format(
      "{} light paths{} take {} of memory{}, beside {} for the picture, but {}: choose fewer with --photons{}",
      has_blocks ? use.photon_block : settings.photons, of, memory_text(bytes),
      per_path.photons > 0 ? fmt::format(" ({} photons each)", short_number(per_path.photons)) : "", memory_text(film),
      limit.words,
      use.photon_block == MemoryUse{}.photon_block
          ? ", or a method that does not need all of them at a time (probppm, vcm, bpm, auto)"
          : "");
}

// Refuses a render that does not fit into memory before any of it is allocated. Counts the film's sums and the picture
// made from them, the method's own data for each pixel, and the photons or light vertices of a pass; their number for
// each light path is measured on a few thousand paths. Scene and textures are in memory already and do not count.
// `option`: bytes for all of these together; by default the free memory of the machine. Sets `settings.memory` for
// methods that work in blocks. Returns how many passes fit at once: into the limit, or into half of the free memory.
// Throws Error with the memory needed and the options that reduce it.
std::size_t plan_memory(const Scene& scene, const View& view, const Integrator& integrator,
                        const FilmContents& contents, std::optional<std::uint64_t> option, RenderSettings& settings) {
  const Limit limit = limit_of(option);
  const MemoryUse use = integrator.memory_use(settings);
  const int width = view.window.width(), height = view.window.height();
  // At the end, the picture and the data that its error is measured from exist beside the sums.
  constexpr double film_bytes = 1.5 * sizeof(std::int64_t);
  const double pixels = static_cast<double>(width) * height;
  const double film = pixels * (film_bytes * static_cast<double>(Film::stride(contents)) + use.per_pixel);
  if (film > limit.bytes)
    throw Error(fmt::format(
        "{} x {} pixels take {} of memory, but {}: choose fewer with --resolution, or render parts with --crop", width,
        height, memory_text(film), limit.words));

  const bool keeps_photons = use.per_photon > 0 && settings.photons > 0;
  const Stored per_path = keeps_photons ? stored_per_light_path({scene, view, settings}, use) : Stored{};
  const std::uint64_t held = std::min(settings.photons, use.photon_block);
  const double of_blocks = held < settings.photons ? pixels * use.per_pixel_of_blocks : 0;
  const double photons = static_cast<double>(held) * (per_path.bytes + use.per_light_path) + of_blocks;
  if (film + photons > limit.bytes) throw Error(too_many_photons(settings, use, per_path, photons, film, limit));
  // Random numbers and maps have indices of 32 bits.
  constexpr double most_numbers = std::numeric_limits<std::uint32_t>::max();
  if (std::max(static_cast<double>(settings.photons), static_cast<double>(held) * per_path.photons) > most_numbers)
    throw Error(fmt::format("--photons {}: a pass can have at most {:.0f} light paths, and as many photons",
                            settings.photons, most_numbers));
  if (use.fills_the_rest && option) settings.memory = static_cast<std::uint64_t>(limit.bytes - film - photons);
  // Other programs may need some of the memory that is free now.
  const double room = option ? limit.bytes : limit.bytes / 2;
  constexpr double most = 1024;
  return static_cast<std::size_t>(std::clamp(photons > 0 ? (room - film) / photons : most, 1.0, most));
}

constexpr std::uint64_t default_passes = 64;

int default_max_depth(const Scene& scene) { return scatterings_until_dark(scene.largest_medium_albedo()); }

// pbrt's SPPM limits eye and light paths separately; Lanthorn limits the whole path.
int scene_max_depth(const Scene& scene) {
  const description::RenderHints& hints = scene.description().hints;
  if (!hints.max_depth) return default_max_depth(scene);
  const int depth = *hints.max_depth;
  return std::max(1, hints.integrator == "sppm" ? 2 * std::min(depth, std::numeric_limits<int>::max() / 2) : depth);
}

std::string choose_integrator(const description::RenderHints& hints, const RenderOptions& options) {
  return options.integrator ? *options.integrator : default_method(hints.integrator).name;
}

PassRange choose_passes(const description::RenderHints& hints, const RenderOptions& options) {
  constexpr std::uint64_t never = std::numeric_limits<std::uint32_t>::max();
  if (options.pass_range) return *options.pass_range;
  if (options.passes) return {0, *options.passes};
  if (options.seconds || options.noise) return {0, never};
  return {0, hints.pixel_samples ? static_cast<std::uint64_t>(std::max(1, *hints.pixel_samples)) : default_passes};
}

// Throws Error for limits that no render can keep.
void check_limits(const RenderOptions& options) {
  if (options.passes == 0U) throw Error("--passes 0: expected 1 or more");
  if (options.photons == 0U) throw Error("--photons 0: expected 1 or more");
  if (options.max_depth && *options.max_depth < 1)
    throw Error(fmt::format("--max-depth {}: expected 1 or more", *options.max_depth));
  if (const auto& range = options.pass_range; range && range->begin >= range->end)
    throw Error(fmt::format("--pass-range {}:{}: expected an end after the first pass", range->begin, range->end));
  if (options.seconds && !(*options.seconds > 0))
    throw Error(fmt::format("--time {}: expected a number of seconds above 0", *options.seconds));
  if (options.noise) check_error_bound(*options.noise);
}

// The option if given, else the file's number of photons, else `automatic`. `auto` ignores a number that the file gives
// for another method.
std::uint64_t choose_light_paths(const description::RenderHints& hints, const RenderOptions& options,
                                 const std::string& method, std::uint64_t automatic) {
  if (options.photons) return *options.photons;
  const bool is_for_another = method == automatic_method && hints.integrator != automatic_method;
  const int of_file = is_for_another ? 0 : hints.photons_per_iteration.value_or(0);
  return of_file > 0 ? static_cast<std::uint64_t>(of_file) : automatic;
}

RenderSettings choose_settings(const Scene& scene, const ViewDescription& description, const RenderOptions& options,
                               const RenderPlan& plan) {
  const description::RenderHints& hints = scene.description().hints;
  RenderSettings s;
  s.seed = options.seed.value_or(hints.seed.value_or(0));
  const auto& buckets = description.film.buckets;
  const bool wants_spectra = scene.has_measured_spectra() || scene.has_dispersion() || buckets;
  s.color = options.color.value_or(wants_spectra ? ColorMode::spectral : ColorMode::rgb);
  if (buckets && s.color == ColorMode::rgb)
    throw Error("--color rgb: the scene's film is \"spectral\", which only spectral rendering can fill");
  s.max_depth = options.max_depth ? *options.max_depth : scene_max_depth(scene);
  const PixelWindow& crop = plan.view.crop;
  const auto pixels = static_cast<std::uint64_t>(crop.width()) * static_cast<std::uint64_t>(crop.height());
  const LightPathRange& range = plan.info->light_paths;
  const std::uint64_t automatic = std::clamp(pixels, range.fewest, range.most);
  const std::uint64_t of_pass = choose_light_paths(hints, options, plan.info->name, automatic);
  // Two sets of four wavelengths are enough for the colours of smooth spectra (render/picture.h).
  s.parts = plan.integrator->passes_share_wavelengths() && s.color == ColorMode::spectral ? 2 : 1;
  s.photons = of_pass / s.parts + (of_pass % s.parts > 0 ? 1 : 0);
  return s;
}

Parameters choose_parameters(const description::RenderHints& hints, const RenderOptions& options,
                             const IntegratorInfo& info) {
  std::map<std::string, std::string> set = options.set;
  const auto takes = [&](const std::string& name) {
    return std::any_of(info.parameters.begin(), info.parameters.end(),
                       [&](const ParameterInfo& p) { return p.name == name; });
  };
  for (const auto& [name, value] : hints.parameters)
    if (takes(name)) set.emplace(name, value);
  return {info.parameters, set, info.name};
}

// Motion is stored for the shutter interval of the scene file.
void require_shutter_of(const Scene& scene, const description::Camera& camera) {
  const description::Camera& own = scene.description().view.camera;
  if (scene.has_motion() && (camera.shutter_open != own.shutter_open || camera.shutter_close != own.shutter_close))
    throw Error(camera.location,
                fmt::format("the view's shutter is open from {} to {}, but the scene was built for {} "
                            "to {}; build the scene with the view's shutter",
                            camera.shutter_open, camera.shutter_close, own.shutter_open, own.shutter_close));
}

}  // namespace

void check_error_bound(double bound) {
  if (!(bound > 0 && bound <= 1))
    throw Error(fmt::format("--noise {}: expected a share above 0 and at most 1, such as 0.02 for 2 %", bound));
}

RenderPlan plan_render(const Scene& scene, const ViewDescription& view, const RenderOptions& options) {
  const description::RenderHints& hints = scene.description().hints;
  require_shutter_of(scene, view.camera);
  check_limits(options);
  const IntegratorInfo& info = find_integrator(choose_integrator(hints, options));
  RenderPlan plan{view_in(scene, view, options), &info, choose_parameters(hints, options, info)};
  if (!plan.integrator->crops_are_exact()) plan.view.window = plan.view.crop;
  FilmContents contents = plan.integrator->film_contents(scene);
  contents.buckets = view.film.buckets;
  contents.negative_share = plan.view.filter.negative_share();
  plan.settings = choose_settings(scene, view, options, plan);
  plan.passes_that_fit = plan_memory(scene, plan.view, *plan.integrator, contents, options.memory, plan.settings);
  plan.stop.passes = choose_passes(hints, options);
  if (plan.stop.passes.begin > 0) require_independent_passes("--pass-range", info.name);
  plan.stop.seconds = options.seconds;
  plan.stop.noise = options.noise;
  if (options.noise && !plan.integrator->knows_bias())
    throw Error(
        fmt::format("--noise: {} has a bias that it does not measure; limit it by --passes or --time", info.name));

  RenderState& state = plan.state;
  const PixelWindow& window = plan.view.window;
  state.film = Film(window.width(), window.height(), scene.largest_radiance(), contents);
  state.integrator = info.name;
  state.shardable = plan.integrator->passes_are_independent();
  state.record = record_of(scene, view, options, plan);
  const auto photons = static_cast<double>(plan.settings.photons * plan.settings.parts);
  RenderOptions exact = options;  // whose height may have been left open
  exact.resolution = {plan.view.camera.width(), plan.view.camera.height()};
  plan.coarse = [view, exact, photons](const Scene& same, double share) {
    return plan_render(same, view, coarse_options(exact, view.film, share, photons));
  };
  return plan;
}

RenderOptions coarse_options(RenderOptions options, const description::Film& film, double share, double photons) {
  constexpr double fewest = 8000;
  static_cast<ViewOptions&>(options) = scaled(options, film, share);
  options.photons =
      static_cast<std::uint64_t>(std::min(std::max(fewest, photons * share * share), std::max(1.0, photons)));
  options.pass_range.reset();
  return options;
}

}  // namespace lanthorn
