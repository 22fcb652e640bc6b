// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/mlt/mlt_paths.h"

#include <algorithm>
#include <optional>

#include "path/connections.h"
#include "path/depth.h"
#include "path/eye_pass.h"
#include "path/lens_connection.h"
#include "path/radiance_along.h"

namespace lanthorn {

namespace {

// The start of an eye path: film and lens in group 0, time and hero in group 1.
struct EyeSample {
  Vec2 raster;
  CameraRay ray;
};

// Both subpaths have the same time and hero.
PathDraw draw_path(const PathPass& pass, Sampler& sampler) {
  sampler.seek(1);
  const float time = pass.job.view.camera.time(sampler.next());
  if (!pass.draw.heroes_differ) return {time, pass.draw.w};
  return {time, pass.draw.w.with_hero(static_cast<unsigned>(4 * sampler.next()))};
}

EyeSample start_anywhere(const PathPass& pass, float time, Sampler& sampler) {
  sampler.seek(0);
  const Vec2 raster = pass.region.corner + sampler.next2() * pass.region.size;
  return {raster, eye_ray(pass.job.view, raster, sampler.next2(), time)};
}

// Follows a subpath to its vertex number `last` and passes that to `end(vertex, subpath)` if it has a non-delta lobe.
template <class End>
struct SubpathVisitor {
  const PathContext& path;
  int last;
  End end;
  Subpath subpath;
  const EmissionDensities& emission;
  std::uint32_t light = 0;        // of light paths
  LightLayers* layers = nullptr;  // of eye paths

  void operator()(const EmissionSample& sample) { subpath.begin_at_light(light, sample, emission); }
  Continuation operator()(const SurfaceVertex& v) { return arrive(v, has_non_delta(v.at.bsdf)); }
  Continuation operator()(const MediumVertex& v) {
    if (layers != nullptr) layers->see(v);
    return arrive(v, true);
  }
  void operator()(const EscapeVertex&) {}
  void operator()(const FlownSegment& flight) { subpath.fly(flight); }

  template <class Vertex>
  Continuation arrive(const Vertex& v, bool scatters) {
    subpath.arrive(path, v);
    if (v.state.depth < last) return Continuation::go_on();
    if (scatters && v.may_scatter) end(v, subpath);
    return Continuation::stop();
  }
};

// Light that an eye path hits after a given number of scatterings.
struct HitVisitor {
  const PathContext& path;
  const Bidirectional& pass;
  int scatterings;
  LightLayers& layers;
  Subpath subpath;

  Continuation operator()(const SurfaceVertex& v) {
    subpath.arrive(path, v);
    if (v.state.depth <= scatterings) return Continuation::go_on();
    add_hits(v, subpath);
    return Continuation::stop();
  }
  Continuation operator()(const MediumVertex& v) {
    layers.see(v);
    subpath.arrive(path, v);
    return v.state.depth <= scatterings ? Continuation::go_on() : Continuation::stop();
  }
  void operator()(const FlownSegment& flight) { subpath.fly(flight); }
  void operator()(const EmissionVertex& v) {
    if (v.state.depth != scatterings) return;
    Subpath to_medium = subpath;
    to_medium.escape(v.state, v.direction, false);
    add_hits(v, to_medium);
  }
  void operator()(const EscapeVertex& v) {
    if (v.state.depth < scatterings) return;
    subpath.escape(v.state, v.direction);
    add_hits(v, subpath);
  }

  template <class Vertex>
  void add_hits(const Vertex& v, const Subpath& to_light) {
    Spectrum sum;
    hit_lights(path, pass, v, to_light, [&](const Contribution& hit) { sum += hit.weighted(pass.techniques); });
    layers.add_hit(v, sum);
  }
};

FilmLight without_emission(const Vec2& raster, const LightLayers& layers, float factor) {
  FilmLight result{raster, {}, layers.is_from_medium()};
  for (const PathClass c : {PathClass::direct, PathClass::indirect, PathClass::caustic})
    result.of(c) = layers.light(c) * factor;
  return result;
}

// A path of the technique with `light_vertices` vertices on the light's side, including the point on the light: 0 for
// the eye path's hit, 1 for next-event estimation, scatterings + 1 for the connection to the lens.
class MultiplexedPath {
 public:
  MultiplexedPath(const PathPass& pass, const LightChoice& lights, int scatterings, PathSamples& samples,
                  RayCounts& counts)
      : pass_(pass),
        bidirectional_{pass.job.view, {.light_paths = pass.region.area()}, lights.emission},
        lights_(lights),
        scatterings_(scatterings),
        eye_(samples.eye),
        light_(samples.light),
        counts_(counts) {
    light_.seek(1);
    const auto techniques = static_cast<float>(scatterings + 2);
    light_vertices_ = std::min(static_cast<int>(light_.next() * techniques), scatterings + 1);
    factor_ = techniques * pass.region.area();
    draw_ = draw_path(pass, eye_);
  }

  FilmLight light() {
    if (light_vertices_ == 0) return hit();
    if (light_vertices_ == scatterings_ + 1) return see();
    return connect_ends();
  }

