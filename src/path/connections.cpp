// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/connections.h"

#include <cmath>

#include "path/transmittance.h"

namespace lanthorn {

namespace {

// Scattering at one end of a connection: from the previous vertex of its subpath towards the other end.
struct End {
  Spectrum f;                      // times the cosine of this end's transport
  float forward = 0, reverse = 0;  // densities per solid angle: towards the other end, and back to the previous vertex
  float cos = 1;                   // factor that makes a density from the other end one per area
  float merging = 0;
  bool dispersed = false;
};

End eye_end(const Bidirectional& pass, const SurfaceVertex& v, const Direction& direction) {
  const Vec3 wo = v.at.shading.to_local(direction);
  const Spectrum f = eval(v.at.bsdf, v.wi_local, wo, Transport::radiance);
  if (f.is_black()) return {};
  return {f * cosine(v.at.bsdf, wo),         pdf(v.at.bsdf, v.wi_local, wo), pdf_reverse(v.at.bsdf, v.wi_local, wo),
          geometric_cosine(v.at, direction), pass.merging_at(v.at),          is_dispersive(v.at.bsdf)};
}
End eye_end(const Bidirectional&, const MediumVertex& v, const Direction& direction) {
  const float p = phase(v.phase, v.wi, direction);
  return {Spectrum(p), p, p, 1, 0, false};
}
End light_end(const Bidirectional& pass, const LightVertex& v, const Direction& direction) {
  if (v.phase) {
    const float p = phase(*v.phase, v.wi, direction);
    return {Spectrum(p), p, p, 1, 0, false};
  }
  const Vec3 wo = v.at.shading.to_local(direction);
  const Spectrum f = eval(v.at.bsdf, v.wi_local, wo, Transport::importance);
  if (f.is_black()) return {};
  const float cos = geometric_cosine(v.at, direction);
  return {f * (cos * shading_flux_ratio(v.at, v.wi, v.wi_local)),
          pdf(v.at.bsdf, v.wi_local, wo),
          pdf_reverse(v.at.bsdf, v.wi_local, wo),
          cos,
          v.depth > 1 ? pass.merging_at(v.at) : 0.0f,
          is_dispersive(v.at.bsdf)};
}

// Reverse-direction terms of the MIS weight, for light that arrives at the vertex from `direction`.
struct Backwards {
  float cos = 1;      // factor that makes a density from there one per area
  float reverse = 0;  // density per solid angle of scattering from there to the previous vertex
};
Backwards backwards(const SurfaceVertex& v, const Direction& direction) {
  return {geometric_cosine(v.at, direction), pdf_reverse(v.at.bsdf, v.wi_local, v.at.shading.to_local(direction))};
}
Backwards backwards(const MediumVertex& v, const Direction& direction) { return {1, phase(v.phase, v.wi, direction)}; }

float merging_at(const Bidirectional& pass, const SurfaceVertex& v) { return pass.merging_at(v.at); }
float merging_at(const Bidirectional&, const MediumVertex&) { return 0; }

LightVertex keep_at(const SurfacePoint& at, const Direction& wi, const Vec3& wi_local,
                    const std::optional<HenyeyGreenstein>& phase, const WalkState& state, const Subpath& subpath) {
  return {at,
          wi,
          wi_local,
          phase,
          state.beta,
          subpath.densities(),
          state.medium,
          state.depth,
          state.non_delta == 0,
          state.dispersed,
          static_cast<std::uint32_t>(subpath.trail_begin())};
}

template <class Vertex>
float weight_of(const PathContext& path, const Bidirectional& pass, const Vertex& v, const NextEvent& event,
                const Subpath& subpath) {
  const Light& light = path.scene.lights()[event.light];
  const LightSample& l = event.sample;
  const auto [cos, reverse] = backwards(v, l.wi);
  const bool on_surface = has_surface(light), far = is_of_rays(light);
  const EmissionPdf emission = pdf_emission(light, {l.position, l.normal, Vec2(0)}, -l.wi);
  // Next-event estimation always chooses the position of a point light: density 1, which is distance² per solid angle.
  const float pdf = event.pmf * l.pdf * (on_surface || far ? 1.0f : sqr(l.distance));
  const float cos_light = on_surface ? std::fabs(dot(l.normal, l.wi)) : 1.0f;
  const float chosen = pass.emission_probability[event.light];
  const float pdf_walk = l.delta ? 0.0f : event.pdf_walk;
  if (!pass.techniques.correlated()) {
    const float ratio = chosen * emission.position * emission.direction * cos / (pdf * cos_light);
    return weight_next_event(subpath.densities(), event.pmf * l.pdf, pdf_walk, ratio, reverse, pass.techniques);
  }
  const float to_light = far ? 1.0f : cos_light / sqr(l.distance), to_eye = far ? cos : cos / sqr(l.distance);
  const TrailVertex z{.arrives = chosen * (far ? emission.direction : emission.position), .direct = pdf * to_light};
  return weight_of_joined(subpath.trail(), {(far ? emission.position : emission.direction) * to_eye, reverse}, {&z, 1},
                          {pdf_walk * to_light, {}}, pass.techniques, subpath.first_distance());
}

// An eye walk has hit the light at z, coming from x_k. `direct` and `geometry` convert densities at z from per solid
// angle to per area; both are 1 at infinity.
float weight_of_emission(const PathContext& path, const Bidirectional& pass, const Subpath& subpath,
                         std::uint32_t light, float direct, float by_eye, const EmissionPdf& emission,
                         std::span<const TrailVertex> eye, float geometry) {
  const float chosen = pass.emission_probability[light];
  if (!pass.techniques.correlated())
    return weight_hit(subpath.densities(), direct, chosen * emission.position * emission.direction, pass.techniques);
  const bool far = is_of_rays(path.scene.lights()[light]);
  const TrailVertex z{
      .arrives = chosen * (far ? emission.direction : emission.position), .back = by_eye, .direct = direct};
  return weight_of_hit(eye, (far ? emission.position : emission.direction) * geometry, z, pass.techniques,
                       subpath.first_distance());
}

template <class Vertex>
DirectLight estimate_next_event(const PathContext& path, const Bidirectional& pass, const Vertex& v,
                                const Subpath& subpath) {
  path.sampler.seek(visitor_dimensions(v.state.depth));
  const auto event = sample_next_event(path, v);
  if (!event) return {};
  return {event->radiance * weight_of(path, pass, v, *event, subpath), event->dispersed};
}

template <class Vertex>
DirectLight connect_ends(const PathContext& path, const Bidirectional& pass, const Vertex& v, const Subpath& subpath,
                         const LightVertex& other, std::span<const TrailVertex> trail) {
  const Vec3 way = other.at.position - position_of(v);
  const float distance2 = length_squared(way);
  if (!(distance2 > 0)) return {};
  const float distance = std::sqrt(distance2);
  const Direction direction = way / distance;
  const End eye = eye_end(pass, v, direction);
  if (eye.f.is_black()) return {};
  const End light = light_end(pass, other, -direction);
  if (light.f.is_black()) return {};
  const float to_light = eye.forward * light.cos / distance2, to_eye = light.forward * eye.cos / distance2;
  const float weight = pass.techniques.correlated()
                           ? weight_of_joined(subpath.trail(), {to_eye, eye.reverse}, trail, {to_light, light.reverse},
                                              pass.techniques, subpath.first_distance())
                           : weight_connection(subpath.densities(), other.densities, to_light, to_eye, eye.reverse,
                                               light.reverse, eye.merging, light.merging, pass.techniques);
  const Spectrum value =
      v.state.beta * eye.f * light.f * other.beta * (pass.techniques.light_paths * weight / distance2);
  if (value.is_black()) return {};
  const Spectrum arrives =
      transmittance(path, ray_to(v, direction, other.at.position, distance), medium_towards(v, direction),
                    path.sampler.generator(visitor_dimensions(v.state.depth)));
  return {value * arrives, v.state.dispersed || other.dispersed || eye.dispersed || light.dispersed};
}

template <class Vertex>
float weight_of_lens(const Bidirectional& pass, const Vertex& v, const Subpath& subpath, const LensLight& seen) {
  const auto [cos, reverse] = backwards(v, -seen.from_lens.direction);
  const float density = pass.view.camera.density_at(seen.from_lens, seen.distance) * cos;
  return pass.techniques.correlated()
             ? weight_of_joined({}, {}, subpath.trail(), {density, reverse}, pass.techniques, seen.distance)
             : weight_lens(subpath.densities(), density, reverse, v.state.depth > 1 ? merging_at(pass, v) : 0.0f,
                           pass.techniques);
}

}  // namespace

LightVertex keep_vertex(const SurfaceVertex& v, const Subpath& subpath) {
  return keep_at(v.at, v.wi, v.wi_local, {}, v.state, subpath);
}

LightVertex keep_vertex(const MediumVertex& v, const Subpath& subpath) {
  SurfacePoint at;
  at.position = v.position;
  at.time = v.time;
  return keep_at(at, v.wi, Vec3(0), v.phase, v.state, subpath);
}

Spectrum hit_emitter(const PathContext& path, const Bidirectional& pass, const SurfaceVertex& v,
                     const Subpath& subpath) {
  if (!v.at.light) return {};
  const Light& light = path.scene.lights()[*v.at.light];
  const EmitterHit at{v.at.position, v.at.normal, v.at.uv};
  const Spectrum radiance = emitted(light, at, v.wi, path.w);
  if (radiance.is_black()) return {};
  if (v.state.depth == 1) return v.state.beta * radiance;
  const Vec3 way = v.at.position - v.state.previous;
  const float direct =
      next_event_density(path.scene, *v.at.light, v.state.previous, v.state.previous_normal, at, -v.wi) *
      std::fabs(dot(v.at.normal, v.wi)) / length_squared(way);
  const EmissionPdf emission = pdf_emission(light, at, v.wi);
  const std::span<const TrailVertex> trail = subpath.trail();
  const float weight =
      trail.empty() ? weight_of_emission(path, pass, subpath, *v.at.light, direct, 0, emission, {}, 0)
                    : weight_of_emission(path, pass, subpath, *v.at.light, direct, trail.back().arrives, emission,
                                         trail.first(trail.size() - 1), trail[trail.size() - 2].geometry);
  return v.state.beta * radiance * weight;
}

Spectrum hit_environment(const PathContext& path, const Bidirectional& pass, const EscapeVertex& v,
                         const Subpath& subpath) {
  Spectrum sum;
  for (const std::uint32_t index : path.scene.infinite_lights()) {
    const Light& light = path.scene.lights()[index];
    const Spectrum radiance = emitted_infinite(light, v.state.previous, v.direction, path.w);
    if (radiance.is_black()) continue;
    float weight = 1;
    if (v.state.depth > 0) {
      const float direct =
          next_event_density(path.scene, index, v.state.previous, v.state.previous_normal, {}, v.direction);
      const EmissionPdf emission = pdf_emission(light, {v.state.previous, Normal(0), Vec2(0)}, -v.direction);
      weight = weight_of_emission(path, pass, subpath, index, direct, subpath.last_step().pdf, emission,
                                  subpath.trail(), subpath.last_step().cos);
    }
    sum += v.state.beta * radiance * weight;
  }
  return sum;
}

Spectrum hit_glow(const PathContext& path, const Bidirectional& pass, const EmissionVertex& v, Subpath subpath) {
  const WalkState& state = v.state;
  const std::optional<std::uint32_t> index = path.scene.volume_light(state.medium);
  if (!index || state.depth == 0) return state.beta * v.radiance;
  subpath.escape(state, v.direction);
  const Light& light = path.scene.lights()[*index];
  const float direct = next_event_density(path.scene, *index, state.previous, state.previous_normal, {}, v.direction);
  const EmissionPdf emission = pdf_emission(light, {state.previous, Normal(0), Vec2(0)}, -v.direction);
  const float weight = weight_of_emission(path, pass, subpath, *index, direct, subpath.last_step().pdf, emission,
                                          subpath.trail(), subpath.last_step().cos);
  return state.beta * v.radiance * weight;
}

DirectLight next_event(const PathContext& path, const Bidirectional& pass, const SurfaceVertex& v,
                       const Subpath& subpath) {
  return estimate_next_event(path, pass, v, subpath);
}

DirectLight next_event(const PathContext& path, const Bidirectional& pass, const MediumVertex& v,
                       const Subpath& subpath) {
  return estimate_next_event(path, pass, v, subpath);
}

DirectLight connect(const PathContext& path, const Bidirectional& pass, const SurfaceVertex& v, const Subpath& subpath,
                    const LightVertex& other, std::span<const TrailVertex> trail) {
  return connect_ends(path, pass, v, subpath, other, trail);
}

DirectLight connect(const PathContext& path, const Bidirectional& pass, const MediumVertex& v, const Subpath& subpath,
                    const LightVertex& other, std::span<const TrailVertex> trail) {
  return connect_ends(path, pass, v, subpath, other, trail);
}

float weight_of_seen(const Bidirectional& pass, const SurfaceVertex& v, const Subpath& subpath, const LensLight& seen) {
  return weight_of_lens(pass, v, subpath, seen);
}

float weight_of_seen(const Bidirectional& pass, const MediumVertex& v, const Subpath& subpath, const LensLight& seen) {
  return weight_of_lens(pass, v, subpath, seen);
}

}  // namespace lanthorn
