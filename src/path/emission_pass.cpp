// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/emission_pass.h"

#include "path/direct_light.h"
#include "path/eye_pass.h"
#include "path/walk.h"

namespace lanthorn {

namespace {

struct EmissionVisitor {
  const PathContext& path;
  const EyeShare& share;
  LightLayers& layers;

  Continuation operator()(const MediumVertex& vertex) {
    layers.see(vertex);
    return rest();
  }
  void operator()(const EmissionVertex& vertex) {
    const bool is_unlit = share.unlit_emission && !path.scene.volume_light(vertex.state.medium);
    if (is_unlit || is_seen(vertex.state)) layers.add_hit(vertex, hit_lights(path, vertex));
  }
  // Emission is not added if a surface with delta and other lobes has scattered the walk by a non-delta lobe.
  Continuation operator()(const SurfaceVertex& vertex) {
    if (vertex.state.non_delta > 0 || vertex.state.scatterings() > share.scatterings + 1) return rest();
    layers.see(vertex);
    layers.add_hit(vertex, hit_lights(path, vertex));
    return lobe_weights(vertex.at.bsdf, vertex.wi_local).delta > 0 ? Continuation::go_on() : rest();
  }
  void operator()(const EscapeVertex& vertex) {
    if (is_seen(vertex.state)) layers.add_hit(vertex, hit_lights(path, vertex));
  }

 private:
  // Emission that the walk reaches next is directly visible, or visible by way of delta scatterings alone.
  bool is_seen(const WalkState& state) const {
    return state.non_delta == 0 && state.scatterings() <= share.scatterings;
  }
  Continuation rest() const { return share.unlit_emission ? Continuation::go_on() : Continuation::stop(); }
};

}  // namespace

RayCounts see_emission(const RenderJob& job, const EyeShare& share, std::uint32_t pass, const FilmPass& film) {
  const WalkLimits limits{share.unlit_emission ? job.settings.max_depth : share.scatterings, 3};
  RayCounts rays =
      trace_eye_paths(job, {pass, limits}, film,
                      [&](const PathContext& path, const EyeStart& start, const PixelPlace&, LightLayers& layers) {
                        walk_from_camera(path, start.camera, job.view.medium, EmissionVisitor{path, share, layers});
                      });
  rays.eye = {};  // these paths look for emission only, so the depth limit cuts off none of their light
  return rays;
}

}  // namespace lanthorn
