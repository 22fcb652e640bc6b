// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photons of light paths whose starts the caller chooses.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "lanthorn/error.h"
#include "lanthorn/photons.h"
#include "path/depth.h"
#include "path/light_pass.h"
#include "path/path_draw.h"
#include "path/walk.h"
#include "render/plan.h"
#include "scene/medium_around.h"
#include "scene/scene.h"
#include "spectrum/curve.h"

namespace lanthorn {

namespace {

// Records the photons of one light path: one at each vertex with a non-delta lobe.
struct SentPhotonVisitor {
  Photons& photons;
  std::uint32_t start;  ///< number of the PhotonStart
  int first_depth;
  int max_depth;  ///< of the paths that use the photons
  const Wavelengths& w;
  const DVec3& origin;  ///< the scene's origin in the coordinates of the file

  Continuation operator()(const SurfaceVertex& vertex) const {
    if (has_non_delta(vertex.at.bsdf)) add(vertex.state, vertex.at.position, vertex.wi, vertex.at.normal);
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& vertex) const {
    add(vertex.state, vertex.position, vertex.wi, Normal(0));
    return Continuation::go_on();
  }
  void operator()(const EscapeVertex&) const {}

 private:
  void add(const WalkState& state, const Point& position, const Direction& wi, const Normal& normal) const {
    if (state.depth < first_depth || state.scatterings() > max_depth) return;
    const PhotonClass of_scattered = state.non_delta == 0 ? PhotonClass::caustic : PhotonClass::indirect;
    photons.positions.emplace_back(DVec3(position) + origin);
    photons.normals.push_back(normal);
    photons.directions.push_back(wi);
    photons.powers.push_back(w.to_rgb(state.dispersed ? state.beta * w.dispersed : state.beta));
    photons.depths.push_back(state.scatterings());
    photons.classes.push_back(state.depth == 1 ? PhotonClass::direct : of_scattered);
    photons.starts.push_back(start);
  }
};

template <class T>
void append_to(std::vector<T>& all, const std::vector<T>& part) {
  all.insert(all.end(), part.begin(), part.end());
}

void append_part(Photons& all, const Photons& part) {
  append_to(all.positions, part.positions);
  append_to(all.normals, part.normals);
  append_to(all.directions, part.directions);
  append_to(all.powers, part.powers);
  append_to(all.depths, part.depths);
  append_to(all.classes, part.classes);
  append_to(all.starts, part.starts);
}

void check_power(const Rgb& power, std::size_t index) {
  const auto is_usable = [](float x) { return x >= 0 && std::isfinite(x); };
  if (!is_usable(power.r) || !is_usable(power.g) || !is_usable(power.b))
    throw Error(fmt::format("light path {}: expected a power of finite numbers that are not negative, got ({}, {}, {})",
                            index, power.r, power.g, power.b));
}

}  // namespace

Photons trace_photons(const Scene& scene, const ViewDescription& view, const RenderOptions& options,
                      std::span<const PhotonStart> starts, std::uint32_t pass, bool direct) {
  if (starts.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(fmt::format("light paths: expected at most {}, got {}", std::numeric_limits<std::uint32_t>::max(),
                            starts.size()));
  const RenderPlan plan = plan_render(scene, view, options);
  const RenderSettings& settings = plan.settings;
  const PassDraw draw = draw_for_pass(plan.job(scene), pass * settings.parts);
  const WalkLimits limits{max_depth_of_photons(scene, settings.max_depth)};
  const MediumFinder media(scene);
  std::vector<Ray> rays;
  rays.reserve(starts.size());
  for (const PhotonStart& start : starts) {
    check_power(start.power, rays.size());
    rays.push_back(ray_in_scene(scene, start.ray, rays.size()));
  }
  std::vector<Photons> parts((starts.size() + light_path_chunk - 1) / light_path_chunk);
  parallel_chunks(starts.size(), light_path_chunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      stop_point();
      const auto number = static_cast<std::uint32_t>(i);
      Sampler sampler = Sampler::for_light_path(settings.seed, stream_of("sent photons"), 0, pass, number);
      RayCounts counts;
      const PathDraw own = draw.of_path(sampler);
      const PathContext path{scene, own.w, sampler, counts, limits};
      Ray ray = rays[i];
      ray.time = own.time;
      WalkState state;
      state.beta = evaluate_illuminant(starts[i].power, own.w);
      state.previous = ray.origin;
      state.medium = media.around(ray.origin, ray.time).value_or(MediumId::vacuum);
      if (state.beta.is_black()) continue;
      walk<Transport::importance>(path, ray, state,
                                  SentPhotonVisitor{parts[chunk], number, direct ? 1 : 2, settings.max_depth, own.w,
                                                    scene.description().origin});
    }
  });
  Photons photons{.light_paths = starts.size(), .pass = pass};
  for (const Photons& part : parts) append_part(photons, part);
  return photons;
}

}  // namespace lanthorn
