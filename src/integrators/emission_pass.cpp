// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/emission_pass.h"

#include "path/eye_pass.h"
#include "path/light_layers.h"
#include "path/path_draw.h"

namespace lanthorn {

namespace {

struct EmissionVisitor {
  const Scene& scene;
  const Wavelengths& w;
  LightLayers& layers;

  Continuation operator()(const MediumVertex&) { return Continuation::stop(); }
  void operator()(const GlowVertex& vertex) {
    if (vertex.state.non_delta == 0)
      layers.add(PathClass::emission, vertex.state.beta * vertex.radiance, vertex.state.dispersed);
  }
  // At surfaces with lobes of both kinds the walk may have scattered by one that is not a delta function.
  Continuation operator()(const SurfaceVertex& vertex) {
    if (vertex.state.non_delta > 0) return Continuation::stop();
    layers.see(vertex);
    layers.add(PathClass::emission, hit_emitter(scene, vertex, w), vertex.state.dispersed);
    return lobe_weights(vertex.at.bsdf, vertex.wi_local).delta > 0 ? Continuation::go_on() : Continuation::stop();
  }
  void operator()(const EscapeVertex& vertex) {
    if (vertex.state.non_delta == 0)
      layers.add(PathClass::emission, hit_environment(scene, vertex, w), vertex.state.dispersed);
  }
};

}  // namespace

RayCounts see_emission(const Scene& scene, const RenderSettings& settings, int max_scatterings, std::uint32_t pass,
                       Film& film) {
  const PixelWindow& window = settings.window;
  return for_each_pixel(
      window.x0, window.y0, window.width(), window.height(), [&](const PixelPlace& place, RayCounts& counts) {
        Sampler sampler = Sampler::for_pixel(settings.seed, Stream::camera, pixel_key(scene, place), pass);
        const PathDraw draw = draw_time_and_wavelengths(scene, settings.color, sampler);
        const EyeStart start = start_eye_path(scene, settings.filter, place, draw.time, sampler);
        LightLayers layers(draw.w);
        walk_from_camera(scene, start.camera, {.max_depth = max_scatterings}, draw.w, sampler, counts,
                         EmissionVisitor{scene, draw.w, layers});
        film.add(place.index, layers.sample(start.filter_weight));
      });
}

}  // namespace lanthorn
