// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Path tracing (Kajiya 1986) with next-event estimation and multiple importance sampling (Veach 1997, chapter 9).
//
// A pixel is the mean of L(x0, w) / p over rays from the camera, and
//   L(x, w) = L_e(y, -w) + integral of f(-w, w') L(y, w') |cos w'| dw',    y: the point that the ray (x, w) hits.
//
// The files in the order in which a path flows through them:
// 1. path/eye_pass.h       the loop over pixels; the ray's place in the filter, its time and wavelengths (path_draw.h)
// 2. camera/camera.h       the ray through the lens, its weight and density
// 3. path/walk.h           the walk: flight to the next surface or scattering, Russian roulette, throughput beta
//    scene/scene.h         the nearest point of a ray, with its material's closure (surface/bsdf.h: f, pdf, sample)
//    medium/medium.h       free flight in fog, with density sigma_t exp(-sigma_t t)
// 4. path/path_visitor.h   what path tracing does at each event of the walk: the two techniques of direct light
// 5. path/direct_light.h   next-event estimation, L_e f |cos| V / p_light, and emitters that the walk hits, L_e
//    light/light_sampler.h chooses a light, light/light.h a point on it, path/transmittance.h tests what lies between
// 6. path/mis.h            the weights of both: the power heuristic, p_a^2 / (p_a^2 + p_b^2)
// 7. path/light_layers.h   sums by class of path (direct, caustic, indirect, ...), film/film.h adds them to the pixel
#include <fmt/format.h>

#include <optional>

#include "base/parameters.h"
#include "integrators/integrator.h"
#include "path/radiance_along.h"
#include "photon/guides/guide_photons.h"
#include "photon/guides/rare_light.h"
#include "photon/photon_pass.h"

namespace lanthorn {

namespace {

class PathTracer final : public Integrator {
 public:
  explicit PathTracer(const Parameters& parameters)
      : roulette_depth_(static_cast<int>(parameters.number("roulette-depth", 1, 1e6))),
        guides_walks_(choice<bool, 2>(parameters, "guide", {{{"none", false}, {"photons", true}}})) {}

  void prepare(const RenderJob& job) override {
    if (guides_walks_) guides_ = guides_of(job);
    constexpr double noticeable = 0.1;
    const double rare = rare_light_share(job);
    if (rare >= noticeable)
      remark_ = fmt::format(
          "about {:.0f} % of the light on visible surfaces comes by glass or mirrors from small lights, which path "
          "finds rarely or never; auto, the default, finds it",
          100 * rare);
  }
  std::string remark() const override { return remark_; }
  bool passes_may_overlap() const override { return true; }
  PassReport render_pass(const RenderJob& job, std::uint32_t pass, const FilmPass& film,
                         const PhaseObserver& begin) override {
    begin(Phase::eye);
    PassReport report;
    if (guides_) report.photon_map_bytes = guides_->memory_bytes();
    const EyePass eye{pass, {job.settings.max_depth, roulette_depth_}};
    report.rays = guides_ ? trace_paths(job, eye, film, *guides_) : trace_paths(job, eye, film);
    return report;
  }

 private:
  static GuidePhotons guides_of(const RenderJob& job);

  int roulette_depth_;
  bool guides_walks_;
  std::optional<GuidePhotons> guides_;
  std::string remark_;
};

// All passes use the same guides. The expectation of a pass does not depend on the guides, so passes are uncorrelated.
// Photons of direct light are left out, because next-event estimation finds it. Photons from point, spot and distant
// lights by mirrors and clear glass are left out, because no walk can find their light.
GuidePhotons PathTracer::guides_of(const RenderJob& job) {
  const RenderSettings& settings = job.settings;
  const PassDraw draw = draw_for_pass(job, 0);
  PhotonTracer tracer;
  tracer.trace(job.scene, {settings.seed, Stream::light, 0, settings.photons},
               {.first_depth = 2, .max_depth = settings.max_depth}, draw);
  return GuidePhotons::build(tracer.chunks(), draw.w,
                             [](const PhotonFlags& flags) { return !(flags.caustic && flags.from_delta_light); });
}

}  // namespace

IntegratorInfo path_info() {
  return {"path",
          "path tracing with next-event estimation and multiple importance sampling",
          "Kajiya 1986; Veach 1997",
          {{"roulette-depth", "3", "scattering event from which Russian roulette may end a path, from 1"},
           {"guide", "none",
            "path guiding: none (directions by materials alone), or photons (also towards where photons came from)"}},
          [](const Parameters& p) -> std::unique_ptr<Integrator> { return std::make_unique<PathTracer>(p); }};
}

}  // namespace lanthorn
