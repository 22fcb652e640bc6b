// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Vertex connection and merging (Georgiev, Křivánek, Davidovič & Slusallek 2012; Hachisuka, Pantaleoni & Jensen 2012)
// and its two halves: bidirectional path tracing (Veach 1997, chapter 10) connects vertices, bidirectional photon
// mapping merges them. One algorithm; the techniques are switched. A pass traces its light paths, splats each of their
// vertices through the lens, keeps them, and lets each eye path be connected to one light path and merge with all.
#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <vector>

#include "base/parameters.h"
#include "integrators/integrator.h"
#include "integrators/vcm/merge_map.h"
#include "lanthorn/error.h"
#include "path/connections.h"
#include "path/eye_pass.h"
#include "path/light_layers.h"
#include "path/path_draw.h"
#include "path/splat.h"
#include "photon/emission_choice.h"
#include "photon/kernels.h"
#include "photon/photon_hit.h"
#include "photon/pilot_radius.h"
#include "photon/radius_schedule.h"

namespace lanthorn {

namespace {

// Which techniques a method has besides the eye walk's own hits.
struct Switches {
  bool connections = true;  // next-event estimation and the lens included
  bool merging = true;
};

// One of the strategies of bidirectional path tracing: `s` vertices of the path, its light's point among them, are the
// light walk's, and `t`, the lens among them, the eye walk's (Veach 1997, section 10.2).
struct Strategy {
  int s = 0, t = 0;

  bool operator==(const Strategy&) const = default;
};

// What found the light: the parts of the method's decomposition. `hit`: the eye path met a light; `nee`: next-event
// estimation; `vc`: an eye vertex was connected to one of a light path; `vm`: it was merged with one.
namespace technique {
constexpr std::size_t hit = 0, nee = 1, vc = 2, vm = 3, splat = 4;
Decomposition decomposition() {
  return {{"technique.hit", "technique.nee", "technique.vc", "technique.vm"},
          "technique.splat",
          Decomposition::Shares{"technique.share", {{{vm}, {vc, nee, splat}, {hit}}}}};
}
}  // namespace technique

// What the visitors of a pass share.
struct Pass {
  const RenderJob& job;
  Bidirectional bidirectional;  // but its merging, which is each pixel's own
  Switches switches;
  std::optional<Strategy> only;  // all others are left out of the film
  const LightVertices& vertices;
  const MergeMap& merge_map;
  Kernel kernel;
  const FirstRadius& first_radius;
  float shrink = 1;  // of all radii since the first pass

  bool shows(const Strategy& strategy) const { return !only || *only == strategy; }
  // Of all merges of eye paths through this place on the film.
  float radius_at(const Vec2& raster) const { return first_radius.at(job.view.window.pixel_at(raster)) * shrink; }
  // Paths through one place on the film are weighed with one radius, whatever technique made them.
  Bidirectional bidirectional_at(const Vec2& raster) const {
    Bidirectional result = bidirectional;
    if (switches.merging) result.techniques.merging = result.techniques.light_paths * pi * sqr(radius_at(raster));
    return result;
  }
};

// Keeps the vertices of a light path and splats them through the lens.
class LightVisitor {
 public:
  LightVisitor(const PathContext& path, const Pass& pass, std::uint32_t light, Film& film, LightVertices::Chunk& chunk)
      : path_(path),
        pass_(pass),
        light_(light),
        film_(film),
        chunk_(chunk),
        subpath_(pass.bidirectional.techniques, &chunk.trails) {}

  void operator()(const EmissionSample& emission) {
    subpath_.begin_at_light(light_, emission, pass_.bidirectional.emission_probability[light_]);
  }
  Continuation operator()(const SurfaceVertex& v) {
    subpath_.arrive(path_.scene, v);
    if (v.may_scatter && has_non_delta(v.at.bsdf)) keep(v);
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& v) {
    subpath_.arrive(path_.scene, v);
    if (v.may_scatter) keep(v);
    return Continuation::go_on();
  }
  void operator()(const EscapeVertex&) {}

 private:
  template <class Vertex>
  void keep(const Vertex& v) {
    chunk_.vertices.push_back(keep_vertex(v, subpath_));
    if (!pass_.switches.connections || !pass_.shows({v.state.depth + 1, 1})) return;
    const View& view = pass_.job.view;
    if (const auto seen = connect_to_lens(path_, view, v))
      splat(film_, view, path_.w, *seen, class_of_splat(v.state),
            weight_of_seen(pass_.bidirectional_at(seen->raster), v, subpath_, *seen));
  }

