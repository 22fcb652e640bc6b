// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Vertex connection and merging (Georgiev, Křivánek, Davidovič & Slusallek 2012; Hachisuka, Pantaleoni & Jensen 2012)
// and its two halves: bidirectional path tracing (Veach 1997, chapter 10) connects vertices, bidirectional photon
// mapping merges them. One algorithm; the techniques are switched. "TR" is Georgiev's technical report of 2012,
// "Implementing Vertex Connection and Merging".
//
// A pass has three steps:
// 1. Trace N light paths. Keep each vertex, and connect it to the lens.
// 2. Sort the vertices into maps for merging.
// 3. Trace an eye path for each pixel. At each of its vertices, count the light that it hits, and gather light by
//    next-event estimation, by connections to the vertices of one light path, and by merging with those of all.
//
// Each has the weight of the balance heuristic, w = 1 / (w_light + 1 + w_eye) (TR eq. 37). path/mis.h derives both
// terms from sums that both kinds of walk carry from vertex to vertex, d_VCM, d_VC and d_VM (TR eqs. 31-36): `Subpath`.
#include <memory>
#include <optional>
#include <string>

#include "integrators/integrator.h"
#include "integrators/vcm/vcm_pass.h"
#include "path/connections.h"
#include "path/eye_pass.h"
#include "path/light_layers.h"
#include "path/splat.h"
#include "photon/photon_pass.h"

namespace lanthorn {

namespace {

// Step 1: keeps the vertices of a light path and connects them to the lens.
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

  // The path starts (TR eqs. 31-33).
  void operator()(const EmissionSample& emission) {
    keeps_beams_ = pass_.beam_share > 0 && keeps_beams(path_.sampler, pass_.beam_share);
    subpath_.begin_at_light(light_, emission, pass_.bidirectional.emission);
  }
  // It has come to a vertex (TR eqs. 34-36; through delta lobes eqs. 53-55).
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
    if (keeps_beams_ && flight.state.depth < pass_.max_depth())
      if (auto beam = keep_beam(path_, flight, time_, pass_.beam_share, subpath_)) chunk_.beams.push_back(*beam);
    subpath_.fly(flight);
  }
  void operator()(const EscapeVertex&) {}

