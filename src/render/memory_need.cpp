// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/memory_need.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>

#include "base/memory.h"
#include "lanthorn/error.h"
#include "lanthorn/text.h"
#include "path/path_draw.h"
#include "photon/photon_pass.h"

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

}  // namespace

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

}  // namespace lanthorn