  const PathContext& path_;
  const Pass& pass_;
  std::uint32_t light_;
  Film& film_;
  LightVertices::Chunk& chunk_;
  Subpath subpath_;
};

// Finds the light of an eye path by all techniques but the lens.
class EyeVisitor {
 public:
  EyeVisitor(const PathContext& path, const Pass& pass, const Vec2& raster, std::size_t light_path, LightLayers& layers,
             std::vector<TrailVertex>& trail)
      : path_(path),
        pass_(pass),
        bidirectional_(pass.bidirectional_at(raster)),
        support_(pass.switches.merging ? pass.kernel.support(pass.radius_at(raster)) : 0.0f),
        light_path_(light_path),
        layers_(layers),
        subpath_(pass.bidirectional.techniques, &trail) {
    subpath_.begin_at_lens(pass.job.view.camera);
  }

  Continuation operator()(const SurfaceVertex& v) {
    layers_.see(v);
    subpath_.arrive(path_.scene, v);
    if (hits_count(v.state) && pass_.shows({0, v.state.depth + 1}))
      layers_.add(class_of_hit(v.state), technique::hit, hit_emitter(path_, bidirectional_, v, subpath_),
                  v.state.dispersed);
    if (!v.may_scatter) return Continuation::stop();
    if (has_non_delta(v.at.bsdf)) {
      if (pass_.switches.connections) connect_all(v);
      if (pass_.switches.merging && merges_at(v.at)) merge(v);
    }
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& v) {
    subpath_.arrive(path_.scene, v);
    if (!v.may_scatter) return Continuation::stop();
    if (pass_.switches.connections) connect_all(v);
    return Continuation::go_on();
  }
  void operator()(const EmissionVertex& v) {
    if (!pass_.shows({0, v.state.depth + 2})) return;
    layers_.add(class_of_emission(v.state), technique::hit, v.state.beta * v.radiance, v.state.dispersed);
  }
  void operator()(const EscapeVertex& v) {
    if (!hits_count(v.state) || !pass_.shows({0, v.state.depth + 2})) return;
    subpath_.escape(v);
    layers_.add(class_of_hit(v.state), technique::hit, hit_environment(path_, bidirectional_, v, subpath_),
                v.state.dispersed);
  }

 private:
  // Merging alone leaves to the walk what no photon can bring: light seen directly or through delta scatterings.
  bool hits_count(const WalkState& state) const { return pass_.switches.connections || state.non_delta == 0; }

  template <class Vertex>
  void connect_all(const Vertex& v) {
    const int eye_vertices = v.state.depth + 1;
    if (pass_.shows({1, eye_vertices})) {
      const DirectLight direct = next_event(path_, bidirectional_, v, subpath_);
      layers_.add(class_of_next_event(v.state), technique::nee, direct.radiance, direct.dispersed);
    }
    for (const LightVertex& other : pass_.vertices.path(light_path_)) {
      if (v.state.depth + other.depth > pass_.job.settings.max_depth) continue;
      if (!pass_.shows({other.depth + 1, eye_vertices})) continue;
      const DirectLight light =
          connect(path_, bidirectional_, v, subpath_, other, pass_.vertices.trail(light_path_, other));
      layers_.add(PathClass::indirect, technique::vc, light.radiance, light.dispersed);
    }
  }

  void merge(const SurfaceVertex& v) {
    const float support2 = support_ * support_;
    const bool dispersed = v.state.dispersed || is_dispersive(v.at.bsdf);
    pass_.merge_map.for_each_near(v.at.position, support_, [&](const MergePhoton& photon, const Point& p, float dist2) {
      if (v.state.depth + photon.depth - 1 > pass_.job.settings.max_depth) return;
      if (std::fabs(dot(p - v.at.position, v.at.normal)) > search_flatness * support_) return;
      const std::optional<PhotonHit> hit = hit_by_photon(v, photon.wi);
      if (!hit) return;
      const Vec3& wo = hit->wo_local;
      const float weight = weight_of(photon, pdf(v.at.bsdf, v.wi_local, wo), pdf_reverse(v.at.bsdf, v.wi_local, wo));
      const Spectrum light =
          v.state.beta * hit->f * photon.power * (weight * pass_.kernel.weight(dist2, support2) * hit->ratio);
      layers_.add(class_of_merge(v.state, photon), technique::vm, light, dispersed || photon.dispersed);
    });
  }
  float weight_of(const MergePhoton& photon, float forward, float reverse) const {
    const Techniques& t = bidirectional_.techniques;
    return t.correlated() ? weight_of_merged(subpath_.trail(), pass_.merge_map.trail(photon), forward, reverse, t,
                                             subpath_.first_distance())
                          : weight_merge(subpath_.densities(), photon.densities, forward, reverse, t);
  }
  static PathClass class_of_merge(const WalkState& state, const MergePhoton& photon) {
    if (state.non_delta > 0) return PathClass::indirect;
    if (photon.depth == 1) return PathClass::direct;
    return photon.caustic ? PathClass::caustic : PathClass::indirect;
  }

