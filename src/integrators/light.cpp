// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Light tracing (Arvo 1986; Dutré, Lafortune & Willems 1993): walks from the lights, every vertex connected to the
// lens. Emitters that the camera sees directly are added by one eye ray per pixel, as is all light of glowing media by
// an eye path; what the camera sees of other light through mirrors and clear glass cannot be found this way and is
// missing.
#include "integrators/integrator.h"
#include "path/emission_pass.h"
#include "path/light_pass.h"
#include "path/path_draw.h"
#include "path/splat.h"

namespace lanthorn {

namespace {

// Connects each vertex of a light walk to the camera.
struct SplatVisitor {
  const Scene& scene;
  const RenderSettings& settings;
  const Wavelengths& w;
  Sampler& sampler;
  RayCounts& counts;
  Film& film;

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
    if (const auto seen = connect_to_lens(scene, vertex, w, sampler, counts))
      splat(film, settings, w, *seen, layer_of_splat(vertex.state), 1);
  }
};

class LightTracer final : public Integrator {
 public:
  explicit LightTracer(const Parameters& parameters)
      : roulette_depth_(static_cast<int>(parameters.number("roulette-depth", 1, 1e6))) {}

  bool splats() const override { return true; }

  PassReport render_pass(const Scene& scene, const RenderSettings& settings, std::uint32_t pass, Film& film,
                         const PhaseObserver& begin) override {
    PassReport report;
    begin(Phase::photons);
    report.rays = trace_lights(scene, settings, pass, film, report.light_paths);
    begin(Phase::eye);
    report.rays += see_emission(scene, settings, {.all_glow = scene.has_glowing_media()}, pass, film);
    return report;
  }

 private:
  RayCounts trace_lights(const Scene& scene, const RenderSettings& settings, std::uint32_t pass, Film& film,
                         std::uint64_t& light_paths) const;

  int roulette_depth_;
};

RayCounts LightTracer::trace_lights(const Scene& scene, const RenderSettings& settings, std::uint32_t pass, Film& film,
                                    std::uint64_t& light_paths) const {
  const WalkLimits limits{settings.max_depth, roulette_depth_};
  return for_each_light_path(scene, {settings.seed, Stream::light, pass, settings.photons}, light_paths,
                             [&](const LightPath& path, Sampler& sampler, RayCounts& counts) {
                               const PathDraw draw = draw_time_and_wavelengths(scene, settings.color, sampler);
                               walk_from_light(scene, path, draw.time, limits, draw.w, sampler, counts,
                                               SplatVisitor{scene, settings, draw.w, sampler, counts, film});
                             });
}

}  // namespace

IntegratorInfo light_info() {
  return {"light",
          "light tracing: paths from the lights, splatted onto the film (no mirrors or clear glass before the eye)",
          "Arvo 1986; Dutre et al. 1993",
          {{"roulette-depth", "1", "scattering event from which Russian roulette may end a path, from 1"}},
          [](const Parameters& p) -> std::unique_ptr<Integrator> { return std::make_unique<LightTracer>(p); }};
}

}  // namespace lanthorn
