// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/photonmap/gather_cache.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

#include "lanthorn/error.h"
#include "path/eye_pass.h"

namespace lanthorn {

namespace {

// Largest number of mirrors and panes between the eye and a cached point. Few points lie behind more, and each number
// needs its own records.
constexpr int most_depth = 4;

// The window's pixels in stages. Each stage refines the grid of the stage before: first by the centres of its cells,
// then by the midpoints of their sides. Pixels of one stage do not see each other's records, so they must not be close.
std::vector<std::vector<PixelPlace>> grid_stages(const PixelWindow& window) {
  constexpr int coarsest = 6;  // log2 of the first grid's spacing
  std::vector<std::vector<PixelPlace>> stages(2 * coarsest + 1);
  for (int y = 0; y < window.height(); ++y)
    for (int x = 0; x < window.width(); ++x) {
      const int level = std::min(coarsest, std::countr_zero(static_cast<unsigned>(x | y)));
      const bool is_centre = (((x & y) >> level) & 1) != 0;
      const int stage = level == coarsest ? 0 : 2 * (coarsest - level) - (is_centre ? 1 : 0);
      stages[static_cast<std::size_t>(stage)].push_back(
          {window.x0 + x, window.y0 + y, static_cast<std::uint32_t>(y * window.width() + x)});
    }
  return stages;
}

// Computes the records of a pass.
class Filling {
 public:
  Filling(const GatherFill& fill, TwoPassMaps& maps) : fill_(fill), maps_(maps) {}

  void run() {
    const std::vector<std::vector<PixelPlace>> stages = grid_stages(fill_.job.view.window);
    see_all();
    for (const std::vector<PixelPlace>& stage : stages) cover(stage, fill_.settings.cache->error);
    // Neighbour clamping may have shortened the distances of earlier records, which then no longer cover some points.
    for (const std::vector<PixelPlace>& stage : stages)
      cover(stage, IrradianceCache::smoothing * fill_.settings.cache->error);
  }

 private:
  void see_all();
  void cover(const std::vector<PixelPlace>& places, float limit);
  std::vector<PixelPlace> take_spaced(std::vector<PixelPlace>& places) const;
  void add_records(const std::vector<PixelPlace>& places);
  const SeenPoint& seen(const PixelPlace& place) const { return seen_[place.index]; }

  const GatherFill& fill_;
  TwoPassMaps& maps_;
  std::vector<SeenPoint> seen_;  // of each pixel
};

void Filling::see_all() {
  const PixelWindow& window = fill_.job.view.window;
  seen_.resize(static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height()));
  maps_.report.rays += for_each_pixel(window, [&](const PixelPlace& place, RayCounts& counts) {
    seen_[place.index] = seen_from(fill_, place, counts);
  });
}

// Gathers where no record has an estimated error below `limit`. Among pixels that are close to each other only one
// gathers; the other pixels wait for its record.
void Filling::cover(const std::vector<PixelPlace>& places, float limit) {
  std::vector<PixelPlace> waiting = places;
  while (!waiting.empty()) {
    std::vector<std::uint8_t> covered(waiting.size());
    parallel_for(std::size_t{0}, waiting.size(), [&](std::size_t i) {
      const SeenPoint& point = seen(waiting[i]);
      covered[i] =
          point.cache == SeenPoint::none || maps_.gathered[point.cache].covers(point.position, point.normal, limit);
    });
    std::size_t left = 0;
    for (std::size_t i = 0; i < waiting.size(); ++i)
      if (covered[i] == 0) waiting[left++] = waiting[i];
    waiting.resize(left);
    add_records(take_spaced(waiting));
  }
}

// Removes and returns pixels whose records cannot cover each other, even with the shortest distances.
std::vector<PixelPlace> Filling::take_spaced(std::vector<PixelPlace>& places) const {
  const GatherCacheSettings& settings = *fill_.settings.cache;
  std::vector<IrradianceCache> planned(maps_.gathered.size(),
                                       IrradianceCache(fill_.job.scene.bounds(), settings.error));
  std::vector<PixelPlace> taken, left;
  for (const PixelPlace& place : places) {
    const SeenPoint& point = seen(place);
    IrradianceCache& cache = planned[point.cache];
    const bool is_near = cache.covers(point.position, point.normal, settings.error);
    (is_near ? left : taken).push_back(place);
    if (!is_near) cache.insert(planned_record(point, settings));
  }
  places = std::move(left);
  return taken;
}

void Filling::add_records(const std::vector<PixelPlace>& places) {
  std::vector<IrradianceRecord> made(places.size());
  std::vector<RayCounts> counts(places.size());
  parallel_for(std::size_t{0}, places.size(),
               [&](std::size_t i) { made[i] = make_record(fill_, places[i], seen(places[i]), counts[i]); });
  for (std::size_t i = 0; i < places.size(); ++i) {
    maps_.report.rays += counts[i];
    maps_.gathered[seen(places[i]).cache].insert(made[i]);
  }
  maps_.report.cache_records += places.size();
}

}  // namespace

GatherCacheSettings gather_cache_settings(const Parameters& parameters) {
  GatherCacheSettings settings;
  settings.error = static_cast<float>(parameters.number("cache-error", 0.001, 1));
  settings.least = static_cast<float>(parameters.number("cache-min-spacing", 0.01, 1e6));
  settings.most = static_cast<float>(parameters.number("cache-max-spacing", 0.01, 1e6));
  // With new maps in each pass, the mean over the passes removes the noise of the records.
  settings.rays = parameters.text("cache-rays") != "auto" ? static_cast<int>(parameters.number("cache-rays", 4, 65536))
                  : parameters.text("maps") == "kept"     ? 512
                                                          : 128;
  if (settings.most < settings.least) throw Error("--set cache-max-spacing: less than cache-min-spacing");
  return settings;
}

void fill_gather_caches(const RenderJob& job, const TwoPassSettings& settings, std::uint32_t pass, TwoPassMaps& maps) {
  maps.gathered.assign(static_cast<std::size_t>(std::min(most_depth, job.settings.max_depth)),
                       IrradianceCache(job.scene.bounds(), settings.cache->error));
  std::atomic<std::uint64_t> misses{0};
  const GatherFill fill{job, settings, maps, HemisphereGrid(settings.cache->rays), pass, misses};
  Filling(fill, maps).run();
}

}  // namespace lanthorn
