// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Vertex connection and merging (Georgiev, Křivánek, Davidovič & Slusallek 2012; Hachisuka, Pantaleoni & Jensen 2012)
// and its two halves: bidirectional path tracing (Veach 1997, chapter 10) connects vertices, bidirectional photon
// mapping merges them. One algorithm; the techniques are switched. A pass traces its light paths, splats each of their
// vertices through the lens, keeps them, and lets each eye path be connected to one light path and merge with all.
#include <fmt/format.h>

#include <optional>
#include <vector>

#include "cache/kernels.h"
#include "cache/merge_map.h"
#include "cache/radius_schedule.h"
#include "integrators/integrator.h"
#include "integrators/pilot_radius.h"
#include "integrators/splat.h"
#include "path/direct_light.h"
#include "path/eye_pass.h"
#include "path/light_layers.h"
#include "path/path_draw.h"
#include "path/transmittance.h"

namespace lanthorn {

namespace {

// Which techniques a method has besides the eye walk's own hits.
struct Switches {
  bool connections = true;  // next-event estimation and the lens included
  bool merging = true;
};

// What the visitors of a pass share.
struct Pass {
  const Scene& scene;
  const RenderSettings& settings;
  const PathDraw& draw;
  Switches switches;
  Techniques techniques;
  const std::vector<float>& emission_probability;  // by light
  const LightVertices& vertices;
  const MergeMap& merge_map;
  Kernel kernel;
  float radius = 0;

  float merging_at(const SurfacePoint& at) const { return merges_at(at) ? techniques.merging : 0.0f; }
};

// Scattering at one end of a connection, from the vertex before the end to the other end.
struct End {
  Spectrum f;                      // with the cosine that belongs to this end's transport
  float forward = 0, reverse = 0;  // densities per solid angle, of the way there and of the way back
  float cos = 1;                   // by which densities from the other end arrive
  float merging = 0;
  bool dispersed = false;
};

End eye_end(const Pass& pass, const SurfaceVertex& v, const Direction& direction) {
  const Vec3 wo = v.at.shading.to_local(direction);
  const Spectrum f = eval(v.at.bsdf, v.wi_local, wo, Transport::radiance);
  if (f.is_black()) return {};
  return {f * abs_cos_theta(wo),          pdf(v.at.bsdf, v.wi_local, wo),
          pdf(v.at.bsdf, wo, v.wi_local), std::fabs(dot(v.at.normal, direction)),
          pass.merging_at(v.at),          is_dispersive(v.at.bsdf)};
}
End eye_end(const Pass&, const MediumVertex& v, const Direction& direction) {
  const float p = phase(v.phase, v.wi, direction);
  return {Spectrum(p), p, p, 1, 0, false};
}
End light_end(const Pass& pass, const LightVertex& v, const Direction& direction) {
  if (v.phase) {
    const float p = phase(*v.phase, v.wi, direction);
    return {Spectrum(p), p, p, 1, 0, false};
  }
  const Vec3 wo = v.at.shading.to_local(direction);
  const Spectrum f = eval(v.at.bsdf, v.wi_local, wo, Transport::importance);
  if (f.is_black()) return {};
  const float cos = std::fabs(dot(v.at.normal, direction));
  return {f * (cos * shading_flux_ratio(v.at, v.wi)),
          pdf(v.at.bsdf, v.wi_local, wo),
          pdf(v.at.bsdf, wo, v.wi_local),
          cos,
          pass.merging_at(v.at),
          is_dispersive(v.at.bsdf)};
}

// What weights ask of the other way: of light that comes back to the vertex from `direction`.
struct Backwards {
  float cos = 1;      // by which densities from there arrive
  float reverse = 0;  // density per solid angle, from there to the vertex before
  float merging = 0;
};
Backwards backwards(const Pass& pass, const SurfaceVertex& v, const Direction& direction) {
  return {std::fabs(dot(v.at.normal, direction)), pdf(v.at.bsdf, v.at.shading.to_local(direction), v.wi_local),
          pass.merging_at(v.at)};
}
Backwards backwards(const Pass&, const MediumVertex& v, const Direction& direction) {
  return {1, phase(v.phase, v.wi, direction), 0};
}

// Keeps the vertices of a light path and splats them through the lens.
class LightVisitor {
 public:
  LightVisitor(const Pass& pass, const LightPath& path, Sampler& sampler, RayCounts& counts, Film& film,
               LightVertices::Chunk& chunk)
      : pass_(pass),
        path_(path),
        sampler_(sampler),
        counts_(counts),
        film_(film),
        chunk_(chunk),
        subpath_(pass.techniques) {}