 private:
  // Number of scattering vertices of the eye walk.
  int eye_vertices() const { return scatterings_ + 1 - light_vertices_; }
  // Without Russian roulette: paths end by their number of scatterings only.
  PathContext path(Sampler& sampler) {
    const int most = std::min(scatterings_, pass_.limits.max_depth);
    return {pass_.job.scene, draw_.w, sampler, counts_, {most, scatterings_ + 1}};
  }

  FilmLight hit() {
    const EyeSample start = start_anywhere(pass_, draw_.time, eye_);
    LightLayers layers(draw_.w);
    const PathContext eye = path(eye_);
    HitVisitor visitor{eye, bidirectional_, scatterings_, layers, Subpath(bidirectional_.techniques)};
    visitor.subpath.begin_at_lens(pass_.job.view.camera);
    walk_from_camera(eye, start.ray, pass_.job.view.medium, visitor);
    return without_emission(start.raster, layers, factor_);
  }

  template <class End>
  void walk_light(int last, const End& end) {
    light_.seek(1);
    light_.next();
    const auto chosen = lights_.table.sample(light_.next());
    if (!chosen) return;
    const auto index = static_cast<std::uint32_t>(chosen->index);
    const float probability = lights_.emission.of_lights()[index];
    const PathContext light = path(light_);
    walk_from_light(
        light, {light.scene.lights()[index], index, 1 / (probability * bidirectional_.techniques.light_paths)},
        draw_.time,
        SubpathVisitor<End>{light, last, end, Subpath(bidirectional_.techniques), bidirectional_.emission, index});
  }

  FilmLight see() {
    FilmLight result;
    walk_light(scatterings_, [&](const auto& v, const Subpath& subpath) {
      const PathContext context = path(light_);
      const auto lens = find_lens(context, pass_.job.view, v);
      if (!lens) return;
      const auto seen = connect_to_lens(context, pass_.job.view, v, *lens);
      if (!seen || !pass_.region.contains(seen->raster)) return;
      result.raster = seen->raster;
      const PathLayers layers = layers_of_splat(v);
      result.from_medium = layers.from_medium;
      result.of(layers.path_class) =
          seen->light * (seen->dispersed ? draw_.w.dispersed : Spectrum(1)) *
          (factor_ * densities_of_seen(bidirectional_, v, subpath, *seen).weight(bidirectional_.techniques));
    });
    return result;
  }

  FilmLight connect_ends() {
    std::optional<LightVertex> other;
    if (light_vertices_ > 1) {
      walk_light(light_vertices_ - 1, [&](const auto& v, const Subpath& subpath) { other = keep_vertex(v, subpath); });
      if (!other) return {};
    }
    const EyeSample start = start_anywhere(pass_, draw_.time, eye_);
    LightLayers layers(draw_.w);
    const PathContext eye = path(eye_);
    const auto end = [&](const auto& v, const Subpath& subpath) {
      if (other && !may_connect(eye.scene, v, other->at.position, other->scatterings, pass_.limits.max_depth)) return;
      const auto found =
          other ? connect(eye, bidirectional_, v, subpath, *other) : next_event(eye, bidirectional_, v, subpath);
      if (!found) return;
      layers.add(other ? PathClass::indirect : class_of_next_event(v.state), found->weighted(bidirectional_.techniques),
                 found->dispersed);
    };
    SubpathVisitor<decltype(end)> visitor{.path = eye,
                                          .last = eye_vertices(),
                                          .end = end,
                                          .subpath = Subpath(bidirectional_.techniques),
                                          .emission = bidirectional_.emission,
                                          .layers = &layers};
    visitor.subpath.begin_at_lens(pass_.job.view.camera);
    walk_from_camera(eye, start.ray, pass_.job.view.medium, visitor);
    return without_emission(start.raster, layers, factor_);
  }

  const PathPass& pass_;
  const Bidirectional bidirectional_;
  const LightChoice& lights_;
  int scatterings_;
  Sampler eye_, light_;
  RayCounts& counts_;
  int light_vertices_ = 0;
  float factor_ = 1;
  PathDraw draw_;
};

}  // namespace

FilmRegion::FilmRegion(const View& view) {
  const PixelWindow& window = view.window;
  const Vec2 radius = view.filter.radius();
  corner = window.corner() + Vec2(0.5f) - radius;
  size = Vec2(static_cast<float>(window.width()), static_cast<float>(window.height())) - Vec2(1) + 2.0f * radius;
}

LightChoice::LightChoice(const Scene& scene) : emission(scene), table(emission.of_lights()) {}

FilmLight trace_path(const PathPass& pass, PathSamples& samples, RayCounts& counts) {
  Sampler sampler(samples.eye);
  const PathDraw draw = draw_path(pass, sampler);
  const EyeSample start = start_anywhere(pass, draw.time, sampler);
  LightLayers layers(draw.w);
  radiance_along({pass.job.scene, draw.w, sampler, counts, pass.limits}, start.ray, pass.job.view.medium, layers);
  return without_emission(start.raster, layers, pass.region.area());
}

FilmLight connect_path(const PathPass& pass, const LightChoice& lights, int scatterings, PathSamples& samples,
                       RayCounts& counts) {
  return MultiplexedPath(pass, lights, scatterings, samples, counts).light();
}

}  // namespace lanthorn
