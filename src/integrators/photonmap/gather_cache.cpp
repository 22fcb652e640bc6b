// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/photonmap/gather_cache.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "lanthorn/error.h"
#include "path/eye_pass.h"
#include "photon/photon_gather.h"

namespace lanthorn {

namespace {

// Largest number of mirrors and panes before a cached point. Points behind more are few, and each number of them needs
// records of its own.
constexpr int most_depth = 4;

// State shared by all pixels of a pass.
struct Fill {
  const RenderJob& job;
  const TwoPassSettings& settings;
  const TwoPassMaps& maps;
  HemisphereGrid grid;
  std::uint32_t pass;
  std::atomic<std::uint64_t>& misses;  // unused counter: gather rays do not look up the cache
};

// The point at which a pixel will look up irradiance.
struct SeenPoint {
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  Point position{0};
  Normal normal{0, 0, 1};
  float pixel = 0;           // width of a pixel at the point, m
  std::size_t cache = none;  // index among the pass's caches
};

// A gather ray that also records the distance to its first hit.
struct RangedVisitor {
  TwoPassVisitor inner;
  float& distance;

  void note(const WalkState& state, const Point& p) {
    if (std::isinf(distance)) distance = std::sqrt(distance_squared(state.previous, p));
  }
  NarrowContinuation operator()(const SurfaceVertex& vertex) {
    note(vertex.state, vertex.at.position);
    return inner(vertex);
  }
  Continuation operator()(const MediumVertex& vertex) {
    note(vertex.state, vertex.position);
    return inner(vertex);
  }
  void operator()(const EmissionVertex& vertex) { inner(vertex); }
  void operator()(const EscapeVertex& vertex) { inner(vertex); }
};

// Follows a pixel's eye path, as TwoPassVisitor does, to the diffuse surface that it sees. Calls
// `see(vertex, cache, length)` there, with the pass's cache for it and the length of the path, m.
template <class See>
class FillVisitor {
 public:
  FillVisitor(const Fill& fill, See& see) : fill_(fill), see_(see) {}

  NarrowContinuation operator()(const SurfaceVertex& vertex) {
    length_ += std::sqrt(distance_squared(vertex.state.previous, vertex.at.position));
    if (vertex.state.non_delta > 0 || !vertex.may_scatter) return {Continuation::stop()};
    if (!has_non_delta(vertex.at.bsdf)) return {Continuation::go_on()};
    if (const IrradianceCache* cache = cache_for(fill_.maps, vertex)) {
      see_(vertex, static_cast<std::size_t>(cache - fill_.maps.gathered.data()), length_);
      return {Continuation::stop()};
    }
    return narrow_lobes(split_lobes(vertex));
  }
  Continuation operator()(const MediumVertex&) const { return Continuation::stop(); }
  void operator()(const EscapeVertex&) const {}

