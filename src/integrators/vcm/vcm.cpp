// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Vertex connection and merging (Georgiev, Křivánek, Davidovič & Slusallek 2012; Hachisuka, Pantaleoni & Jensen 2012)
// and its two halves: bidirectional path tracing (Veach 1997, chapter 10) connects vertices, bidirectional photon
// mapping merges them. One algorithm; the techniques are switched. A pass traces its light paths, splats each of their
// vertices through the lens, keeps them, and lets each eye path be connected to one light path and merge with all.
// Every contribution has the weight of the balance heuristic (Veach 1997, eq. 9.8), recursively (path/mis.h; "TR" is
// Georgiev's technical report of 2012).
#include <algorithm>
#include <optional>
#include <vector>

#include "integrators/integrator.h"
#include "integrators/vcm/vcm_pass.h"
#include "path/connections.h"
#include "path/eye_pass.h"
#include "path/light_layers.h"
#include "path/path_draw.h"
#include "path/splat.h"
#include "photon/kernels.h"
#include "photon/medium_records.h"
#include "photon/photon_hit.h"
#include "photon/photon_pass.h"
#include "photon/pilot_radius.h"
#include "photon/radius_schedule.h"

namespace lanthorn {

namespace {

// Keeps the vertices of a light path and splats them through the lens.
class LightVisitor {
 public:
  LightVisitor(const PathContext& path, const VcmPass& pass, std::uint32_t light, float time, Film& film,
               LightVertices::Chunk& chunk)
      : path_(path),
        pass_(pass),
        light_(light),
        time_(time),
        film_(film),
        chunk_(chunk),
        subpath_(pass.bidirectional.techniques) {}

  void operator()(const EmissionSample& emission) {
    keeps_beams_ = pass_.beam_share > 0 && keeps_beams(path_.sampler, pass_.beam_share);
    subpath_.begin_at_light(light_, emission, pass_.bidirectional.emission);
  }
  Continuation operator()(const SurfaceVertex& v) {
    subpath_.arrive(path_, v);
    if (v.may_scatter && has_non_delta(v.at.bsdf)) keep(v);
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& v) {
    subpath_.arrive(path_, v);
    if (v.may_scatter) keep(v);
    return Continuation::go_on();
  }
  void operator()(const FlownSegment& flight) {
    if (flight.state.medium == MediumId::vacuum) return;
    if (keeps_beams_ && flight.state.depth < pass_.job.settings.max_depth) keep_beam(flight);
    subpath_.fly(flight);
  }
  void operator()(const EscapeVertex&) {}

 private:
  void keep_beam(const FlownSegment& flight) {
    const WalkState& state = flight.state;
    const Segment& way = flight.segment;
    const float length =
        scattering_length(path_.scene.medium(state.medium), {way.origin, way.direction, flight.reach}, path_.w);
    if (!(length > 0)) return;
    const int depth = state.depth + 1;
    chunk_.beams.push_back({way.origin, way.direction, length, time_, state.medium, state.beta / pass_.beam_share,
                            subpath_.depart(flight), subpath_.start(), depth, depth > 1 && state.non_delta == 0,
                            state.dispersed});
  }
  template <class Vertex>
  void keep(const Vertex& v) {
    chunk_.vertices.push_back(keep_vertex(v, subpath_));
    const float flux = flux_of(v.state.beta, v.state.dispersed, path_.w);
    const int flux_class = pass_.first_radius.classes().of(flux * pass_.bidirectional.techniques.light_paths);
    chunk_.vertices.back().flux_class = static_cast<std::uint8_t>(flux_class);
    if (!pass_.switches.connections || !pass_.shows({v.state.depth + 1, 1})) return;
    const View& view = pass_.job.view;
    if (const auto seen = connect_to_lens(path_, view, v, &film_))
      splat(film_, view, path_.w, *seen, layers_of_splat(v),
            weight_of_seen(pass_.bidirectional_at(seen->raster), v, subpath_, *seen));
  }