  const PathContext& path_;
  const Pass& pass_;
  const Bidirectional bidirectional_;
  const float support_;  // of merges
  std::size_t light_path_;
  LightLayers& layers_;
  Subpath subpath_;
};

std::optional<Strategy> parse_strategy(const std::string& text) {
  if (text == "all") return {};
  Strategy strategy;
  int read = 0;
  if (std::sscanf(text.c_str(), "%3d,%3d%n", &strategy.s, &strategy.t, &read) != 2 ||
      read != static_cast<int>(text.size()) || strategy.s < 0 || strategy.t < 1 || strategy.s + strategy.t < 2)
    throw Error(
        fmt::format("--set strategy={}: expected all, or S,T: at least 0 vertices of the light walk, 1 of the eye's "
                    "and 2 of both",
                    text));
  return strategy;
}

class VertexConnectionAndMerging final : public Integrator {
 public:
  VertexConnectionAndMerging(const Parameters& parameters, Switches switches)
      : switches_(switches), roulette_depth_(static_cast<int>(parameters.number("roulette-depth", 1, 1e6))) {
    if (!switches.merging) {
      only_ = parse_strategy(parameters.text("strategy"));
      return;
    }
    emission_choice_ = emission_choice(parameters);
    alpha_ = parameters.number("alpha", 1e-3, 1);
    radius_choice_ = RadiusChoice::from(parameters);
    correlation_ = choice<Correlation, 3>(parameters, "mis",
                                          {{{"balance", Correlation::ignored},
                                            {"correlation", Correlation::chances},
                                            {"footprint", Correlation::footprints}}});
  }

  FilmContents film_contents() const override {
    return {path_class_names(), technique::decomposition(), switches_.connections};
  }
  MemoryUse memory_use(const RenderSettings&) const override {
    constexpr double spare = 1.25;  // of vectors that grow; measured: 1.02
    const double trail = correlation_ == Correlation::ignored ? 0 : sizeof(TrailVertex) + sizeof(void*);
    const double merged = switches_.merging ? bytes_per_photon : 0;
    return {spare * (sizeof(LightVertex) + trail) + merged, bytes_per_light_path, sizeof(float), 1};
  }
  void prepare(const RenderJob& job) override {
    emission_probability_ = emission_probabilities(job.scene);
    if (!switches_.merging) return;
    guide_ = choose_emission(emission_choice_, PhotonUse::indirect, job);
    constexpr double photons_of_first_merge = 16;
    first_radius_ = choose_first_radius(job, radius_choice_, photons_of_first_merge, guide());
  }
  bool passes_share_wavelengths() const override { return true; }
  PassReport render_pass(const RenderJob& job, std::uint32_t pass, Film& film, const PhaseObserver& begin) override;

 private:
  RayCounts trace_light_paths(const Pass& pass, const LightPaths& paths, const PathDraw& draw, Film& film);

  const EmissionGuide* guide() const { return guide_ ? &*guide_ : nullptr; }

