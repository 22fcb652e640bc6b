// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Path tracing (Kajiya 1986) with next-event estimation and multiple importance sampling (Veach 1997, chapter 9).
#include "integrators/integrator.h"
#include "path/eye_pass.h"
#include "path/light_layers.h"
#include "path/path_draw.h"
#include "path/path_visitor.h"

namespace lanthorn {

namespace {

class PathTracer final : public Integrator {
 public:
  explicit PathTracer(const Parameters& parameters)
      : roulette_depth_(static_cast<int>(parameters.number("roulette-depth", 1, 1e6))) {}

  PassReport render_pass(const Scene& scene, const RenderSettings& settings, std::uint32_t pass, Film& film,
                         const PhaseObserver& begin) override {
    begin(Phase::eye);
    const PixelWindow& window = settings.window;
    PassReport report;
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

  int roulette_depth_;
};

PixelSample PathTracer::trace(const Scene& scene, const RenderSettings& settings, const PixelPlace& place,
                              Sampler& sampler, RayCounts& counts) const {
  const PathDraw draw = draw_time_and_wavelengths(scene, settings.color, sampler);
  const EyeStart start = start_eye_path(scene, settings.filter, place, draw.time, sampler);
  LightLayers layers(draw.w);
  walk_from_camera(scene, start.camera, {settings.max_depth, roulette_depth_}, draw.w, sampler, counts,
                   PathVisitor{scene, draw.w, sampler, counts, layers});
  return layers.sample(start.filter_weight);
}

}  // namespace

IntegratorInfo path_info() {
  return {"path",
          "path tracing with next-event estimation and multiple importance sampling",
          "Kajiya 1986; Veach 1997",
          {{"roulette-depth", "3", "scattering event from which Russian roulette may end a path, from 1"}},
          [](const Parameters& p) -> std::unique_ptr<Integrator> { return std::make_unique<PathTracer>(p); }};
}

}  // namespace lanthorn