 private:
  // Keeps the vertex, and connects it to the lens (TR eqs. 46, 47).
  template <class Vertex>
  void keep(const Vertex& v) {
    LightVertex& kept = chunk_.vertices.emplace_back(keep_vertex(v, subpath_));
    kept.flux_class = pass_.class_of_flux(flux_of(v.state.beta, v.state.dispersed, path_.w));
    if (!pass_.connects() || !pass_.shows(v.state.depth + 1, 1)) return;
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

// Step 3: finds the light of an eye path by all techniques but the lens.
class EyeVisitor {
 public:
  // The path starts (TR eqs. 31-33).
  EyeVisitor(const PathContext& path, const VcmPass& pass, const Vec2& raster, std::size_t partner, LightLayers& layers)
      : path_(path),
        pass_(pass),
        bidirectional_(pass.bidirectional_at(raster)),
        raster_(raster),
        partner_(partner),
        layers_(layers),
        subpath_(pass.bidirectional.techniques) {
    subpath_.begin_at_lens(pass.job.view.camera);
  }

  // It has come to a vertex (TR eqs. 34-36; through delta lobes eqs. 53-55).
  Continuation operator()(const SurfaceVertex& v) {
    layers_.see(v);
    subpath_.arrive(path_, v);
    if (hits_count(v.state) && pass_.shows(0, v.state.depth + 1))
      layers_.add_hit(v, hit_emitter(path_, bidirectional_, v, subpath_), technique::hit);
    if (!v.may_scatter) return Continuation::stop();
    if (has_non_delta(v.at.bsdf)) {
      if (pass_.connects()) connect_all(v);
      if (pass_.surface_merges && merges_at(v.at)) merge(v);
    }
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& v) {
    layers_.see(v);
    subpath_.arrive(path_, v);
    if (!v.may_scatter) return Continuation::stop();
    if (pass_.connects()) connect_all(v);
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
  // It hits a light (TR eqs. 42, 43).
  void operator()(const EmissionVertex& v) {
    const bool is_light = path_.scene.volume_light(v.state.medium).has_value();
    if ((is_light && !hits_count(v.state)) || !pass_.shows(0, v.state.depth + 2)) return;
    layers_.add_hit(v, hit_glow(path_, bidirectional_, v, subpath_), technique::hit);
  }
  void operator()(const EscapeVertex& v) {
    if (!hits_count(v.state) || !pass_.shows(0, v.state.depth + 2)) return;
    subpath_.escape(v.state, v.direction);
    layers_.add_hit(v, hit_environment(path_, bidirectional_, v, subpath_), technique::hit);
  }

 private:
  // Merging alone leaves to the walk what no photon can bring: light seen directly or through delta scatterings.
  bool hits_count(const WalkState& state) const { return pass_.connects() || state.non_delta == 0; }

  // Next-event estimation (TR eqs. 44, 45), and vertex connection (TR eqs. 40, 41).
  template <class Vertex>
  void connect_all(const Vertex& v) {
    const int eye_vertices = v.state.depth + 1;
    if (pass_.shows(1, eye_vertices)) {
      const DirectLight direct = next_event(path_, bidirectional_, v, subpath_);
      layers_.add(class_of_next_event(v.state), technique::nee, direct.radiance, direct.dispersed);
    }
    for (const LightVertex& other : pass_.vertices.path(partner_)) {
      if (v.state.depth + other.depth > pass_.max_depth() || !pass_.shows(other.depth + 1, eye_vertices)) continue;
      const DirectLight light = connect(path_, bidirectional_, v, subpath_, other);
      layers_.add(PathClass::indirect, technique::vc, light.radiance, light.dispersed);
    }
  }

  // Vertex merging (TR eqs. 38, 39): a density estimate of the radiance from the photons (Georgiev et al. 2012, eq.
  // 10), with a weight for each. Photons of all classes of flux have the weights of the first class's radius, so that
  // those of a path's techniques sum to one.
  void merge(const SurfaceVertex& v) {
    const GatherVertex gather(v);
    const Techniques& t = bidirectional_.techniques;
    const auto add = [&](const MergePhoton& photon, const PhotonHit& hit, float density, float bias_share) {
      const SubpathEnd at_eye{subpath_.densities(), hit.pdf_reverse};
      const SubpathEnd at_light{photon.densities, hit.pdf, subpath_.coherence_beyond()};
      const float weight = weight_merge(at_eye, at_light, t.merging, t.merging, t);
      const Spectrum light = v.state.beta * hit.f * photon.power * (weight * density * hit.ratio);
      const bool is_dispersed = gather.is_dispersed(photon.dispersed);
      layers_.add(class_of_merge(v.state, photon.depth, photon.caustic), technique::vm, light, is_dispersed);
      layers_.add_bias(bias_share * light, is_dispersed);
    };
    pass_.surface_merges->for_each_at(gather, raster_, pass_.max_depth(), add);
  }
  VolumeMergeContext volume_context() const {
    return {path_, bidirectional_.techniques, subpath_, pass_.max_depth(), layers_};
  }

  const PathContext& path_;
  const VcmPass& pass_;
  const Bidirectional bidirectional_;
  const Vec2 raster_;
  std::size_t partner_;
  LightLayers& layers_;
  Subpath subpath_;
};

RayCounts trace_light_paths(const VcmPass& pass, Film& film) {
  pass.vertices.begin(pass.light_paths.chunk_count());
  const WalkLimits limits{.max_depth = pass.max_depth()};
  return pass.light_paths.for_each([&](const LightPath& start, Sampler& sampler, RayCounts& counts, std::size_t c) {
    LightVertices::Chunk& chunk = pass.vertices.chunk(c);
    const PathContext path{pass.job.scene, pass.draw.w, sampler, counts, limits};
    const float time = pass.draw.of_path(sampler).time;
    walk_from_light(path, start, time, LightVisitor(path, pass, start.index, time, film, chunk));
    chunk.ends.push_back(static_cast<std::uint32_t>(chunk.vertices.size()));
  });
}

RayCounts trace_eye_paths(const VcmPass& pass, Film& film) {
  return trace_eye_paths(
      pass.job, {pass.number, {pass.max_depth(), pass.settings.roulette_depth}}, film,
      [&](Sampler& sampler) { return pass.draw_of_eye_path(sampler); },
      [&](const PathContext& path, const EyeStart& start, const PixelPlace&, LightLayers& layers) {
        const std::size_t partner = pass.partner(path.sampler);
        pass.vertices.prefetch(partner);
        walk_from_camera(path, start.camera, pass.job.view.medium,
                         EyeVisitor(path, pass, start.raster, partner, layers));
      });
}

class VertexConnectionAndMerging final : public Integrator {
 public:
  explicit VertexConnectionAndMerging(const VcmSettings& settings) : settings_(settings) {}

  FilmContents film_contents(const Scene& scene) const override { return settings_.film_contents(scene); }
  MemoryUse memory_use(const RenderSettings&) const override { return settings_.memory_use(); }
  std::string limitation(const Scene& scene) const override { return settings_.limitation(scene); }
  std::string remark() const override { return prepared_ ? prepared_->emission.remark : std::string(); }
  bool passes_share_wavelengths() const override { return true; }
  void prepare(const RenderJob& job) override { prepared_.emplace(job, settings_); }

  PassReport render_pass(const RenderJob& job, std::uint32_t number, Film& film, const PhaseObserver& begin) override {
    begin(Phase::photons);
    VcmPass pass(job, number, settings_, *prepared_, vertices_);
    PassReport report;
    report.light_paths = pass.light_paths.total();
    report.rays = trace_light_paths(pass, film);
    if (settings_.switches.merging) {
      begin(Phase::build);
      pass.build_merges(report);
    }
    begin(Phase::eye);
    report.rays += trace_eye_paths(pass, film);
    return report;
  }

 private:
  VcmSettings settings_;
  std::optional<VcmPreparation> prepared_;
  LightVertices vertices_;  // their memory serves all passes
};

}  // namespace

std::unique_ptr<Integrator> make_vertex_connection_and_merging(const VcmSettings& settings) {
  return std::make_unique<VertexConnectionAndMerging>(settings);
}

}  // namespace lanthorn
