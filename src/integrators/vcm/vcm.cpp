// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Vertex connection and merging (Georgiev, Křivánek, Davidovič & Slusallek 2012; Hachisuka, Pantaleoni & Jensen 2012)
// and its two halves: bidirectional path tracing (Veach 1997, chapter 10) connects vertices, bidirectional photon
// mapping merges them. One algorithm; the techniques are switched. "TR" is Georgiev's technical report of 2012,
// "Implementing Vertex Connection and Merging".
//
// The files in the order in which a pass goes through them:
// 0. vcm_pass.cpp           what passes share: radii (merge_radii.h), the effort of each region of the picture (for
//                           `auto` integrators/auto chooses it), the choice of lights (path/emission_densities.h)
// 1. path/light_pass.h      N light paths, each a walk (path/walk.h) with the visitor
//    light_visitor.h        `LightVisitor`: keeps each vertex, and connects it to the lens,
//    path/lens_connection.h f |cos| W_e V / p                                                      (weight: TR eq. 46)
// 2. merge_map.h            sorts the vertices into maps for merging; in media photon/media/volume_map.h
// 3. path/eye_pass.h        an eye path for each pixel, with the visitor
//    eye_visitor.h          `EyeVisitor`: at each vertex the techniques
//    path/connections.h     hits of lights (TR eq. 43), next-event estimation (TR eqs. 44, 45), and connections to the
//                           vertices of a light path, f_eye G V f_light (TR eqs. 40, 41)
//    merge_map.h            merges with all photons nearby, f / (N pi r^2) (TR eqs. 38, 39); in media volume_merge.h
// 4. path/light_layers.h    sums by class of path; film/film.h adds them, and path/lens_connection.h what light
//                           paths found
//
// Each technique has the weight of the balance heuristic, w = 1 / (w_light + 1 + w_eye) (TR eq. 37). path/mis.h derives
// both terms from sums that both kinds of walk carry from vertex to vertex, d_VCM, d_VC and d_VM (TR eqs. 31-36):
// path/subpath.h.
#include <concepts>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/pool.h"
#include "integrators/integrator.h"
#include "integrators/vcm/eye_visitor.h"
#include "integrators/vcm/light_visitor.h"
#include "integrators/vcm/vcm_pass.h"
#include "path/eye_pass.h"
#include "path/lens_connection.h"
#include "path/radiance_along.h"

namespace lanthorn {

namespace {

RayCounts trace_light_paths(const VcmPass& pass, const FilmPass& film) {
  const View& view = pass.job.view;
  return trace_light_paths(
      pass, &film, [&](const LightArrival& light, const LensLight& seen, const PlaceEffort& there, std::size_t) {
        const Bidirectional here = pass.bidirectional_at(seen.raster, there);
        splat(film, view, light.w, seen, light.layers, light.densities(here, seen).weight(here.techniques));
      });
}

RayCounts trace_eye_paths(const VcmPass& pass, PartialLight& partial, const FilmPass& film) {
  return trace_eye_paths(
      pass.job, {pass.number, {pass.max_depth(), pass.settings.roulette_depth}, &partial}, film,
      [&](Sampler& sampler, const PixelPlace& place) { return pass.draw_of_eye_path(sampler, place); },
      [&](const PathContext& path, const EyeStart& start, const PixelPlace&, LightLayers& layers) {
        walk_from_camera(path, start.camera, pass.job.view.medium, EyeVisitor(path, pass, start.raster, layers));
      });
}

// Ends an eye path at its first merge.
struct UntilFirstMerge {
  EyeVisitor visitor;