  const PathContext& path_;
  const VcmPass& pass_;
  std::uint32_t light_;
  float time_;
  bool keeps_beams_ = false;
  Film& film_;
  LightVertices::Chunk& chunk_;
  Subpath subpath_;
};

// Finds the light of an eye path by all techniques but the lens.
class EyeVisitor {
 public:
  EyeVisitor(const PathContext& path, const VcmPass& pass, const Vec2& raster, std::size_t light_path,
             LightLayers& layers)
      : path_(path),
        pass_(pass),
        bidirectional_(pass.bidirectional_at(raster)),
        raster_(raster),
        light_path_(light_path),
        layers_(layers),
        subpath_(pass.bidirectional.techniques) {
    subpath_.begin_at_lens(pass.job.view.camera);
  }

  Continuation operator()(const SurfaceVertex& v) {
    layers_.see(v);
    subpath_.arrive(path_, v);
    if (hits_count(v.state) && pass_.shows({0, v.state.depth + 1}))
      layers_.add_hit(v, hit_emitter(path_, bidirectional_, v, subpath_), technique::hit);
    if (!v.may_scatter) return Continuation::stop();
    if (has_non_delta(v.at.bsdf)) {
      if (pass_.switches.connections) connect_all(v);
      if (pass_.switches.merging && merges_at(v.at)) merge(v);
    }
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& v) {
    layers_.see(v);
    subpath_.arrive(path_, v);
    if (!v.may_scatter) return Continuation::stop();
    if (pass_.switches.connections) connect_all(v);
    if (pass_.volume_merges && subpath_.coherence() > 0) pass_.volume_merges->add_at(volume_context(), v);
    return Continuation::go_on();
  }
  void operator()(const FlownSegment& flight) {
    if (flight.state.medium == MediumId::vacuum) return;
    layers_.see(flight);
    if (pass_.volume_merges) {
      subpath_.depart(flight);
      if (subpath_.coherence() > 0) pass_.volume_merges->add_along(volume_context(), flight);
    }
    subpath_.fly(flight);
  }
  void operator()(const EmissionVertex& v) {
    const bool is_light = path_.scene.volume_light(v.state.medium).has_value();
    if ((is_light && !hits_count(v.state)) || !pass_.shows({0, v.state.depth + 2})) return;
    layers_.add_hit(v, hit_glow(path_, bidirectional_, v, subpath_), technique::hit);
  }
  void operator()(const EscapeVertex& v) {
    if (!hits_count(v.state) || !pass_.shows({0, v.state.depth + 2})) return;
    subpath_.escape(v.state, v.direction);
    layers_.add_hit(v, hit_environment(path_, bidirectional_, v, subpath_), technique::hit);
  }

 private:
  // Merging alone leaves to the walk what no photon can bring: light seen directly or through delta scatterings.
  bool hits_count(const WalkState& state) const { return pass_.switches.connections || state.non_delta == 0; }

  VolumeMergeContext volume_context() const {
    return {path_, bidirectional_.techniques, subpath_, pass_.job.settings.max_depth, layers_};
  }

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
      const DirectLight light = connect(path_, bidirectional_, v, subpath_, other);
      layers_.add(PathClass::indirect, technique::vc, light.radiance, light.dispersed);
    }
  }

  void merge(const SurfaceVertex& v) {
    for (std::size_t c = 0; c < pass_.merge_maps.size(); ++c)
      merge(v, pass_.merge_maps[c], pass_.kernel.support(pass_.radius_at(raster_, static_cast<int>(c))));
  }
  // All classes have the weights of the first one's radius: those of a path's techniques sum to one.
  void merge(const SurfaceVertex& v, const MergeMap& map, float support) {
    const float support2 = support * support;
    const bool dispersed = v.state.dispersed || is_dispersive(v.at.bsdf);
    map.for_each_near(v.at.position, support, [&](const MergePhoton& photon, const Point& p, float dist2) {
      if (v.state.depth + photon.depth - 1 > pass_.job.settings.max_depth) return;
      const float height = dot(p - v.at.position, v.at.normal);
      if (std::fabs(height) > search_flatness * support) return;
      if (comes_from_behind(height, dot(photon.wi, v.at.normal), photon.distance, support)) return;
      const std::optional<PhotonHit> hit = hit_by_photon<true>(v, photon.wi);
      if (!hit) return;
      const Techniques& t = bidirectional_.techniques;
      const float weight =
          weight_merge({subpath_.densities(), hit->pdf_reverse},
                       {photon.densities, hit->pdf, subpath_.coherence_beyond()}, t.merging, t.merging, t);
      const Spectrum light =
          v.state.beta * hit->f * photon.power * (weight * pass_.kernel.weight(dist2, support2) * hit->ratio);
      layers_.add(class_of_merge(v.state, photon.depth, photon.caustic), technique::vm, light,
                  dispersed || photon.dispersed);
    });
  }