  Switches switches_;
  std::optional<Strategy> only_;
  EmissionChoice emission_choice_ = EmissionChoice::power;
  std::optional<EmissionGuide> guide_;
  int roulette_depth_;
  double alpha_ = 1;
  RadiusChoice radius_choice_;
  Correlation correlation_ = Correlation::ignored;
  FirstRadius first_radius_;
  std::vector<float> emission_probability_;
  LightVertices vertices_;
};

RayCounts VertexConnectionAndMerging::trace_light_paths(const Pass& pass, const LightPaths& paths, const PathDraw& draw,
                                                        Film& film) {
  vertices_.begin(paths.chunk_count());
  const WalkLimits limits{.max_depth = pass.job.settings.max_depth};
  return paths.for_each([&](const LightPath& start, Sampler& sampler, RayCounts& counts, std::size_t c) {
    LightVertices::Chunk& chunk = vertices_.chunk(c);
    const PathContext path{pass.job.scene, draw.w, sampler, counts, limits};
    walk_from_light(path, start, draw.time, LightVisitor(path, pass, start.index, film, chunk));
    chunk.ends.push_back(static_cast<std::uint32_t>(chunk.vertices.size()));
  });
}

PassReport VertexConnectionAndMerging::render_pass(const RenderJob& job, std::uint32_t number, Film& film,
                                                   const PhaseObserver& begin) {
  const PathDraw draw = draw_for_pass(job, number);
  begin(Phase::photons);
  const LightPaths paths(job.scene, {job.settings.seed, Stream::light, number, job.settings.photons, guide()});
  const auto light_paths = static_cast<float>(paths.total());
  MergeMap merge_map;
  const Kernel kernel{KernelShape::epanechnikov};
  const float shrink = RadiusSchedule{1, alpha_}.radius(number);
  const Techniques techniques{
      .light_paths = light_paths, .connects = switches_.connections, .correlation = correlation_};
  const Pass pass{job,       {job.view, techniques, emission_probability_},
                  switches_, only_,
                  vertices_, merge_map,
                  kernel,    first_radius_,
                  shrink};
  PassReport report;
  report.rays = trace_light_paths(pass, paths, draw, film);
  report.light_paths = paths.total();
  if (switches_.merging) {
    begin(Phase::build);
    merge_map = MergeMap(vertices_, techniques.connects ? 2 : 1, kernel.support(first_radius_.largest() * shrink));
    report.photons_stored = merge_map.size();
    report.photon_map_bytes = merge_map.memory_bytes();
    report.radius = first_radius_.typical() * shrink;
  }
  begin(Phase::eye);
  report.rays +=
      trace_eye_paths(job, {number, {job.settings.max_depth, roulette_depth_}, &draw}, film,
                      [&](const PathContext& path, const EyeStart& start, const PixelPlace&, LightLayers& layers) {
                        path.sampler.seek(1);
                        const auto light_path = std::min(static_cast<std::size_t>(path.sampler.next() * light_paths),
                                                         std::max(paths.total(), std::size_t{1}) - 1);
                        std::vector<TrailVertex> trail;
                        walk_from_camera(path, start.camera, job.view.medium,
                                         EyeVisitor(path, pass, start.raster, light_path, layers, trail));
                      });
  return report;
}

const ParameterInfo roulette_depth{"roulette-depth", "3",
                                   "scattering event from which Russian roulette may end an eye path, from 1"};
const ParameterInfo strategy{"strategy", "all",
                             "all, or S,T: only light of paths with S vertices made from the light and T from the eye"};
const ParameterInfo mis{
    "mis", "balance",
    "balance heuristic, or the same that knows that merges share light paths: correlation (by chances; Grittmann et "
    "al. 2021), footprint (Jendersie 2019)"};

// Every light vertex costs a connection to the lens and one to an eye path: more of them than pixels do not pay.
constexpr std::uint64_t fewest_light_paths = 10'000;

template <bool connections, bool merging>
std::unique_ptr<Integrator> make(const Parameters& p) {
  return std::make_unique<VertexConnectionAndMerging>(p, Switches{connections, merging});
}

}  // namespace

IntegratorInfo vcm_info() {
  return {"vcm",
          "vertex connection and merging: bidirectional paths and photons under one weight; all kinds of light",
          "Georgiev et al. 2012; Hachisuka et al. 2012",
          {radius_reduction_info("0.5"), first_radius_info, mis, roulette_depth, emission_info("power")},
          make<true, true>,
          fewest_light_paths};
}

IntegratorInfo bdpt_info() {
  return {"bdpt",
          "bidirectional path tracing: unbiased; caustics, but not their reflections from small lights",
          "Veach 1997; Lafortune & Willems 1993",
          {strategy, roulette_depth},
          make<true, false>,
          fewest_light_paths};
}

IntegratorInfo bpm_info() {
  return {"bpm",
          "bidirectional photon mapping: photons merged at every vertex of the eye path",
          "Vorba 2011; Georgiev et al. 2012",
          {radius_reduction_info("0.75"), first_radius_info, mis, roulette_depth, emission_info("power")},
          make<false, true>};
}

}  // namespace lanthorn