  void operator()(const EmissionSample& emission) {
    subpath_.begin_at_light(path_.index, emission, pass_.emission_probability[path_.index]);
  }
  Continuation operator()(const SurfaceVertex& v) {
    const SubpathDensities& densities = subpath_.arrive(pass_.scene, v);
    if (v.may_scatter && has_non_delta(v.at.bsdf)) {
      keep(v.state, densities, v.at, v.wi, v.wi_local, {});
      if (pass_.switches.connections) see(v, densities);
    }
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& v) {
    const SubpathDensities& densities = subpath_.arrive(pass_.scene, v);
    if (v.may_scatter) {
      SurfacePoint at;
      at.position = v.position;
      at.time = v.time;
      keep(v.state, densities, at, v.wi, Vec3(0), v.phase);
      if (pass_.switches.connections) see(v, densities);
    }
    return Continuation::go_on();
  }
  void operator()(const EscapeVertex&) {}

 private:
  void keep(const WalkState& state, const SubpathDensities& densities, const SurfacePoint& at, const Direction& wi,
            const Vec3& wi_local, const std::optional<HenyeyGreenstein>& phase) {
    chunk_.vertices.push_back({at, wi, wi_local, phase, state.beta, densities, state.medium, state.depth,
                               state.non_delta == 0, state.dispersed});
  }
  template <class Vertex>
  void see(const Vertex& v, const SubpathDensities& densities) {
    const std::optional<LensLight> seen = connect_to_lens(pass_.scene, v, pass_.draw.w, sampler_, counts_);
    if (!seen) return;
    const auto [cos, reverse, merging] = backwards(pass_, v, -seen->from_lens.direction);
    const float density = pass_.scene.camera().density_at(seen->from_lens, seen->distance) * cos;
    splat(film_, pass_.settings, pass_.draw.w, *seen, layer_of_splat(v.state),
          weight_lens(densities, density, reverse, merging, pass_.techniques));
  }

  const Pass& pass_;
  const LightPath& path_;
  Sampler& sampler_;
  RayCounts& counts_;
  Film& film_;
  LightVertices::Chunk& chunk_;
  Subpath subpath_;
};

// Finds the light of an eye path by all techniques but the lens.
class EyeVisitor {
 public:
  EyeVisitor(const Pass& pass, std::size_t light_path, Sampler& sampler, RayCounts& counts, LightLayers& layers)
      : pass_(pass),
        light_path_(light_path),
        sampler_(sampler),
        counts_(counts),
        layers_(layers),
        subpath_(pass.techniques) {
    subpath_.begin_at_lens();
  }

  Continuation operator()(const SurfaceVertex& v) {
    layers_.see(v);
    const SubpathDensities& densities = subpath_.arrive(pass_.scene, v);
    hit(v, densities);
    if (!v.may_scatter) return Continuation::stop();
    if (has_non_delta(v.at.bsdf)) {
      if (pass_.switches.connections) connect(v, densities);
      if (pass_.switches.merging && merges_at(v.at)) merge(v, densities);
    }
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& v) {
    const SubpathDensities& densities = subpath_.arrive(pass_.scene, v);
    if (!v.may_scatter) return Continuation::stop();
    if (pass_.switches.connections) connect(v, densities);
    return Continuation::go_on();
  }
  void operator()(const GlowVertex& v) {
    layers_.add(class_of_glow(v.state), Technique::hit, v.state.beta * v.radiance, v.state.dispersed);
  }
  void operator()(const EscapeVertex& v) {
    if (!hits_count(v.state)) return;
    const SubpathDensities& densities = subpath_.escape(v);
    for (const std::uint32_t index : pass_.scene.infinite_lights()) {
      const Light& light = pass_.scene.lights()[index];
      const Spectrum radiance = emitted_infinite(light, v.state.previous, v.direction, pass_.draw.w);
      if (radiance.is_black()) continue;
      float weight = 1;
      if (v.state.depth > 0) {
        const float direct =
            next_event_density(pass_.scene, index, v.state.previous, v.state.previous_normal, {}, v.direction);
        const EmissionPdf emission = pdf_emission(light, {v.state.previous, Normal(0), Vec2(0)}, -v.direction);
        weight =
            weight_hit(densities, direct, pass_.emission_probability[index] * emission.position * emission.direction);
      }
      layers_.add(class_of_hit(v.state), Technique::hit, v.state.beta * radiance * weight, v.state.dispersed);
    }
  }

