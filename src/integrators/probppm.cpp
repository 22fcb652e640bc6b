// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Progressive photon mapping, the probabilistic approach (Knaus & Zwicker 2011): every pass is an independent photon
// map whose radius depends on the pass number only, and the image is the mean of the passes. Direct light comes from
// next-event estimation, all other light from photons or, where lobes are narrow, from continuing the eye path.
#include <fmt/format.h>

#include "cache/hash_grid.h"
#include "cache/kernels.h"
#include "cache/photon_gather.h"
#include "cache/photon_map.h"
#include "cache/photon_pass.h"
#include "cache/radius_schedule.h"
#include "integrators/integrator.h"
#include "integrators/pilot_radius.h"
#include "lanthorn/error.h"
#include "path/direct_light.h"
#include "path/eye_pass.h"
#include "path/light_layers.h"

namespace lanthorn {

namespace {

using Map = PhotonMap<HashGrid>;

Kernel kernel_parameter(const Parameters& parameters) {
  const std::optional<Kernel> kernel = kernel_from_name(parameters.text("kernel"));
  if (!kernel)
    throw Error(
        fmt::format("--set kernel={}: expected box, cone, epanechnikov or gaussian", parameters.text("kernel")));
  return *kernel;
}

class ProbabilisticProgressivePhotonMapper final : public Integrator {
 public:
  explicit ProbabilisticProgressivePhotonMapper(const Parameters& parameters)
      : alpha_(parameters.number("alpha", 1e-3, 1)),
        kernel_(kernel_parameter(parameters)),
        radius_choice_(RadiusChoice::from(parameters)) {}

  void prepare(const Scene& scene, const RenderSettings& settings) override {
    first_radius_ = choose_first_radius(scene, settings, radius_choice_);
  }

  std::string limitation(const Scene& scene) const override {
    if (!scene.has_media()) return {};
    return "photons are stored on surfaces, not in media yet: what glass and mirrors focus into a medium is found by "
           "eye paths, which cannot find that of point, spot and distant lights";
  }

  PassReport render_pass(const Scene& scene, const RenderSettings& settings, std::uint32_t pass, Film& film,
                         const PhaseObserver& begin) override;

 private:
  PixelSample trace(const Scene& scene, const RenderSettings& settings, const Map& map, const PixelPlace& place,
                    const PathDraw& draw, float radius, Sampler& sampler, RayCounts& counts) const;

  double alpha_;
  Kernel kernel_;
  RadiusChoice radius_choice_;
  FirstRadius first_radius_;
  PhotonTracer tracer_;
};

PassReport ProbabilisticProgressivePhotonMapper::render_pass(const Scene& scene, const RenderSettings& settings,
                                                             std::uint32_t pass, Film& film,
                                                             const PhaseObserver& begin) {
  Sampler pass_sampler = Sampler::for_pass(settings.seed, pass);
  const PathDraw draw = draw_time_and_wavelengths(scene, settings.color, pass_sampler);
  const float shrink = RadiusSchedule{1, alpha_}.radius(pass);

  begin(Phase::photons);
  tracer_.trace(scene, {settings.seed, Stream::light, pass, settings.photons}, {.max_depth = settings.max_depth}, draw);
  begin(Phase::build);
  const Map map = Map::build(tracer_.chunks(), settings.color, kernel_.support(first_radius_.largest() * shrink));
  begin(Phase::eye);
  const PixelWindow& window = settings.window;
  PassReport report;
  report.rays = for_each_pixel(
      window.x0, window.y0, window.width(), window.height(), [&](const PixelPlace& place, RayCounts& counts) {
        Sampler sampler = Sampler::for_pixel(settings.seed, Stream::camera, pixel_key(scene, place), pass);
        const float radius = first_radius_.at(place.index) * shrink;
        film.add(place.index, trace(scene, settings, map, place, draw, radius, sampler, counts));
      });
  report.rays += tracer_.rays();
  report.light_paths = tracer_.emitted();
  report.photons_stored = tracer_.stored();
  report.photon_map_bytes = map.memory_bytes();
  report.radius = first_radius_.typical() * shrink;
  return report;
}

// At each vertex: next-event estimation for direct light; then, with a probability that depends on the lobes, indirect
// light from the photons, or else the walk goes on. Photons are in proportion to that probability, the walk's non-delta
// light to its complement: together they are all of it. Delta lobes have the walk alone.
struct GatherVisitor {
  const Scene& scene;
  const Map& map;
  const Wavelengths& w;
  GatherSettings gather;
  Sampler& sampler;
  RayCounts& counts;
  LightLayers& layers;

