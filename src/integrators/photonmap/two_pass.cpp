// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/photonmap/two_pass.h"

#include "photon/gather/photon_gather.h"

namespace lanthorn {

// One of the rays or shadow rays that start at a vertex, stratified over the vertex's rays and over the passes.
Sampler TwoPassVisitor::branch(const SurfaceVertex& vertex, int number, int rays) const {
  const std::uint64_t key = hash_words({context_.pixel_key, static_cast<std::uint64_t>(vertex.state.depth)});
  return Sampler::for_pixel(context_.job.settings.seed, Stream::gather, static_cast<std::uint32_t>(key),
                            context_.pass * static_cast<std::uint32_t>(rays) + static_cast<std::uint32_t>(number));
}

NarrowContinuation TwoPassVisitor::operator()(const SurfaceVertex& vertex) {
  const WalkState& state = vertex.state;
  if (!is_gather_ray_) layers.see(vertex);
  begin(term_of_hit(state, state.depth - 1));
  if (adds_hits(state)) layers.add_hit(vertex, hit_lights(path, vertex));
  if (volume_ && volume_->is_gathered()) return {volume_->follow_emission(path)};
  if (!vertex.may_scatter) return {Continuation::stop()};
  if (!has_non_delta(vertex.at.bsdf)) return {Continuation::go_on()};
  if (context_.settings.show != Show::image && !is_gather_ray_) {
    show(vertex);
    return {Continuation::stop()};
  }
  return state.non_delta == 0 ? estimate_by_terms(vertex) : read_map(vertex);
}

Continuation TwoPassVisitor::operator()(const MediumVertex& vertex) {
  const bool is_first = vertex.state.depth == 1;
  layers.see(vertex);
  begin(is_first ? Term::direct : Term::specular);
  if (!volume_) return PathVisitor::operator()(vertex);
  if (volume_->is_gathered()) return volume_->follow_emission(path);
  if (!vertex.may_scatter) return Continuation::stop();
  const MediumLight light = volume_->scatter(path, vertex, ray_light);
  layers.add(class_of_next_event(vertex.state), light.direct.radiance, light.direct.dispersed);
  add_photons(vertex.state, is_first, light.gathered);
  return Continuation::go_on();
}

// Adds the light of photons in a medium. `is_first`: the camera sees the medium directly, not through a surface.
void TwoPassVisitor::add_photons(const WalkState& state, bool is_first, const GatheredLight& light) {
  begin(is_first ? Term::caustic : Term::specular);
  layers.add(state.non_delta == 0 ? PathClass::caustic : PathClass::indirect, light.caustic, false);
  begin(is_first ? Term::diffuse : Term::specular);
  layers.add(PathClass::indirect, light.indirect, false);
}

// A surface that is seen directly or through mirrors and clear glass: accurate estimates.
NarrowContinuation TwoPassVisitor::estimate_by_terms(const SurfaceVertex& vertex) {
  const bool is_first = vertex.state.depth == 1;
  const LobeSplit split = split_lobes(vertex);
  const NarrowContinuation answer = narrow_lobes(split);
  begin(is_first ? Term::direct : Term::specular);
  next_events(vertex, answer, (context_.settings.gather_rays + 3) / 4);
  if (!split.is_all_narrow()) {
    begin(is_first ? Term::caustic : Term::specular);
    add_caustics(vertex, split);
    begin(is_first ? Term::diffuse : Term::specular);
    gather(vertex, split);
  }
  return answer;
}

// After a non-delta scattering: the global map is accurate enough for wide lobes.
NarrowContinuation TwoPassVisitor::read_map(const SurfaceVertex& vertex) {
  begin(Term::specular);
  const float distance2 = distance_squared(vertex.state.previous, vertex.at.position);
  const LobeSplit split = split_lobes(vertex);
  if (split.is_all_wide() && is_known(vertex.state) && distance2 < sqr(context_.settings.shortest))
    return continue_short_ray(vertex);
  const NarrowContinuation answer = NarrowContinuation::of(split);
  path.sampler.seek(visitor_dimensions(vertex.state.depth));
  if (answer.goes_on) {
    const DirectLight direct = next_event(path, vertex, answer);
    layers.add(PathClass::indirect, direct.radiance, direct.dispersed);
  }
  if (!split.is_all_narrow()) add_photons(vertex, split);
  return answer;
}

// The map's light, without the part that the walk finds.
void TwoPassVisitor::add_photons(const SurfaceVertex& vertex, const LobeSplit& split) {
  add_unlit_emission(path, vertex, split, layers);
  if (context_.reverse != nullptr) {
    context_.reverse->add(vertex, path.w, split, static_cast<Term>(layers.part()));
    return;
  }
  std::optional<Spectrum> light = precomputed(vertex);
  if (!light)
    light = estimate_radiance(context_.maps.global, vertex, context_.settings.global, path.w, MapShare{split}).light;
  layers.add(PathClass::indirect, vertex.state.beta * *light, false);
}

// Radiance of a purely diffuse surface from precomputed irradiance of its facet. Records include the photons' factor of
// dispersion only.
std::optional<Spectrum> TwoPassVisitor::precomputed(const SurfaceVertex& vertex) const {
  const bool is_diffuse = lambertian_reflectance(vertex.at.bsdf) != nullptr;
  if (!context_.maps.irradiance || !is_diffuse || vertex.state.dispersed) return {};
  const Normal& normal = vertex.at.normal;
  const auto irradiance =
      context_.maps.irradiance->find(vertex.at.position, dot(vertex.wi, normal) < 0 ? -normal : normal,
                                     context_.settings.global.radius, vertex.state.scatterings() - 1);
  if (!irradiance) return {};
  return albedo(vertex.at.bsdf, vertex.wi_local) * *irradiance * inv_pi;
}

// Secondary gathering: in corners, where the map's blur would be visible, one more ray replaces the look-up.
NarrowContinuation TwoPassVisitor::continue_short_ray(const SurfaceVertex& vertex) {
  next_events(vertex, {Continuation::stop()}, 1);
  add_caustics(vertex, LobeSplit::all_wide());
  ++known_;
  return {Continuation::go_on()};
}

void TwoPassVisitor::next_events(const SurfaceVertex& vertex, const NarrowContinuation& answer, int count) {
  const float part = 1 / static_cast<float>(count);
  for (int i = 0; i < count; ++i) {
    Sampler own = branch(vertex, i, context_.settings.gather_rays);
    Sampler& numbers = is_gather_ray_ ? path.sampler : own;
    numbers.seek(visitor_dimensions(vertex.state.depth));
    const DirectLight direct = direct_light(path.with(numbers), vertex, answer);
    layers.add(class_of_next_event(vertex.state), direct.radiance * part, direct.dispersed);
    if (answer.branches_to_sky()) add_sky(path.with(numbers), vertex, layers, part);
  }
}

// Where shadow photons agree, no shadow ray is traced.
DirectLight TwoPassVisitor::direct_light(const PathContext& sample, const SurfaceVertex& vertex,
                                         const NarrowContinuation& answer) const {
  const std::optional<ShadowPhotons>& shadows = context_.maps.shadows;
  if (!shadows) return next_event(sample, vertex, answer);
  std::optional<NextEvent> event = sample_unshadowed(sample, vertex);
  if (!event) return {};
  const Normal& normal = vertex.at.normal;
  const Normal side = dot(normal, event->sample.wi) < 0 ? -normal : normal;
  const Lighting lighting = shadows->at(vertex.at.position, side, event->light, context_.settings.global.radius);
  if (lighting == Lighting::unknown)
    event->radiance *= arriving(sample, vertex, *event);
  else
    ++sample.counts.spared;
  return lighting == Lighting::shadowed ? DirectLight{} : weighted(*event, walk_density(*event, answer));
}

void TwoPassVisitor::add_caustics(const SurfaceVertex& vertex, const LobeSplit& split) {
  const DensityEstimate estimate =
      estimate_radiance(context_.maps.caustic, vertex, context_.settings.caustic, path.w, MapShare{split});
  layers.add(vertex.state.non_delta == 0 ? PathClass::caustic : PathClass::indirect, vertex.state.beta * estimate.light,
             false);
}

void TwoPassVisitor::gather(const SurfaceVertex& vertex, const LobeSplit& split) {
  int rays = context_.settings.gather_rays;
  if (const IrradianceCache* cache = cache_for(context_.maps, vertex)) {
    if (const auto irradiance = cache->find(vertex.at.position, normal_of_light(vertex))) {
      const Spectrum& reflectance = *lambertian_reflectance(vertex.at.bsdf);
      layers.add(PathClass::indirect, vertex.state.beta * reflectance * *irradiance * inv_pi, false);
      return;
    }
    // Elsewhere records give smooth irradiance, so this gather traces as many rays as a record does.
    rays = context_.settings.cache->rays;
    ++*context_.misses;
  }
  const auto& guides = context_.maps.guides;
  const WideContinuation answer{{{}, guides ? guides->find(vertex) : Guidance{}}, split, 1 / static_cast<float>(rays)};
  for (int i = 0; i < rays; ++i) {
    Sampler own = branch(vertex, i, rays);
    const PathContext ray = path.with(own);
    branch_walk<Transport::radiance>(ray, vertex, answer,
                                     of_gather_ray({ray, layers}, context_, vertex.state.non_delta + 1));
  }
}

void TwoPassVisitor::show(const SurfaceVertex& vertex) {
  const Show what = context_.settings.show;
  if (what == Show::records) return show_records(vertex);
  if (what == Show::shadow) return show_shadows(vertex);
  const bool caustics = what == Show::caustic;
  const DensityEstimate estimate = estimate_radiance(caustics ? context_.maps.caustic : context_.maps.global, vertex,
                                                     caustics ? context_.settings.caustic : context_.settings.global,
                                                     path.w, [](const PhotonFlags&, float) { return 1.0f; });
  Spectrum value = vertex.state.beta * estimate.light;
  if (what == Show::radius) value = Spectrum(estimate.radius);
  if (what == Show::density)
    value = Spectrum(estimate.radius > 0 ? static_cast<float>(estimate.photons) * inv_pi / sqr(estimate.radius) : 0.0f);
  layers.add(caustics ? PathClass::caustic : PathClass::indirect, value, false);
}

// The share of lit photons: white where all are lit, black where all are in shadow.
void TwoPassVisitor::show_shadows(const SurfaceVertex& vertex) {
  const Normal side = dot(vertex.wi, vertex.at.normal) < 0 ? -vertex.at.normal : vertex.at.normal;
  const auto share = context_.maps.shadows->lit_share(vertex.at.position, side, context_.settings.global.radius);
  layers.add(PathClass::direct, vertex.state.beta * share.value_or(0), false);
}

// Radiance of a white surface by the cache's irradiance: in full at the records, a quarter of it elsewhere.
void TwoPassVisitor::show_records(const SurfaceVertex& vertex) {
  const IrradianceCache* cache = cache_for(context_.maps, vertex);
  if (cache == nullptr) return;
  const Point& p = vertex.at.position;
  const Normal normal = normal_of_light(vertex);
  const auto irradiance = cache->find(p, normal);
  if (!irradiance) return;
  const float pixels = 1 / context_.settings.cache->least;
  bool is_at_record = false;
  cache->for_each_valid(p, normal, cache->error(), [&](const IrradianceRecord& record, float) {
    const float pixel = record.least * cache->error() * pixels;
    is_at_record = is_at_record || distance_squared(p, record.position) < sqr(pixel);
  });
  layers.add(PathClass::indirect, vertex.state.beta * *irradiance * (is_at_record ? inv_pi : 0.25f * inv_pi), false);
}

}  // namespace lanthorn