 private:
  // Merging alone leaves to the walk what no photon can bring: light seen directly or through delta scatterings.
  bool hits_count(const WalkState& state) const { return pass_.switches.connections || state.non_delta == 0; }

  void hit(const SurfaceVertex& v, const SubpathDensities& densities) {
    if (!v.at.light || !hits_count(v.state)) return;
    const Light& light = pass_.scene.lights()[*v.at.light];
    const EmitterHit at{v.at.position, v.at.normal, v.at.uv};
    const Spectrum radiance = emitted(light, at, v.wi, pass_.draw.w);
    if (radiance.is_black()) return;
    float weight = 1;
    if (v.state.depth > 1) {
      const Vec3 way = v.at.position - v.state.previous;
      const float distance2 = length_squared(way);
      const float direct =
          next_event_density(pass_.scene, *v.at.light, v.state.previous, v.state.previous_normal, at, -v.wi) *
          std::fabs(dot(v.at.normal, v.wi)) / distance2;
      const EmissionPdf emission = pdf_emission(light, at, v.wi);
      weight = weight_hit(densities, direct,
                          pass_.emission_probability[*v.at.light] * emission.position * emission.direction);
    }
    layers_.add(class_of_hit(v.state), Technique::hit, v.state.beta * radiance * weight, v.state.dispersed);
  }

  template <class Vertex>
  void connect(const Vertex& v, const SubpathDensities& densities) {
    sampler_.seek(visitor_dimensions(v.state.depth));
    if (const auto event = sample_next_event(pass_.scene, v, pass_.draw.w, sampler_, counts_))
      layers_.add(class_of_next_event(v.state), Technique::nee, event->radiance * weight(v, *event, densities),
                  event->dispersed);
    for (const LightVertex& other : pass_.vertices.path(light_path_)) connect_to(v, other, densities);
  }

  template <class Vertex>
  float weight(const Vertex& v, const NextEvent& event, const SubpathDensities& densities) const {
    const Light& light = pass_.scene.lights()[event.light];
    const LightSample& l = event.sample;
    const auto [cos, reverse, merging] = backwards(pass_, v, l.wi);
    const bool has_surface = std::holds_alternative<AreaLight>(light);
    const EmissionPdf emission = pdf_emission(light, {l.position, l.normal, Vec2(0)}, -l.wi);
    // Of lights at a point next-event estimation is certain of the place: per solid angle that is distance².
    const float pdf = event.pmf * l.pdf * (has_surface || is_infinite_or_distant(light) ? 1.0f : sqr(l.distance));
    const float cos_light = has_surface ? std::fabs(dot(l.normal, l.wi)) : 1.0f;
    const float ratio =
        pass_.emission_probability[event.light] * emission.position * emission.direction * cos / (pdf * cos_light);
    return weight_next_event(densities, event.pmf * l.pdf, l.delta ? 0.0f : event.pdf_walk, ratio, reverse, merging);
  }
  static bool is_infinite_or_distant(const Light& light) {
    return is_infinite(light) || std::holds_alternative<DistantLight>(light);
  }

  template <class Vertex>
  void connect_to(const Vertex& v, const LightVertex& other, const SubpathDensities& densities) {
    if (v.state.depth + other.depth > pass_.settings.max_depth) return;
    const Point from = position_of(v);
    const Vec3 way = other.at.position - from;
    const float distance2 = length_squared(way);
    if (!(distance2 > 0)) return;
    const float distance = std::sqrt(distance2);
    const Direction direction = way / distance;
    const End eye = eye_end(pass_, v, direction);
    if (eye.f.is_black()) return;
    const End light = light_end(pass_, other, -direction);
    if (light.f.is_black()) return;
    const float weight =
        weight_connection(densities, other.densities, eye.forward * light.cos / distance2,
                          light.forward * eye.cos / distance2, eye.reverse, light.reverse, eye.merging, light.merging);
    const Spectrum value =
        v.state.beta * eye.f * light.f * other.beta * (pass_.techniques.light_paths * weight / distance2);
    if (value.is_black()) return;
    const Spectrum arrives =
        transmittance(pass_.scene, ray_to(v, direction, other.at.position, distance), medium_towards(v, direction),
                      pass_.draw.w, sampler_.generator(visitor_dimensions(v.state.depth)), counts_);
    layers_.add(PathClass::indirect, Technique::vc, value * arrives,
                v.state.dispersed || other.dispersed || eye.dispersed || light.dispersed);
  }