  EyeContinuation operator()(const SurfaceVertex& v) {
    const EyeContinuation continuation = visitor(v);
    return visitor.has_merged() ? EyeContinuation{Continuation::stop()} : continuation;
  }
  template <class Event>
  requires std::invocable<EyeVisitor&, const Event&>
  auto operator()(const Event& event) { return visitor(event); }
};

// Traces only the part of a pass on which its photon counts depend.
void count_photons(VcmPass& pass) {
  const RenderJob& job = pass.job;
  pass.sees = false;
  for (std::uint32_t block = 0; block < pass.blocks.count(); ++block) {
    pass.begin_block(block);
    trace_light_paths(pass, nullptr, [](const auto&...) {});
    PassReport unused;
    pass.build_merges(unused);
    for_each_pixel(job.view.window, [&](const PixelPlace& place, RayCounts& counts) {
      Sampler sampler = eye_sampler(job, place, pass.number);
      const PathDraw draw = pass.draw_of_eye_path(sampler, place);
      const EyeStart start = start_eye_path(job, place, pass.number, draw.time, sampler);
      LightLayers layers(draw.w);
      const PathContext path{job.scene, draw.w, sampler, counts, {pass.max_depth(), pass.settings.roulette_depth}};
      walk_from_camera(path, start.camera, job.view.medium,
                       UntilFirstMerge{EyeVisitor(path, pass, start.raster, layers)});
    });
  }
}

// The steps of a pass, for one block of light paths after the other.
PassReport render_blocks(VcmPass& pass, const FilmPass& film, const PhaseObserver& begin) {
  PartialLight partial(pass.job.view.window, pass.draw.w, pass.blocks.count());
  PassReport report;
  report.light_paths = pass.light_paths.total();
  for (std::uint32_t block = 0; block < pass.blocks.count(); ++block) {
    begin(Phase::photons);
    pass.begin_block(block);
    report.rays += trace_light_paths(pass, film);
    if (pass.settings.switches.merging) {
      begin(Phase::build);
      PassReport built;
      pass.build_merges(built);
      report += built;
    }
    begin(Phase::eye);
    report.rays += trace_eye_paths(pass, partial, film);
  }
  return report;
}

class VertexConnectionAndMerging final : public Integrator {
 public:
  explicit VertexConnectionAndMerging(const VcmSettings& settings) : settings_(settings) {}

  FilmContents film_contents(const Scene& scene) const override { return settings_.film_contents(scene); }
  MemoryUse memory_use(const RenderSettings& settings) const override { return settings_.memory_use(settings); }
  std::string limitation(const Scene& scene) const override { return settings_.limitation(scene); }
  std::string remark() const override { return prepared_ ? prepared_->remark : std::string(); }
  std::optional<EffortReport> findings() const override { return prepared_ ? prepared_->findings : std::nullopt; }
  bool passes_share_wavelengths() const override { return true; }
  // Until the tests of the radii are done, passes must add their counts one after the other.
  bool passes_may_overlap() const override { return !tests_ || tests_->are_done(); }
  void prepare(const RenderJob& job) override {
    prepared_.emplace(job, settings_);
    tests_.reset();
    const Effort& effort = prepared_->effort;
    if (settings_.plan_effort && effort.light_paths() > 0 && effort.merges()) tests_.emplace(prepared_->radii.window());
  }
  // With saved results, a resumed render need not trace the passes of the tests again.
  std::vector<std::byte> save() const override {
    return tests_ && tests_->are_done() ? tests_->save() : std::vector<std::byte>();
  }
  void load(std::span<const std::byte> results) override {
    if (tests_) tests_->load(results);
  }

  PassReport render_pass(const RenderJob& job, std::uint32_t number, const FilmPass& film,
                         const PhaseObserver& begin) override {
    if (prepared_->effort.light_paths() == 0) {  // path tracing
      begin(Phase::eye);
      PassReport report;
      report.rays = trace_paths(job, {number, {job.settings.max_depth, settings_.roulette_depth}}, film);
      return report;
    }
    begin(Phase::photons);
    if (tests_) count_photons_before(job, number);
    const auto vertices = vertices_.borrow();
    VcmPass pass(job, number, settings_, *prepared_, *vertices, tests_ ? &*tests_ : nullptr);
    const PassReport report = render_blocks(pass, film, begin);
    if (pass.uniformity) pass.uniformity->end_pass();
    return report;
  }

 private:
  // The radii of a pass depend on the first passes. Those before a shard are not rendered here.
  void count_photons_before(const RenderJob& job, std::uint32_t number) {
    const auto vertices = vertices_.borrow();
    while (!tests_->are_done() && tests_->passes_counted() < number) {
      VcmPass pass(job, tests_->passes_counted(), settings_, *prepared_, *vertices, &*tests_);
      count_photons(pass);
      tests_->end_pass();
    }
  }

  VcmSettings settings_;
  std::optional<VcmPreparation> prepared_;
  std::optional<UniformityTests> tests_;  // if radii shrink pixel by pixel
  Pool<LightVertices> vertices_;
};

}  // namespace

std::unique_ptr<Integrator> make_vertex_connection_and_merging(const VcmSettings& settings) {
  return std::make_unique<VertexConnectionAndMerging>(settings);
}

}  // namespace lanthorn