 private:
  const Fill& fill_;
  See& see_;
  float length_ = 0;
};

// The pixel's own eye path of this pass.
template <class See>
void follow_eye_path(const Fill& fill, const PixelPlace& place, RayCounts& counts, See&& see) {
  Sampler sampler = eye_sampler(fill.job, place, fill.pass);
  const EyeStart start = start_eye_path(fill.job.view, place, fill.maps.draw.of_path(sampler).time, sampler);
  const auto see_from = [&](const SurfaceVertex& vertex, std::size_t cache, float length) {
    see(start.camera.ray, vertex, cache, length);
  };
  const PathContext path{fill.job.scene, fill.maps.draw.w, sampler, counts, {fill.job.settings.max_depth, 3}};
  walk_from_camera(path, start.camera, fill.job.view.medium, FillVisitor(fill, see_from));
}

// One ray of a record: as in TwoPassVisitor::gather, but in a direction of the hemisphere's grid and without the
// reflectance.
HemisphereRay gather_ray(const Fill& fill, std::uint32_t key, const SurfaceVertex& vertex, const Frame& frame, int cell,
                         RayCounts& counts) {
  const int depth = vertex.state.depth;
  const Wavelengths& w = fill.maps.draw.w;
  const std::uint64_t own_key = hash_words({key, static_cast<std::uint64_t>(depth)});
  Sampler own =
      Sampler::for_pixel(fill.job.settings.seed, Stream::irradiance, static_cast<std::uint32_t>(own_key),
                         fill.pass * static_cast<std::uint32_t>(fill.grid.cells()) + static_cast<std::uint32_t>(cell));
  own.seek(walk_dimensions(depth));
  const Vec3 local = fill.grid.direction(cell, own.next2());
  LightLayers layers(w);
  const TwoPassContext context{fill.job, fill.settings, fill.maps, key, fill.pass, &fill.misses};
  const PathContext path{fill.job.scene, w, own, counts, {fill.job.settings.max_depth, 3}};
  HemisphereRay ray;
  walk_towards<Transport::radiance>(
      path, vertex, frame.to_world(local), pdf_cosine_hemisphere(local.z), unit_beta(w),
      RangedVisitor{TwoPassVisitor::of_gather_ray({path, layers}, context, vertex.state.non_delta + 1), ray.distance});
  for (const PathClass path_class : {PathClass::direct, PathClass::caustic, PathClass::indirect})
    ray.radiance += layers.light(path_class);
  return ray;
}

IrradianceRecord gather(const Fill& fill, std::uint32_t key, const SurfaceVertex& vertex, RayCounts& counts) {
  Frame frame = vertex.at.shading;
  frame.n = normal_of_light(vertex);
  std::vector<HemisphereRay> rays(static_cast<std::size_t>(fill.grid.cells()));
  for (int cell = 0; cell < fill.grid.cells(); ++cell)
    rays[static_cast<std::size_t>(cell)] = gather_ray(fill, key, vertex, frame, cell, counts);
  return estimate_irradiance(fill.grid, rays, frame);
}

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

SeenPoint seen_from(const Fill& fill, const PixelPlace& place, RayCounts& counts) {
  SeenPoint seen;
  follow_eye_path(fill, place, counts,
                  [&](const Ray& camera_ray, const SurfaceVertex& vertex, std::size_t cache, float length) {
                    const float density = fill.job.view.camera.density_at(camera_ray, length);
                    const float widest = fill.job.scene.bounding_sphere().radius;
                    const float pixel = density > 0 ? std::min(widest, 1 / std::sqrt(density)) : widest;
                    seen = {vertex.at.position, normal_of_light(vertex), pixel, cache};
                  });
  return seen;
}

// A record whose irradiance has not been gathered yet. Its radius is the shortest spacing.
IrradianceRecord planned_record(const SeenPoint& seen, const GatherCacheSettings& settings) {
  IrradianceRecord record;
  record.position = seen.position;
  record.normal = seen.normal;
  record.distance = 0;
  record.least = settings.least * seen.pixel / settings.error;
  return record;
}

IrradianceRecord make_record(const Fill& fill, const PixelPlace& place, const SeenPoint& seen, RayCounts& counts) {
  const GatherCacheSettings& settings = *fill.settings.cache;
  IrradianceRecord record;
  follow_eye_path(fill, place, counts, [&](const Ray&, const SurfaceVertex& vertex, std::size_t, float) {
    record = gather(fill, fill.job.view.pixel_key(place.x, place.y), vertex, counts);
  });
  const IrradianceRecord planned = planned_record(seen, settings);
  record.position = planned.position;
  record.normal = planned.normal;
  record.least = planned.least;
  record.distance = std::min(record.distance, settings.most * seen.pixel / settings.error);
  return record;
}

// Computes the records of a pass.
class Filling {
 public:
  Filling(const Fill& fill, TwoPassMaps& maps) : fill_(fill), maps_(maps) {}

  void run() {
    const std::vector<std::vector<PixelPlace>> stages = grid_stages(fill_.job.view.window);
    see_all();
    for (const std::vector<PixelPlace>& stage : stages) cover(stage, fill_.settings.cache->error);
    // Records whose distance has been shortened since may no longer cover some points.
    for (const std::vector<PixelPlace>& stage : stages)
      cover(stage, IrradianceCache::smoothing * fill_.settings.cache->error);
  }

 private:
  void see_all();
  void cover(const std::vector<PixelPlace>& places, float limit);
  std::vector<PixelPlace> take_spaced(std::vector<PixelPlace>& places) const;
  void add_records(const std::vector<PixelPlace>& places);
  const SeenPoint& seen(const PixelPlace& place) const { return seen_[place.index]; }

  const Fill& fill_;
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

// Gathers where no record has an estimated error below `limit`. Of pixels that are close to each other only one
// gathers; the others wait for its record.
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
  const Fill fill{job, settings, maps, HemisphereGrid(settings.cache->rays), pass, misses};
  Filling(fill, maps).run();
}

}  // namespace lanthorn