  void merge(const SurfaceVertex& v, const SubpathDensities& densities) {
    constexpr float flatness = 0.2f;  // of the search volume: its half height over the radius
    const float support = pass_.kernel.support(pass_.radius), support2 = support * support;
    const bool dispersed = v.state.dispersed || is_dispersive(v.at.bsdf);
    pass_.merge_map.for_each_near(v.at.position, support, [&](const MergePhoton& photon, const Point& p, float dist2) {
      if (v.state.depth + photon.depth - 1 > pass_.settings.max_depth) return;
      if (std::fabs(dot(p - v.at.position, v.at.normal)) > flatness * support) return;
      const Vec3 wo = v.at.shading.to_local(photon.wi);
      const Spectrum f = eval(v.at.bsdf, v.wi_local, wo, Transport::radiance);
      if (f.is_black()) return;
      const float weight = weight_merge(densities, {photon.vcm, 0, photon.vm}, pdf(v.at.bsdf, v.wi_local, wo),
                                        pdf(v.at.bsdf, wo, v.wi_local), pass_.techniques);
      const Spectrum light = v.state.beta * f * photon.power *
                             (weight * pass_.kernel.weight(dist2, support2) * shading_flux_ratio(v.at, photon.wi));
      layers_.add(class_of_merge(v.state, photon), Technique::vm, light, dispersed || photon.dispersed);
    });
  }
  static PathClass class_of_merge(const WalkState& state, const MergePhoton& photon) {
    if (state.non_delta > 0) return PathClass::indirect;
    if (photon.depth == 1) return PathClass::direct;
    return photon.caustic ? PathClass::caustic : PathClass::indirect;
  }

  const Pass& pass_;
  std::size_t light_path_;
  Sampler& sampler_;
  RayCounts& counts_;
  LightLayers& layers_;
  Subpath subpath_;
};

class VertexConnectionAndMerging final : public Integrator {
 public:
  VertexConnectionAndMerging(const Parameters& parameters, Switches switches)
      : switches_(switches), roulette_depth_(static_cast<int>(parameters.number("roulette-depth", 1, 1e6))) {
    if (!switches.merging) return;
    alpha_ = parameters.number("alpha", 1e-3, 1);
    radius_choice_ = RadiusChoice::from(parameters);
  }

  bool splats() const override { return switches_.connections; }
  bool has_techniques() const override { return true; }
  void prepare(const Scene& scene, const RenderSettings& settings) override {
    emission_probability_ = emission_probabilities(scene);
    if (!switches_.merging) return;
    constexpr double photons_of_first_merge = 3;  // few: they are merged at every vertex
    first_radius_ = choose_first_radius(scene, settings, radius_choice_, photons_of_first_merge).typical();
  }
  PassReport render_pass(const Scene& scene, const RenderSettings& settings, std::uint32_t pass, Film& film,
                         const PhaseObserver& begin) override;

 private:
  RayCounts trace_light_paths(const Pass& pass, const LightPaths& paths, Film& film);