  Continuation operator()(const SurfaceVertex& vertex) {
    const WalkState& state = vertex.state;
    layers.see(vertex);
    layers.add(class_of_hit(state), hit_emitter(scene, vertex, w), state.dispersed);
    if (!vertex.may_scatter) return Continuation::stop();
    if (!has_non_delta(vertex.at.bsdf)) return Continuation::go_on();

    // Photons are not recorded for eye paths of more scatterings: from there on the walk finds the light alone.
    const bool photons_reach = state.depth <= PhotonFlags::most_eye_scatterings + 1;
    const float p = photons_reach ? gather_probability(lobe_weights(vertex.at.bsdf, vertex.wi_local)) : 0.0f;
    sampler.seek(visitor_dimensions(state.depth));
    const DirectLight direct = next_event(scene, vertex, 1 - p, w, sampler, counts);
    layers.add(class_of_next_event(state), direct.radiance, direct.dispersed);
    if (sampler.next() >= p) return {1 - p, 1 - p};

    gather.delta_light_weight = 1 / p;
    const GatheredLight light = gather_photons(map, vertex, gather, w);
    layers.add(state.non_delta == 0 ? PathClass::caustic : PathClass::indirect, light.caustic, false);
    layers.add(PathClass::indirect, light.indirect, false);
    return Continuation::stop();
  }
  // Photons are stored on surfaces alone: in a medium the walk goes on to all light that next-event estimation misses.
  Continuation operator()(const MediumVertex& vertex) {
    if (!vertex.may_scatter) return Continuation::stop();
    sampler.seek(visitor_dimensions(vertex.state.depth));
    const DirectLight direct = next_event(scene, vertex, 1, w, sampler, counts);
    layers.add(class_of_next_event(vertex.state), direct.radiance, direct.dispersed);
    return Continuation::go_on();
  }
  void operator()(const GlowVertex& vertex) {
    layers.add(class_of_glow(vertex.state), vertex.state.beta * vertex.radiance, vertex.state.dispersed);
  }
  void operator()(const EscapeVertex& vertex) {
    layers.add(class_of_hit(vertex.state), hit_environment(scene, vertex, w), vertex.state.dispersed);
  }
};

PixelSample ProbabilisticProgressivePhotonMapper::trace(const Scene& scene, const RenderSettings& settings,
                                                        const Map& map, const PixelPlace& place, const PathDraw& draw,
                                                        float radius, Sampler& sampler, RayCounts& counts) const {
  const EyeStart start = start_eye_path(scene, settings.filter, place, draw.time, sampler);
  LightLayers layers(draw.w);
  const GatherSettings gather{kernel_, radius};
  walk_from_camera(scene, start.camera, {settings.max_depth, 3}, draw.w, sampler, counts,
                   GatherVisitor{scene, map, draw.w, gather, sampler, counts, layers});
  return layers.sample(start.filter_weight);
}

}  // namespace

IntegratorInfo probppm_info() {
  return {
      "probppm",
      "progressive photon mapping, one independent photon map per pass: caustics of every kind",
      "Knaus & Zwicker 2011",
      {{"alpha", "0.6667", "radius reduction in (0,1]: r^2 shrinks by (i+alpha)/(i+1); small: sharper, noisier"},
       {"kernel", "epanechnikov", "density estimation kernel: box, cone, epanechnikov, gaussian"},
       {"radius", "auto", "first radius: auto (one for the scene), pixel (one for each pixel), or a length in metres"}},
      [](const Parameters& p) -> std::unique_ptr<Integrator> {
        return std::make_unique<ProbabilisticProgressivePhotonMapper>(p);
      }};
}

}  // namespace lanthorn
