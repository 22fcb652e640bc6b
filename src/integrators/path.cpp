// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Path tracing (Kajiya 1986) with next-event estimation and multiple importance sampling (Veach 1997, chapter 9).
#include <optional>

#include "base/parameters.h"
#include "integrators/integrator.h"
#include "path/eye_pass.h"
#include "path/light_layers.h"
#include "path/path_draw.h"
#include "path/path_visitor.h"
#include "photon/guide_photons.h"
#include "photon/photon_pass.h"

namespace lanthorn {

namespace {

/// Sends its walks also to where photons came from.
struct GuidedPathVisitor : PathVisitor {
  using PathVisitor::operator();
  GuidedContinuation operator()(const SurfaceVertex& vertex) {
    const Guidance guidance = vertex.may_scatter ? guides.find(vertex) : Guidance{};
    find_light(vertex, guidance);
    return {Continuation::go_on(), guidance};
  }

  const GuidePhotons& guides;
};

class PathTracer final : public Integrator {
 public:
  explicit PathTracer(const Parameters& parameters)
      : roulette_depth_(static_cast<int>(parameters.number("roulette-depth", 1, 1e6))),
        guides_walks_(choice<bool, 2>(parameters, "guide", {{{"none", false}, {"photons", true}}})) {}

  void prepare(const Scene& scene, const RenderSettings& settings) override {
    if (guides_walks_) guides_ = guides_of(scene, settings);
  }
  PassReport render_pass(const Scene& scene, const RenderSettings& settings, std::uint32_t pass, Film& film,
                         const PhaseObserver& begin) override {
    begin(Phase::eye);
    const PixelWindow& window = settings.window;
    PassReport report;
    if (guides_) report.photon_map_bytes = guides_->memory_bytes();
    report.rays = for_each_pixel(
        window.x0, window.y0, window.width(), window.height(), [&](const PixelPlace& place, RayCounts& counts) {
          Sampler sampler = Sampler::for_pixel(settings.seed, Stream::camera, pixel_key(scene, place), pass);
          film.add(place.index, trace(scene, settings, place, sampler, counts));
        });
    return report;
  }

 private:
  PixelSample trace(const Scene& scene, const RenderSettings& settings, const PixelPlace& place, Sampler& sampler,
                    RayCounts& counts) const;

  static GuidePhotons guides_of(const Scene& scene, const RenderSettings& settings);

  int roulette_depth_;
  bool guides_walks_;
  std::optional<GuidePhotons> guides_;
};

// One set of guides serves all passes: whatever the guides, the mean of a pass is the picture, so that passes do not
// correlate. Direct light is next-event estimation's; what comes from a light without size through mirrors and clear
// glass no walk can find.
GuidePhotons PathTracer::guides_of(const Scene& scene, const RenderSettings& settings) {
  Sampler sampler = Sampler::for_pass(settings.seed, 0);
  const PathDraw draw = draw_time_and_wavelengths(scene, settings.color, sampler);
  PhotonTracer tracer;
  tracer.trace(scene, {settings.seed, Stream::light, 0, settings.photons},
               {.first_depth = 2, .max_depth = settings.max_depth}, draw);
  return GuidePhotons::build(tracer.chunks(), draw.w,
                             [](const PhotonFlags& flags) { return !(flags.caustic && flags.from_delta_light); });
}

PixelSample PathTracer::trace(const Scene& scene, const RenderSettings& settings, const PixelPlace& place,
                              Sampler& sampler, RayCounts& counts) const {
  const PathDraw draw = draw_time_and_wavelengths(scene, settings.color, sampler);
  const EyeStart start = start_eye_path(scene, settings.filter, place, draw.time, sampler);
  LightLayers layers(draw.w);
  const PathVisitor visitor{scene, draw.w, sampler, counts, layers};
  const WalkLimits limits{settings.max_depth, roulette_depth_};
  if (guides_)
    walk_from_camera(scene, start.camera, limits, draw.w, sampler, counts, GuidedPathVisitor{visitor, *guides_});
  else
    walk_from_camera(scene, start.camera, limits, draw.w, sampler, counts, PathVisitor(visitor));
  return layers.sample(start.filter_weight);
}

}  // namespace

IntegratorInfo path_info() {
  return {
      "path",
      "path tracing with next-event estimation and multiple importance sampling",
      "Kajiya 1986; Veach 1997",
      {{"roulette-depth", "3", "scattering event from which Russian roulette may end a path, from 1"},
       {"guide", "none",
        "directions: none (by materials alone), or also to where photons (--photons, traced once) came from: photons"}},
      [](const Parameters& p) -> std::unique_ptr<Integrator> { return std::make_unique<PathTracer>(p); }};
}

}  // namespace lanthorn