  const PathContext& path_;
  const VcmPass& pass_;
  const Bidirectional bidirectional_;
  const Vec2 raster_;
  std::size_t light_path_;
  LightLayers& layers_;
  Subpath subpath_;
};

class VertexConnectionAndMerging final : public Integrator {
 public:
  explicit VertexConnectionAndMerging(const VcmSettings& settings) : settings_(settings) {}

  FilmContents film_contents(const Scene& scene) const override { return settings_.film_contents(scene); }
  MemoryUse memory_use(const RenderSettings&) const override { return settings_.memory_use(); }
  void prepare(const RenderJob& job) override {
    if (settings_.switches.merging) emission_ = choose_emission(settings_.emission, settings_.photon_use(), job);
    emission_densities_.emplace(job.scene, emission_.starts());
    if (!settings_.switches.merging) return;
    constexpr double photons_of_first_merge = 16;
    // Where connections share the light, what few photons bring is theirs: equal discs have less noise.
    const bool by_flux = !settings_.switches.connections;
    // Paths have the radius of the place on the film that they go through, which may lie beside the window.
    View reach = job.view;
    reach.window = radius_window_ = job.view.filter_reach();
    first_radius_ = choose_first_radius({job.scene, reach, job.settings}, settings_.radius, photons_of_first_merge,
                                        emission_.get(), by_flux);
    volume_radii_ = VolumeRadii(job, settings_, kernel, emission_.get());
  }
  std::string limitation(const Scene& scene) const override {
    if (settings_.switches.connections || settings_.merges_in_media() || !scene.has_scattering_media()) return {};
    return "without merging in media (volume=beam), none of the light that they scatter is found";
  }
  std::string remark() const override { return emission_.remark; }
  bool passes_share_wavelengths() const override { return true; }
  PassReport render_pass(const RenderJob& job, std::uint32_t pass, Film& film, const PhaseObserver& begin) override;

 private:
  RayCounts trace_light_paths(const VcmPass& pass, const LightPaths& paths, const PassDraw& draw, Film& film);
  std::vector<MergeMap> build_merge_maps(float support, PassReport& report) const;
  std::optional<VolumeMerges> build_volume_merges(const VolumeKernels& kernels, PassReport& report) const;

  VcmSettings settings_;
  Emission emission_;
  FirstRadius first_radius_;
  PixelWindow radius_window_;
  VolumeRadii volume_radii_;
  static constexpr Kernel kernel{KernelShape::epanechnikov};
  std::optional<EmissionDensities> emission_densities_;
  LightVertices vertices_;
};

RayCounts VertexConnectionAndMerging::trace_light_paths(const VcmPass& pass, const LightPaths& paths,
                                                        const PassDraw& draw, Film& film) {
  vertices_.begin(paths.chunk_count());
  const WalkLimits limits{.max_depth = pass.job.settings.max_depth};
  return paths.for_each([&](const LightPath& start, Sampler& sampler, RayCounts& counts, std::size_t c) {
    LightVertices::Chunk& chunk = vertices_.chunk(c);
    const PathContext path{pass.job.scene, draw.w, sampler, counts, limits};
    const float time = draw.of_path(sampler).time;
    walk_from_light(path, start, time, LightVisitor(path, pass, start.index, time, film, chunk));
    chunk.ends.push_back(static_cast<std::uint32_t>(chunk.vertices.size()));
  });
}

