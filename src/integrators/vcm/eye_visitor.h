// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Step 3 of vertex connection and merging: eye paths.
#pragma once

#include <cstdint>

#include "base/prefetch.h"
#include "integrators/vcm/eye_path_log.h"
#include "integrators/vcm/vcm_pass.h"
#include "path/connections.h"
#include "path/depth.h"
#include "path/light_layers.h"
#include "photon/flux_classes.h"
#include "photon/gather/disc_tests.h"

namespace lanthorn {

/// An answer of `EyeVisitor`: whether the walk continues, and whether by delta lobes alone.
struct EyeContinuation : Continuation {
  bool by_delta_alone = false;

  WalkShare towards(float pdf) const { return {1, goes_on && (!by_delta_alone || pdf == infinity) ? 1.0f : 0.0f}; }
};

/// Finds the light of an eye path by all techniques except connections to the lens.
class EyeVisitor {
 public:
  // The path starts (TR eqs. 31-33).
  EyeVisitor(const PathContext& path, const VcmPass& pass, const Vec2& raster, LightLayers& layers,
             EyePathLog* log = nullptr)
      : path_(path),
        pass_(pass),
        bidirectional_(pass.bidirectional_at(raster, pass.effort.at(raster))),
        log_(log),
        raster_(raster),
        layers_(layers),
        subpath_(pass.bidirectional.techniques) {
    if (pass.connects() && bidirectional_.techniques.connections > 0) {
      partner_ = pass.partner(path.sampler);
      for (const LightVertex& vertex : pass.light_path(partner_)) prefetch(vertex);
    }
    subpath_.begin_at_lens(pass.job.view.camera);
  }

  // It has come to a vertex (TR eqs. 34-36; through delta lobes eqs. 53-55).
  EyeContinuation operator()(const SurfaceVertex& v) {
    layers_.see(v);
    subpath_.arrive(path_, v);
    count_ray(v.state);
    if (pass_.is_first_block() && hits_count(v.state) && pass_.shows(0, v.state.depth + 1)) add_hits(v, subpath_);
    if (!v.may_scatter) return {Continuation::stop()};
    if (!looks_for_light(v.state)) return {Continuation::go_on(), true};
    if (has_non_delta(v.at.bsdf)) {
      if (pass_.connects()) connect_all(v);
      if (bidirectional_.techniques.merging > 0 && merges_at(v.at)) merge(v);
    }
    return {Continuation::go_on()};
  }
  Continuation operator()(const MediumVertex& v) {
    layers_.see(v);
    subpath_.arrive(path_, v);
    count_ray(v.state);
    if (!v.may_scatter || !looks_for_light(v.state)) return Continuation::stop();
    if (pass_.connects()) connect_all(v);
    if (merges_in_media() && subpath_.coherence() > 0) {
      count(&EyeWork::media_lookups, v.state);
      pass_.volume_merges->add_at(volume_context(), v);
    }
    return Continuation::go_on();
  }
  void operator()(const FlownSegment& flight) {
    if (flight.state.medium == MediumId::vacuum) return;
    layers_.see(flight);
    if (merges_in_media() && looks_for_light(flight.state)) {
      subpath_.depart(flight);
      if (subpath_.coherence() > 0) {
        count(&EyeWork::media_lookups, flight.state);
        pass_.volume_merges->add_along(volume_context(), flight);
      }
    }
    subpath_.fly(flight);
  }
  // It hits a light (TR eqs. 42, 43).
  void operator()(const EmissionVertex& v) {
    const bool is_light = path_.scene.volume_light(v.state.medium).has_value();
    if (!pass_.is_first_block() || (is_light && !hits_count(v.state)) || !pass_.shows(0, v.state.depth + 2)) return;
    Subpath to_medium = subpath_;
    to_medium.escape(v.state, v.direction, false);
    add_hits(v, to_medium);
  }
  void operator()(const EscapeVertex& v) {
    count_ray(v.state);
    if (!pass_.is_first_block() || !hits_count(v.state) || !pass_.shows(0, v.state.depth + 2)) return;
    subpath_.escape(v.state, v.direction);
    add_hits(v, subpath_);
  }

  /// Whether it has looked for photons on a surface.
  bool has_merged() const { return has_merged_; }

 private:
  // With merging alone, the walk finds the light that no photon brings: seen directly or through delta scatterings.
  bool hits_count(const WalkState& state) const { return pass_.connects() || state.non_delta == 0; }

  bool merges_in_media() const { return pass_.volume_merges && bidirectional_.techniques.volume_part > 0; }

