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
#include "integrators/vcm/vcm_visitors.h"
#include "path/eye_pass.h"
#include "path/radiance_along.h"
#include "path/splat.h"

namespace lanthorn {

namespace {

RayCounts trace_light_paths(const VcmPass& pass, Film& film) {
  const View& view = pass.job.view;
  return trace_light_paths(
      pass, &film, [&](const LightArrival& light, const LensLight& seen, const PlaceEffort& there, std::size_t) {
        splat(film, view, pass.draw.w, seen, light.layers,
              light.weight(pass.bidirectional_at(seen.raster, there), seen));
      });
}

RayCounts trace_eye_paths(const VcmPass& pass, Film& film) {
  return trace_eye_paths(
      pass.job, {pass.number, {pass.max_depth(), pass.settings.roulette_depth}}, film,
      [&](Sampler& sampler) { return pass.draw_of_eye_path(sampler); },
      [&](const PathContext& path, const EyeStart& start, const PixelPlace&, LightLayers& layers) {
        walk_from_camera(path, start.camera, pass.job.view.medium, EyeVisitor(path, pass, start.raster, layers));
      });
}

class VertexConnectionAndMerging final : public Integrator {
 public:
  explicit VertexConnectionAndMerging(const VcmSettings& settings) : settings_(settings) {}

  FilmContents film_contents(const Scene& scene) const override { return settings_.film_contents(scene); }
  MemoryUse memory_use(const RenderSettings&) const override { return settings_.memory_use(); }
  std::string limitation(const Scene& scene) const override { return settings_.limitation(scene); }
  std::string remark() const override {
    if (!prepared_) return {};
    return settings_.chooses_effort ? prepared_->effort.describe() : prepared_->emission.remark;
  }
  std::string findings() const override {
    return settings_.chooses_effort && prepared_ ? prepared_->effort.findings() : std::string();
  }
  bool passes_share_wavelengths() const override { return true; }
  void prepare(const RenderJob& job) override { prepared_.emplace(job, settings_); }

  PassReport render_pass(const RenderJob& job, std::uint32_t number, Film& film, const PhaseObserver& begin) override {
    if (prepared_->effort.light_paths() == 0) {  // path tracing
      begin(Phase::eye);
      PassReport report;
      report.rays = trace_paths(job, {number, {job.settings.max_depth, settings_.roulette_depth}}, film);
      return report;
    }
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
