// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/gather_cache.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "cache/photon_gather.h"
#include "lanthorn/error.h"
#include "path/eye_pass.h"

namespace lanthorn {

namespace {

// Points behind more mirrors and panes than this are few, and each number has records of its own.
constexpr int most_depth = 4;

// What all pixels of a pass need.
struct Fill {
  const Scene& scene;
  const RenderSettings& render;
  const TwoPassSettings& settings;
  const TwoPassMaps& maps;
  HemisphereGrid grid;
  std::uint32_t pass;
  std::atomic<std::uint64_t>& misses;  // of gather rays, which look nothing up
};

// A record that a pixel has made.
struct NewRecord {
  IrradianceRecord record;
  std::size_t cache = 0;  // where it belongs
};

// A gather ray, and how far it flies before it meets anything.
struct RangedVisitor {
  TwoPassVisitor inner;
  float& distance;

  void note(const WalkState& state, const Point& p) {
    if (std::isinf(distance)) distance = std::sqrt(distance_squared(state.previous, p));
  }
  Continuation operator()(const SurfaceVertex& vertex) {
    note(vertex.state, vertex.at.position);
    return inner(vertex);
  }
  Continuation operator()(const MediumVertex& vertex) {
    note(vertex.state, vertex.position);
    return inner(vertex);
  }
  void operator()(const GlowVertex& vertex) { inner(vertex); }
  void operator()(const EscapeVertex& vertex) { inner(vertex); }
};

// Follows a pixel's eye path as TwoPassVisitor does, to the diffuse surface that it sees.
class FillVisitor {
 public:
  FillVisitor(const Fill& fill, const Ray& camera_ray, std::uint32_t pixel_key, RayCounts& counts,
              std::optional<NewRecord>& result)
      : fill_(fill), camera_ray_(camera_ray), pixel_key_(pixel_key), counts_(counts), result_(result) {}

  Continuation operator()(const SurfaceVertex& vertex) {
    length_ += std::sqrt(distance_squared(vertex.state.previous, vertex.at.position));
    if (vertex.state.non_delta > 0 || !vertex.may_scatter) return Continuation::stop();
    if (!has_non_delta(vertex.at.bsdf)) return Continuation::go_on();
    if (const IrradianceCache* cache = cache_for(fill_.maps, vertex)) {
      if (!cache->covers(vertex.at.position, normal_of_light(vertex)))
        result_ = {gather(vertex), static_cast<std::size_t>(cache - fill_.maps.gathered.data())};
      return Continuation::stop();
    }
    return narrow_lobes(gather_probability(lobe_weights(vertex.at.bsdf, vertex.wi_local)));
  }
  Continuation operator()(const MediumVertex&) const { return Continuation::stop(); }
  void operator()(const EscapeVertex&) const {}

 private:
  IrradianceRecord gather(const SurfaceVertex& vertex) const;
  HemisphereRay gather_ray(const SurfaceVertex& vertex, const Frame& frame, int cell) const;