  template <class Vertex>
  void add_hits(const Vertex& v, const Subpath& subpath) {
    Spectrum sum;
    hit_lights(path_, bidirectional_, v, subpath, [&](const Contribution& hit) {
      const Spectrum light = hit.weighted(bidirectional_.techniques);
      sum += light;
      note(light, hit.dispersed, hit.densities, &TechniqueDensities::walk);
    });
    layers_.add_hit(v, sum, technique::hit);
  }
  void add(const Contribution& found, PathClass path_class, std::size_t part, Technique technique) {
    const Spectrum light = found.weighted(bidirectional_.techniques);
    layers_.add(path_class, part, light, found.dispersed);
    note(light, found.dispersed, found.densities, technique);
  }
  void note(const Spectrum& light, bool dispersed, const TechniqueSum& densities, Technique technique) {
    if (log_) log_->found.push_back({flux_of(light, dispersed, path_.w), densities, technique});
  }

  // Whether the path connects and merges at its current vertex or flight.
  bool looks_for_light(const WalkState& state) const {
    return state.non_delta == 0 || bidirectional_.techniques.goes_on;
  }

  // Counts rays that short eye paths trace, too; the rays of the whole walk are counted elsewhere.
  void count_ray(const WalkState& arrived) {
    if (log_ && arrived.non_delta <= 1) ++log_->short_work.rays;
  }
  void count(double EyeWork::*work, const WalkState& state) {
    if (log_) log_->count(work, state.non_delta == 0);
  }

  // Next-event estimation (TR eqs. 44, 45), and vertex connection (TR eqs. 40, 41).
  template <class Vertex>
  void connect_all(const Vertex& v) {
    const int eye_vertices = v.state.depth + 1;
    count(&EyeWork::next_events, v.state);
    if (pass_.is_first_block() && pass_.shows(1, eye_vertices)) {
      if (const auto direct = next_event(path_, bidirectional_, v, subpath_))
        add(*direct, class_of_next_event(v.state), technique::nee, &TechniqueDensities::walk);
    }
    const auto connections = static_cast<int>(bidirectional_.techniques.connections);
    for (int i = 0; i < connections; ++i)
      for (const LightVertex& other : pass_.light_path(pass_.partner(partner_, i, connections))) {
        if (!may_connect(path_.scene, v, other.at.position, other.scatterings, pass_.max_depth()) ||
            !pass_.shows(other.depth + 1, eye_vertices))
          continue;
        if (const auto connected = connect(path_, bidirectional_, v, subpath_, other))
          add(*connected, PathClass::indirect, technique::vc, &TechniqueDensities::connections);
        count(&EyeWork::connections, v.state);
      }
  }

  // Vertex merging (TR eqs. 38, 39): a density estimate of the radiance from the photons (Georgiev et al. 2012, eq.
  // 10), with a weight for each. Photons of all flux classes are weighted with the first class's radius, so that the
  // weights of a path's techniques sum to one.
  void merge(const SurfaceVertex& v) {
    const GatherVertex gather(v);
    const Techniques& t = bidirectional_.techniques;
    const bool scattered = v.state.non_delta > 0;
    UniformityTests* const tests = has_merged_ ? nullptr : pass_.uniformity;
    const std::uint32_t pixel = tests ? pass_.radii.pixel_at(raster_) : 0;
    const auto add = [&](const MergePhoton& photon, const PhotonHit& hit, const PlaceInDisc& place) {
      const SubpathEnd at_eye = end_of_eye_path(subpath_.densities(), hit.pdf_reverse, scattered);
      const SubpathEnd at_light =
          end_of_light_path(photon.densities, hit.pdf, !photon.caustic, subpath_.coherence_beyond());
      const TechniqueSum densities = sum_of_merge(at_eye, at_light, t);
      const Spectrum light = v.state.beta * hit.f * photon.power * (densities.weight(t) * place.density * hit.ratio);
      const bool is_dispersed = gather.is_dispersed(photon.dispersed);
      layers_.add(class_of_merge(v.state, photon.direct, photon.caustic), technique::vm, light, is_dispersed);
      layers_.add_bias(merge_kernel.bias_share(place.u) * light, is_dispersed);
      note(light, is_dispersed, densities, &TechniqueDensities::merging);
      count(&EyeWork::merges, v.state);
      if (tests) tests->count(pixel, v.at.shading.to_local(place.offset), place.u);
    };
    if (tests && tests->seeks_obstacles() && pass_.is_first_block() &&
        !is_flat_and_clear(path_, v, pass_.radii.at(raster_)))
      tests->note_obstacle(pixel);
    has_merged_ = true;
    count(&EyeWork::lookups, v.state);
    pass_.surface_merges->for_each_at(gather, raster_, pass_.max_depth(), add);
  }
  VolumeMergeContext volume_context() const {
    return {path_, bidirectional_, subpath_, pass_.max_depth(), layers_, log_};
  }

  const PathContext& path_;
  const VcmPass& pass_;
  Bidirectional bidirectional_;
  EyePathLog* log_;
  const Vec2 raster_;
  std::size_t partner_ = 0;
  bool has_merged_ = false;
  LightLayers& layers_;
  Subpath subpath_;
};

}  // namespace lanthorn
