// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Light tracing (Arvo 1986; Dutré, Lafortune & Willems 1993): walks start at the lights, and every vertex is connected
// to the lens. One eye path per pixel adds directly visible emitters. Other light that the
// camera sees in mirrors and through clear glass is missing, because its vertices cannot be connected to the lens.
#include "integrators/integrator.h"
#include "path/emission_pass.h"
#include "path/lens_connection.h"
#include "path/light_pass.h"
#include "path/path_draw.h"

namespace lanthorn {

namespace {

// Connects each vertex of a light walk to the camera.
struct SplatVisitor {
  const PathContext& path;
  const View& view;
  const FilmPass& film;

  Continuation operator()(const SurfaceVertex& vertex) {
    if (vertex.may_scatter && has_non_delta(vertex.at.bsdf)) connect(vertex);
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& vertex) {
    if (vertex.may_scatter) connect(vertex);
    return Continuation::go_on();
  }
  void operator()(const EscapeVertex&) {}

 private:
  template <class Vertex>
  void connect(const Vertex& vertex) {
    const auto lens = find_lens(path, view, vertex);
    if (!lens) return;
    film.prefetch_splats(view.window.pixel_at(lens->raster));
    if (const auto seen = connect_to_lens(path, view, vertex, *lens))
      splat(film, view, path.w, *seen, layers_of_splat(vertex), 1);
  }
};

class LightTracer final : public Integrator {
 public:
  explicit LightTracer(const Parameters& parameters)
      : roulette_depth_(static_cast<int>(parameters.number("roulette-depth", 1, 1e6))) {}

  FilmContents film_contents(const Scene& scene) const override {
    FilmContents contents = path_layers(scene);
    contents.splats = true;
    return contents;
  }

  MemoryUse memory_use(const RenderSettings& settings) const override {
    return {.per_light_path = bytes_per_light_path, .photon_block = settings.photon_block};
  }
  bool passes_may_overlap() const override { return true; }
  PassReport render_pass(const RenderJob& job, std::uint32_t pass, const FilmPass& film,
                         const PhaseObserver& begin) override {
    PassReport report;
    begin(Phase::photons);
    const LightPathBlocks blocks(job.settings.photons, job.settings.photon_block);
    LightPaths paths(job.scene, {job.settings.seed, Stream::light, pass, job.settings.photons, nullptr, blocks[0]});
    report.light_paths = paths.total();
    report.rays = trace_lights(job, paths, film);
    for (std::uint32_t block = 1; block < blocks.count(); ++block) {
      paths.begin_block(blocks[block]);
      report.rays += trace_lights(job, paths, film);
    }
    begin(Phase::eye);
    report.rays += see_emission(job, {.unlit_emission = job.scene.has_unlit_emission()}, pass, film);
    return report;
  }

 private:
  RayCounts trace_lights(const RenderJob& job, const LightPaths& paths, const FilmPass& film) const {
    const WalkLimits limits{job.settings.max_depth, roulette_depth_};
    const OwnPathDraw draw_path(job);
    return paths.for_each([&](const LightPath& start, Sampler& sampler, RayCounts& counts, std::size_t) {
      const PathDraw draw = draw_path(sampler);
      const PathContext path{job.scene, draw.w, sampler, counts, limits};
      walk_from_light(path, start, draw.time, SplatVisitor{path, job.view, film});
    });
  }

  int roulette_depth_;
};

}  // namespace

IntegratorInfo light_info() {
  return {"light",
          "light tracing: paths from the lights, splatted onto the film (no mirrors or clear glass before the eye)",
          "Arvo 1986; Dutre et al. 1993",
          {{"roulette-depth", "1", "scattering event from which Russian roulette may end a path, from 1"}},
          [](const Parameters& p) -> std::unique_ptr<Integrator> { return std::make_unique<LightTracer>(p); }};
}

}  // namespace lanthorn