// By class. `support`: of the first one, m.
std::vector<MergeMap> VertexConnectionAndMerging::build_merge_maps(float support, PassReport& report) const {
  std::vector<MergeMap> maps;
  for (int c = 0; c < first_radius_.classes().count(); ++c) {
    const MergeMap& map = maps.emplace_back(vertices_, settings_.switches.connections ? 2 : 1,
                                            support * FluxClasses::radius_factor(c), c);
    report.photons_stored += map.size();
    report.photon_map_bytes += map.memory_bytes();
  }
  return maps;
}

std::optional<VolumeMerges> VertexConnectionAndMerging::build_volume_merges(const VolumeKernels& kernels,
                                                                            PassReport& report) const {
  std::optional<VolumeMerges> merges;
  if (!kernels.any()) return merges;
  merges.emplace(vertices_, kernels);
  report.photons_stored += merges->size();
  report.photon_map_bytes += merges->memory_bytes();
  report.volume_radius = kernels.widest_radius();
  return merges;
}

PassReport VertexConnectionAndMerging::render_pass(const RenderJob& job, std::uint32_t number, Film& film,
                                                   const PhaseObserver& begin) {
  const PassDraw draw = draw_for_pass(job, number);
  begin(Phase::photons);
  const LightPaths paths(job.scene,
                         {job.settings.seed, Stream::light, number, job.settings.photons, emission_.starts()});
  const auto light_paths = static_cast<float>(paths.total());
  std::vector<MergeMap> merge_maps;
  const float shrink = RadiusSchedule{1, settings_.alpha}.radius(number);
  const VolumeKernels volume_kernels = volume_radii_.kernels(settings_.alpha, number);
  const float beam_share = volume_kernels.uses_beams() ? share_of_beams(paths.total()) : 0.0f;
  const Techniques techniques{.light_paths = light_paths,
                              .connects = settings_.switches.connections,
                              .volume = volume_kernels.merging(light_paths, beam_share)};
  std::optional<VolumeMerges> volume_merges;
  const VcmPass pass{job,
                     {job.view, techniques, *emission_densities_},
                     settings_.switches,
                     settings_.only,
                     vertices_,
                     merge_maps,
                     volume_merges,
                     beam_share,
                     kernel,
                     first_radius_,
                     radius_window_,
                     shrink};
  PassReport report;
  report.rays = trace_light_paths(pass, paths, draw, film);
  report.light_paths = paths.total();
  if (settings_.switches.merging) {
    begin(Phase::build);
    const float support = kernel.support(first_radius_.largest() * shrink);
    merge_maps = build_merge_maps(support, report);
    volume_merges = build_volume_merges(volume_kernels, report);
    report.radius = first_radius_.typical() * shrink;
  }
  begin(Phase::eye);
  const auto light_path_of = [&](Sampler& sampler) {
    sampler.seek(1);
    return std::min(static_cast<std::size_t>(sampler.next() * light_paths),
                    std::max(paths.total(), std::size_t{1}) - 1);
  };
  // An eye path has the time of the light path that it is connected to.
  const auto draw_eye_path = [&](Sampler& sampler) {
    if (draw.is_of_one_time()) return draw.of_path(sampler);
    const std::span<const LightVertex> partner = vertices_.path(light_path_of(sampler));
    return partner.empty() ? draw.of_path(sampler) : PathDraw{partner.front().at.time, draw.w};
  };
  report.rays += trace_eye_paths(
      job, {number, {job.settings.max_depth, settings_.roulette_depth}}, film, draw_eye_path,
      [&](const PathContext& path, const EyeStart& start, const PixelPlace&, LightLayers& layers) {
        const std::size_t light_path = light_path_of(path.sampler);
        vertices_.prefetch(light_path);
        walk_from_camera(path, start.camera, job.view.medium, EyeVisitor(path, pass, start.raster, light_path, layers));
      });
  return report;
}

}  // namespace

std::unique_ptr<Integrator> make_vertex_connection_and_merging(const VcmSettings& settings) {
  return std::make_unique<VertexConnectionAndMerging>(settings);
}

}  // namespace lanthorn
