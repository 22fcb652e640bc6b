// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/emission_pass.h"

#include "path/eye_pass.h"
#include "path/light_layers.h"
#include "path/path_draw.h"

namespace lanthorn {

namespace {

struct EmissionVisitor {
  const Scene& scene;
  const EyeShare& share;
  const Wavelengths& w;
  LightLayers& layers;

  Continuation operator()(const MediumVertex&) { return rest(); }
  void operator()(const GlowVertex& vertex) {
    if (share.all_glow || is_seen(vertex.state))
      layers.add(class_of_glow(vertex.state), vertex.state.beta * vertex.radiance, vertex.state.dispersed);
  }
  // At surfaces with lobes of both kinds the walk may have scattered by one that is not a delta function.
  Continuation operator()(const SurfaceVertex& vertex) {
    if (vertex.state.non_delta > 0 || vertex.state.depth > share.scatterings + 1) return rest();
    layers.see(vertex);
    layers.add(PathClass::emission, hit_emitter(scene, vertex, w), vertex.state.dispersed);
    return lobe_weights(vertex.at.bsdf, vertex.wi_local).delta > 0 ? Continuation::go_on() : rest();
  }
  void operator()(const EscapeVertex& vertex) {
    if (is_seen(vertex.state))
      layers.add(PathClass::emission, hit_environment(scene, vertex, w), vertex.state.dispersed);
  }

 private:
  // What the walk has not met yet is still in sight.
  bool is_seen(const WalkState& state) const { return state.non_delta == 0 && state.depth <= share.scatterings; }
  Continuation rest() const { return share.all_glow ? Continuation::go_on() : Continuation::stop(); }
};

}  // namespace

RayCounts see_emission(const Scene& scene, const RenderSettings& settings, const EyeShare& share, std::uint32_t pass,
                       Film& film) {
  const WalkLimits limits{share.all_glow ? settings.max_depth : share.scatterings, 3};
  const PixelWindow& window = settings.window;
  return for_each_pixel(
      window.x0, window.y0, window.width(), window.height(), [&](const PixelPlace& place, RayCounts& counts) {
        Sampler sampler = Sampler::for_pixel(settings.seed, Stream::camera, pixel_key(scene, place), pass);
        const PathDraw draw = draw_time_and_wavelengths(scene, settings.color, sampler);
        const EyeStart start = start_eye_path(scene, settings.filter, place, draw.time, sampler);
        LightLayers layers(draw.w);
        walk_from_camera(scene, start.camera, limits, draw.w, sampler, counts,
                         EmissionVisitor{scene, share, draw.w, layers});
        film.add(place.index, layers.sample(start.filter_weight));
      });
}

}  // namespace lanthorn
