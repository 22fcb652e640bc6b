// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/connections.h"

#include <cmath>

#include "path/depth.h"
#include "path/transmittance.h"

namespace lanthorn {

namespace {

// A vertex of a subpath as MIS weights see it for light that arrives from another vertex.
struct Arrival {
  float cos = 1;         // factor that makes a density from there one per area
  float reverse = 0;     // density per solid angle of scattering from there to the previous vertex
  float merging = 0;     // on surfaces
  FlightDensity flight;  // of the subpath
  float sin = -1;        // in a medium, of the angle between both flights

  // Density of the other kind of walk arriving here, divided by its density per solid angle and by 1 / distance².
  float density(float pass) const { return cos * pass * flight.collision; }
  // `volume` as this subpath's kind of walk sees it (`VolumeMerging::reversed`); `coherence` of the eye path before.
  float volume_merging(const VolumeMerging& volume, float pass, float coherence) const {
    return sin < 0 ? 0.0f : coherence * volume.all(flight.collision, pass, flight.pass, sin);
  }
};

Arrival in_medium(const FlightDensity& flight, const Direction& wi, const Direction& direction, float density) {
  return {1, density, 0, flight, length(cross(wi, direction))};
}
Arrival arrival(const Bidirectional& pass, const SurfaceVertex& v, const Direction& direction, const FlightDensity& f,
                Transport transport) {
  return {
      arrival_cosine(v.at, v.wi, direction),
      evaluate(v.at.bsdf, v.wi_local, v.at.shading.to_local(direction), transport, {.pdf_reverse = true}).pdf_reverse,
      pass.merging_at(v.at), f};
}
Arrival arrival(const Bidirectional&, const MediumVertex& v, const Direction& direction, const FlightDensity& f,
                Transport) {
  return in_medium(f, v.wi, direction, phase(v.phase, v.wi, direction));
}

// Scattering at one end of a connection: from the previous vertex of its subpath towards the other end.
struct End : Arrival {
  Spectrum f;         // times the cosine of this end's transport
  float forward = 0;  // density per solid angle, towards the other end
  bool dispersed = false;
};

End eye_end(const Bidirectional& pass, const SurfaceVertex& v, const Direction& direction,
            const FlightDensity& flight) {
  const Vec3 wo = v.at.shading.to_local(direction);
  const BsdfValue value = evaluate(v.at.bsdf, v.wi_local, wo, Transport::radiance);
  if (value.f.is_black()) return {};
  return {{arrival_cosine(v.at, v.wi, direction), value.pdf_reverse, pass.merging_at(v.at), flight},
          value.f * cosine(v.at.bsdf, wo),
          value.pdf,
          is_dispersive(v.at.bsdf)};
}
// In a medium, both densities of the phase function are the same.
End end_in_medium(const HenyeyGreenstein& medium, const Direction& wi, const Direction& direction,
                  const FlightDensity& flight) {
  const float p = phase(medium, wi, direction);
  return {in_medium(flight, wi, direction, p), Spectrum(p), p, false};
}
End eye_end(const Bidirectional&, const MediumVertex& v, const Direction& direction, const FlightDensity& flight) {
  return end_in_medium(v.phase, v.wi, direction, flight);
}
// Photons straight from a light are not merged: next-event estimation finds their light.
End light_end(const Bidirectional& pass, const LightVertex& v, const Direction& direction) {
  if (v.phase) return end_in_medium(*v.phase, v.wi, direction, v.flight);
  const Vec3 wo = v.at.shading.to_local(direction);
  const BsdfValue value = evaluate(v.at.bsdf, v.wi_local, wo, Transport::importance);
  if (value.f.is_black()) return {};
  const float merging = v.depth > 1 ? pass.merging_at(v.at) : 0.0f;
  const float flux_cosine = geometric_cosine(v.at, direction) * shading_flux_ratio(v.at, v.wi, v.wi_local);
  return {{area_cosine(v.at, direction), value.pdf_reverse, merging, v.flight},
          value.f * flux_cosine,
          value.pdf,
          is_dispersive(v.at.bsdf) && !v.has_own_dispersion};
}

// The members of a LightVertex that differ between surfaces and media.
const SurfacePoint& place_of(const SurfaceVertex& v) { return v.at; }
SurfacePoint place_of(const MediumVertex& v) {
  SurfacePoint at;
  at.position = v.position;
  at.time = v.time;
  return at;
}
Vec3 wi_local_of(const SurfaceVertex& v) { return v.wi_local; }
Vec3 wi_local_of(const MediumVertex&) { return Vec3(0); }
std::optional<HenyeyGreenstein> phase_of(const SurfaceVertex&) { return {}; }
std::optional<HenyeyGreenstein> phase_of(const MediumVertex& v) { return v.phase; }

// True for direct light on surfaces, which `EmissionDensities` treats separately: one scattering, at a receiver with a
// normal.
bool is_direct(int scatterings, const Normal& receiver) { return scatterings == 1 && receiver != Normal(0); }

// A ray on which a light path may start.
struct EmittedRay {
  std::uint32_t light;
  EmitterHit origin;  // of lights without surface any point of the ray
  Direction direction;
};
// Density with which light paths start on the ray, per area times per solid angle. `of_direct_light`: the path is
// direct light.
float density_of_start(const PathContext& path, const Bidirectional& pass, const EmittedRay& ray,
                       bool of_direct_light) {
  const EmissionPdf pdf = pdf_emission(path.scene.lights()[ray.light], ray.origin, ray.direction);
  const float factor = of_direct_light ? pass.emission.factor_of_direct_light(ray.light, ray.origin, ray.direction)
                                       : pass.emission.factor(ray.light, ray.origin, ray.direction);
  return factor * pdf.position * pdf.direction;
}

template <class Vertex>
TechniqueSum densities_of(const PathContext& path, const Bidirectional& pass, const Vertex& v, const NextEvent& event,
                          const Subpath& subpath) {
  const Light& light = path.scene.lights()[event.light];
  const LightSample& l = event.sample;
  const Arrival at = arrival(pass, v, l.wi, subpath.flight(), Transport::radiance);
  const float passes = FlightDensity::passing(event.optical_depth);
  const bool on_surface = has_surface(light), far = is_of_rays(light);
  // Next-event estimation always chooses the position of a point light: density 1, which is distance² per solid angle.
  const float pdf = event.pmf * l.pdf * (on_surface || far ? 1.0f : sqr(l.distance));
  const float cos_light = on_surface ? std::fabs(dot(l.normal, l.wi)) : 1.0f;
  const float pdf_walk = l.delta ? 0.0f : event.pdf_walk * passes;
  const float merging = at.volume_merging(pass.techniques.volume, passes, subpath.coherence());
  ConnectedEnd at_eye{end_of_eye_path(subpath.densities(), at.reverse, v.state.non_delta > 0), 0, 0, merging};
  if (at_eye.has_other_techniques(pass.techniques)) {
    // Samples of far lights have no position: any point of the ray gives its densities.
    const EmittedRay ray{event.light, {far ? position_of(v) : l.position, l.normal, Vec2(0)}, -l.wi};
    const bool direct = is_direct(v.state.depth, receiver_normal(v));
    at_eye.arrival = density_of_start(path, pass, ray, direct) * at.density(passes) / (pdf * cos_light);
  }
  return sum_of_next_event(at_eye, event.pmf * l.pdf, pdf_walk, pass.techniques);
}

// `passes`: probability that a walk passes the way between both ends.
TechniqueSum densities_of(const Bidirectional& pass, const WalkState& state, const Subpath& subpath, const End& eye,
                          const LightVertex& other, const End& light, float distance2, float passes) {
  const Techniques& t = pass.techniques;
  const float to_light = eye.forward * light.density(passes) / distance2;
  const float to_eye = light.forward * eye.density(passes) / distance2;
  const float coherence = subpath.coherence_beyond();
  const ConnectedEnd at_eye{end_of_eye_path(subpath.densities(), eye.reverse, state.non_delta > 0), to_eye, eye.merging,
                            eye.volume_merging(t.volume, passes, subpath.coherence())};
  const ConnectedEnd at_light{
      end_of_light_path(other.densities, light.reverse, !other.caustic, coherence * other.coherence), to_light,
      light.merging, light.volume_merging(t.volume.reversed(), passes, coherence)};
  return sum_of_connection(at_eye, at_light, t);
}

}  // namespace

template <class Vertex>
LightVertex keep_vertex(const Vertex& v, const Subpath& subpath) {
  const SurfacePoint& at = place_of(v);
  return {at,
          v.wi,
          wi_local_of(v),
          phase_of(v),
          distance(at.position, v.state.previous),
          v.state.beta,
          subpath.densities(),
          subpath.flight(),
          subpath.coherence_beyond(),
          v.state.medium,
          v.state.depth,
          v.state.scatterings(),
          v.state.non_delta == 0,
          v.state.dispersed};
}

std::optional<LightBeam> keep_beam(const PathContext& path, const FlownSegment& flight, float time, float share,
                                   Subpath& subpath) {
  const WalkState& state = flight.state;
  const Segment& way = flight.segment;
  const Medium& medium = path.scene.medium(state.medium);
  const float length = scattering_length(medium, {way.origin, way.direction, flight.reach}, path.w);
  if (!(length > 0)) return {};
  const int depth = state.depth + 1;
  const auto [beta, dispersed] = LightToMeet::of(state.beta / share, state.dispersed, path.w);
  return LightBeam{way.origin,
                   way.direction,
                   length,
                   time,
                   state.medium,
                   beta,
                   subpath.depart(flight),
                   subpath.start(),
                   depth,
                   scatterings_on_flight(path.scene, state),
                   depth > 1 && state.non_delta == 0,
                   dispersed};
}

TechniqueSum densities_of_hit(const PathContext& path, const Bidirectional& pass, const WalkState& state,
                              const Subpath& subpath, const LightHit& hit) {
  if (hit.scatterings == 0 || !hit.light) return {.within = {.walk = 1}};  // no other technique finds it
  const Direction to_eye = -hit.direction;
  float direct =
      next_event_density(path.scene, *hit.light, state.previous, state.previous_normal, hit.at, hit.direction);
  if (has_surface(path.scene.lights()[*hit.light]))
    direct = direct * std::fabs(dot(hit.at.normal, to_eye)) / distance_squared(hit.at.position, state.previous);
  const bool is_of_direct_light = !state.last_delta && is_direct(hit.scatterings, state.previous_normal);
  const float emission = has_light_paths(subpath.densities(), pass.techniques)
                             ? density_of_start(path, pass, {*hit.light, hit.at, to_eye}, is_of_direct_light)
                             : 0.0f;
  return sum_of_hit(subpath.densities(), direct, emission, state.non_delta, pass.techniques);
}

template <class Vertex>
std::optional<Contribution> next_event(const PathContext& path, const Bidirectional& pass, const Vertex& v,
                                       const Subpath& subpath) {
  std::optional<Contribution> result;
  path.sampler.seek(visitor_dimensions(v.state.depth));
  const std::optional<NextEvent> event = sample_next_event(path, v);
  if (!event) return result;
  Contribution& found = result.emplace();
  found.light = event->radiance;
  found.dispersed = event->dispersed;
  found.densities = densities_of(path, pass, v, *event, subpath);
  return result;
}

template <class Vertex>
std::optional<Contribution> connect(const PathContext& path, const Bidirectional& pass, const Vertex& v,
                                    const Subpath& subpath, const LightVertex& other) {
  std::optional<Contribution> result;
  const Vec3 to_other = other.at.position - position_of(v);
  const float distance2 = length_squared(to_other);
  if (!(distance2 > 0)) return result;
  const float distance = std::sqrt(distance2);
  const Direction direction = to_other / distance;
  const End eye = eye_end(pass, v, direction, subpath.flight());
  if (eye.f.is_black()) return result;
  const End light = light_end(pass, other, -direction);
  if (light.f.is_black()) return result;
  const Spectrum value = v.state.beta * eye.f * light.f * other.beta * (pass.techniques.light_paths / distance2);
  const SegmentEnd end = other.phase ? SegmentEnd{other.at.position} : end_at(other.at, position_of(v));
  if (value.is_black() || !may_leave(path, v, direction, end)) return result;
  const Passage way =
      passage(path, ray_to(v, direction, end), medium_towards(v, direction), visitor_dimensions(v.state.depth));
  if (way.transmittance.is_black()) return result;
  const float passes = FlightDensity::passing(way.optical_depth);
  Contribution& found = result.emplace();
  found.light = value * way.transmittance;
  found.dispersed = v.state.dispersed || other.dispersed || eye.dispersed || light.dispersed;
  found.densities = densities_of(pass, v.state, subpath, eye, other, light, distance2, passes);
  return result;
}

template <class Vertex>
TechniqueSum densities_of_seen(const Bidirectional& pass, const Vertex& v, const Subpath& subpath,
                               const LensLight& seen) {
  const Techniques& t = pass.techniques;
  const Arrival at = arrival(pass, v, -seen.from_lens.direction, subpath.flight(), Transport::importance);
  const float passes = FlightDensity::passing(seen.optical_depth);
  const float density = pass.view.camera.density_at(seen.from_lens, seen.distance) * at.density(passes);
  const SubpathDensities densities =
      is_direct(v.state.depth, receiver_normal(v)) ? subpath.densities_of_direct_light() : subpath.densities();
  return sum_of_lens(
      {end_of_light_path(densities, at.reverse, v.state.non_delta > 0, subpath.coherence_beyond()), density,
       v.state.depth == 1 ? 0.0f : at.merging, at.volume_merging(t.volume.reversed(), passes, 1)},
      t);
}

// Both kinds of vertices.
template LightVertex keep_vertex(const SurfaceVertex&, const Subpath&);
template std::optional<Contribution> next_event(const PathContext&, const Bidirectional&, const SurfaceVertex&,
                                                const Subpath&);
template std::optional<Contribution> connect(const PathContext&, const Bidirectional&, const SurfaceVertex&,
                                             const Subpath&, const LightVertex&);
template TechniqueSum densities_of_seen(const Bidirectional&, const SurfaceVertex&, const Subpath&, const LensLight&);
template LightVertex keep_vertex(const MediumVertex&, const Subpath&);
template std::optional<Contribution> next_event(const PathContext&, const Bidirectional&, const MediumVertex&,
                                                const Subpath&);
template std::optional<Contribution> connect(const PathContext&, const Bidirectional&, const MediumVertex&,
                                             const Subpath&, const LightVertex&);
template TechniqueSum densities_of_seen(const Bidirectional&, const MediumVertex&, const Subpath&, const LensLight&);

}  // namespace lanthorn