  const Fill& fill_;
  const Ray& camera_ray_;
  std::uint32_t pixel_key_;
  RayCounts& counts_;
  std::optional<NewRecord>& result_;
  float length_ = 0;  // of the eye path, m
};

IrradianceRecord FillVisitor::gather(const SurfaceVertex& vertex) const {
  Frame frame = vertex.at.shading;
  frame.n = normal_of_light(vertex);
  std::vector<HemisphereRay> rays(static_cast<std::size_t>(fill_.grid.cells()));
  for (int cell = 0; cell < fill_.grid.cells(); ++cell)
    rays[static_cast<std::size_t>(cell)] = gather_ray(vertex, frame, cell);
  IrradianceRecord record = estimate_irradiance(fill_.grid, rays, frame);
  record.position = vertex.at.position;

  const GatherCacheSettings& cache = *fill_.settings.cache;
  const float density = fill_.scene.camera().density_at(camera_ray_, length_);
  const float scene = fill_.scene.bounding_sphere().radius;
  const float pixel = density > 0 ? std::min(scene, 1 / std::sqrt(density)) : scene;
  record.least = cache.least * pixel / cache.error;
  record.distance = std::min(record.distance, cache.most * pixel / cache.error);
  return record;
}

// As a final gather does everywhere (TwoPassVisitor::gather), in a direction of the grid and without a reflectance.
HemisphereRay FillVisitor::gather_ray(const SurfaceVertex& vertex, const Frame& frame, int cell) const {
  const int depth = vertex.state.depth;
  const Wavelengths& w = fill_.maps.draw.w;
  const std::uint64_t key = hash_words({pixel_key_, static_cast<std::uint64_t>(depth)});
  Sampler own = Sampler::for_pixel(
      fill_.render.seed, Stream::irradiance, static_cast<std::uint32_t>(key),
      fill_.pass * static_cast<std::uint32_t>(fill_.grid.cells()) + static_cast<std::uint32_t>(cell));
  own.seek(walk_dimensions(depth));
  const Vec3 local = fill_.grid.direction(cell, own.next2());
  LightLayers layers(w);
  const TwoPassContext context{fill_.scene, fill_.render, fill_.settings, fill_.maps,   pixel_key_,
                               fill_.pass,  counts_,      layers,         &fill_.misses};
  HemisphereRay ray;
  walk_towards<Transport::radiance>(
      fill_.scene, vertex, frame.to_world(local), pdf_cosine_hemisphere(local.z), unit_beta(w),
      {fill_.render.max_depth, 3}, w, own, counts_,
      RangedVisitor{TwoPassVisitor::of_gather_ray(context, own, vertex.state.non_delta + 1), ray.distance});
  for (const PathClass path_class : {PathClass::direct, PathClass::caustic, PathClass::indirect})
    ray.radiance += layers.light(path_class);
  return ray;
}

// The window's pixels in stages. Each stage halves the cells of the grid before, by their centres or by what is then
// missing: neighbours of one stage, which do not know of each other, lie farther apart than those of earlier ones.
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

// The pixel's own eye path of this pass: where it will look the irradiance up.
std::optional<NewRecord> make_record(const Fill& fill, const PixelPlace& place, RayCounts& counts) {
  const std::uint32_t key = pixel_key(fill.scene, place);
  Sampler sampler = Sampler::for_pixel(fill.render.seed, Stream::camera, key, fill.pass);
  const EyeStart start = start_eye_path(fill.scene, fill.render.filter, place, fill.maps.draw.time, sampler);
  std::optional<NewRecord> result;
  walk_from_camera(fill.scene, start.camera, {fill.render.max_depth, 3}, fill.maps.draw.w, sampler, counts,
                   FillVisitor(fill, start.camera.ray, key, counts, result));
  return result;
}

}  // namespace

GatherCacheSettings gather_cache_settings(const Parameters& parameters) {
  GatherCacheSettings settings;
  settings.error = static_cast<float>(parameters.number("cache-error", 0.001, 1));
  settings.least = static_cast<float>(parameters.number("cache-min-spacing", 0.01, 1e6));
  settings.most = static_cast<float>(parameters.number("cache-max-spacing", 0.01, 1e6));
  settings.rays = static_cast<int>(parameters.number("cache-rays", 4, 65536));
  if (settings.most < settings.least) throw Error("--set cache-max-spacing: less than cache-min-spacing");
  return settings;
}

void fill_gather_caches(const Scene& scene, const RenderSettings& render, const TwoPassSettings& settings,
                        std::uint32_t pass, TwoPassMaps& maps) {
  maps.gathered.assign(static_cast<std::size_t>(std::min(most_depth, render.max_depth)),
                       IrradianceCache(scene.bounds(), settings.cache->error));
  std::atomic<std::uint64_t> misses{0};
  const Fill fill{scene, render, settings, maps, HemisphereGrid(settings.cache->rays), pass, misses};
  for (const std::vector<PixelPlace>& stage : grid_stages(render.window)) {
    std::vector<std::optional<NewRecord>> made(stage.size());
    std::vector<RayCounts> counts(stage.size());
    parallel_for(std::size_t{0}, stage.size(),
                 [&](std::size_t i) { made[i] = make_record(fill, stage[i], counts[i]); });
    for (const RayCounts& c : counts) maps.report.rays += c;
    for (const std::optional<NewRecord>& made_here : made) {
      if (!made_here) continue;
      const IrradianceRecord& record = made_here->record;
      IrradianceCache& cache = maps.gathered[made_here->cache];
      if (!cache.covers(record.position, record.normal)) cache.insert(record);
    }
  }
  for (const IrradianceCache& cache : maps.gathered) maps.report.cache_records += cache.records().size();
}

}  // namespace lanthorn