  Switches switches_;
  int roulette_depth_;
  double alpha_ = 1;
  RadiusChoice radius_choice_;
  float first_radius_ = 0;
  std::vector<float> emission_probability_;
  LightVertices vertices_;
};

RayCounts VertexConnectionAndMerging::trace_light_paths(const Pass& pass, const LightPaths& paths, Film& film) {
  vertices_.resize(paths.total());
  std::vector<RayCounts> counts(vertices_.chunk_count());
  parallel_chunks(paths.total(), light_path_chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    LightVertices::Chunk& chunk = vertices_.chunk(c);
    chunk.clear();
    paths.for_each_in(begin, end, [&](const LightPath& path, Sampler& sampler) {
      walk_from_light(pass.scene, path, pass.draw.time, {.max_depth = pass.settings.max_depth}, pass.draw.w, sampler,
                      counts[c], LightVisitor(pass, path, sampler, counts[c], film, chunk));
      chunk.ends.push_back(static_cast<std::uint32_t>(chunk.vertices.size()));
    });
  });
  RayCounts sum;
  for (const RayCounts& c : counts) sum += c;
  return sum;
}

PassReport VertexConnectionAndMerging::render_pass(const Scene& scene, const RenderSettings& settings,
                                                   std::uint32_t pass_number, Film& film, const PhaseObserver& begin) {
  Sampler pass_sampler = Sampler::for_pass(settings.seed, pass_number);
  const PathDraw draw = draw_time_and_wavelengths(scene, settings.color, pass_sampler);
  begin(Phase::photons);
  const LightPaths paths(scene, {settings.seed, Stream::light, pass_number, settings.photons});
  const float radius = switches_.merging ? first_radius_ * RadiusSchedule{1, alpha_}.radius(pass_number) : 0.0f;
  const auto light_paths = static_cast<float>(paths.total());
  const float merging = light_paths * pi * radius * radius;
  MergeMap merge_map;
  const Kernel kernel{KernelShape::epanechnikov};
  const Pass pass{scene,
                  settings,
                  draw,
                  switches_,
                  {light_paths, merging, switches_.connections && merging > 0 ? 1 / merging : 0.0f},
                  emission_probability_,
                  vertices_,
                  merge_map,
                  kernel,
                  radius};
  PassReport report;
  report.rays = trace_light_paths(pass, paths, film);
  report.light_paths = paths.total();
  if (switches_.merging) {
    begin(Phase::build);
    merge_map = MergeMap(vertices_, kernel.support(radius));
    report.photons_stored = merge_map.size();
    report.photon_map_bytes = merge_map.memory_bytes();
    report.radius = radius;
  }
  begin(Phase::eye);
  const PixelWindow& window = settings.window;
  report.rays += for_each_pixel(
      window.x0, window.y0, window.width(), window.height(), [&](const PixelPlace& place, RayCounts& counts) {
        Sampler sampler = Sampler::for_pixel(settings.seed, Stream::camera, pixel_key(scene, place), pass_number);
        const EyeStart start = start_eye_path(scene, settings.filter, place, draw.time, sampler);
        sampler.seek(1);
        const auto light_path = std::min(static_cast<std::size_t>(sampler.next() * light_paths),
                                         std::max(paths.total(), std::size_t{1}) - 1);
        LightLayers layers(draw.w);
        walk_from_camera(scene, start.camera, {settings.max_depth, roulette_depth_}, draw.w, sampler, counts,
                         EyeVisitor(pass, light_path, sampler, counts, layers));
        film.add(place.index, layers.sample(start.filter_weight));
      });
  return report;
}

const ParameterInfo roulette_depth{"roulette-depth", "3",
                                   "scattering event from which Russian roulette may end an eye path, from 1"};
const ParameterInfo radius{"radius", "auto", "first radius of merging: auto, or a length in metres"};

template <bool connections, bool merging>
std::unique_ptr<Integrator> make(const Parameters& p) {
  return std::make_unique<VertexConnectionAndMerging>(p, Switches{connections, merging});
}

}  // namespace

IntegratorInfo vcm_info() {
  return {"vcm",
          "vertex connection and merging: bidirectional paths and photons under one weight; all kinds of light",
          "Georgiev et al. 2012; Hachisuka et al. 2012",
          {radius_reduction_info("0.75"), radius, roulette_depth},
          make<true, true>};
}

IntegratorInfo bdpt_info() {
  return {"bdpt",
          "bidirectional path tracing: unbiased; caustics, but not their reflections from small lights",
          "Veach 1997; Lafortune & Willems 1993",
          {roulette_depth},
          make<true, false>};
}

IntegratorInfo bpm_info() {
  return {"bpm",
          "bidirectional photon mapping: photons merged at every vertex of the eye path",
          "Vorba 2011; Georgiev et al. 2012",
          {radius_reduction_info("0.75"), radius, roulette_depth},
          make<false, true>};
}

}  // namespace lanthorn
