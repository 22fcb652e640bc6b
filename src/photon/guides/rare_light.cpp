// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/guides/rare_light.h"

#include <algorithm>
#include <array>
#include <vector>

#include "index/bucket_kdtree.h"
#include "path/depth.h"
#include "path/light_pass.h"
#include "photon/gather/photon_gather.h"
#include "photon/pilot_paths.h"

namespace lanthorn {

namespace {

constexpr std::uint64_t traced_paths = 50'000;
constexpr int eye_grid = 64;
// Light is rare if a smaller fraction of diffuse directions meets its source.
constexpr float least_chance = 1e-3f;
// Relative variance of a pass that is too large: five thousand passes would leave 0.01.
constexpr float most_noise = 50;

struct Landing {
  Point position{0};
  float flux = 0;
  std::uint32_t path = 0;
};

/// The history of a light path.
struct Fate {
  bool hidden = false;  ///< its first non-delta scattering came after delta scatterings
  float chance = 0;     ///< of a diffuse direction to meet the light there
  float radiance = 0;   ///< emitted; infinite for lights without extent
};

struct PilotLight {
  std::vector<Fate> paths;
  std::vector<Landing> first;  ///< of hidden paths, on their first non-delta surfaces or where they come into media
  std::vector<Landing> surfaces, media;  ///< all
  Landing delta;                         ///< the last on a delta surface
};

struct LandingVisitor {
  PilotLight& pilot;
  bool has_extent;

  void operator()(const EmissionSample& e) const {
    if (has_extent) pilot.paths.back().radiance = sum_of(e.flux) * e.pdf_position * e.pdf_direction / e.cos_origin;
  }
  Continuation operator()(const SurfaceVertex& vertex) const {
    const WalkState& state = vertex.state;
    const Landing landing{vertex.at.position, sum_of(state.beta), static_cast<std::uint32_t>(pilot.paths.size() - 1)};
    if (!has_non_delta(vertex.at.bsdf)) {
      pilot.delta = landing;
      return Continuation::go_on();
    }
    pilot.surfaces.push_back(landing);
    if (is_hidden(state)) add_first(landing);
    return Continuation::go_on();
  }
  // Directions out of a medium count as if its interface were a diffuse surface.
  Continuation operator()(const MediumVertex& vertex) const {
    pilot.media.push_back(
        {vertex.position, sum_of(vertex.state.beta), static_cast<std::uint32_t>(pilot.paths.size() - 1)});
    if (is_hidden(vertex.state)) add_first(pilot.delta);
    return Continuation::go_on();
  }
  static bool is_hidden(const WalkState& state) { return state.depth > 1 && state.non_delta == 0; }
  void add_first(const Landing& landing) const {
    pilot.first.push_back(landing);
    pilot.paths.back().hidden = true;
  }
  void operator()(const EscapeVertex&) const {}
};

PilotLight trace_light(const RenderJob& job, const PassDraw& draw) {
  const LightPaths paths(job.scene, {job.settings.seed, Stream::pilot_light, 0, traced_paths});
  std::vector<PilotLight> chunks(paths.chunk_count());
  paths.for_each([&](const LightPath& start, Sampler& sampler, RayCounts& counts, std::size_t chunk) {
    PilotLight& pilot = chunks[chunk];
    pilot.paths.push_back({.radiance = infinity});
    const PathDraw own = draw.of_path(sampler);
    walk_from_light(
        PathContext{job.scene, own.w, sampler, counts, {max_depth_of_photons(job.scene, job.settings.max_depth), 1}},
        start, own.time, LandingVisitor{pilot, !is_delta(start.light)});
  });
  PilotLight all;
  for (const PilotLight& chunk : chunks) {
    const auto before = static_cast<std::uint32_t>(all.paths.size());
    const auto append = [before](const std::vector<Landing>& from, std::vector<Landing>& to) {
      for (Landing landing : from) {
        landing.path += before;
        to.push_back(landing);
      }
    };
    append(chunk.first, all.first);
    append(chunk.surfaces, all.surfaces);
    append(chunk.media, all.media);
    all.paths.insert(all.paths.end(), chunk.paths.begin(), chunk.paths.end());
  }
  return all;
}

/// Landings by their places.
class LandingMap {
 public:
  explicit LandingMap(const std::vector<Landing>& landings) : landings_(landings) {
    std::vector<Point> positions(landings.size());
    std::transform(landings.begin(), landings.end(), positions.begin(), [](const Landing& l) { return l.position; });
    built_ = BucketKdTree::build(positions);
  }
  /// The nearest `count` landings; `radius2` (m²) of the disc that holds them.
  template <std::size_t count, class Visit>
  void for_each_nearest(const Point& position, float& radius2, Visit&& visit) const {
    std::array<Neighbour, count> heap;
    const std::span<const Neighbour> found = built_.index.nearest(position, infinity, heap);
    radius2 = found.empty() ? 0 : found.front().dist2;
    for (const Neighbour& n : found) visit(landings_[built_.order[n.slot]]);
  }

 private:
  const std::vector<Landing>& landings_;
  IndexBuild<BucketKdTree> built_;
};

// Where a light of radiance L makes the irradiance E, the share E / (πL) of diffuse directions meets it.
void find_chances(PilotLight& pilot) {
  const LandingMap map(pilot.first);
  for (const Landing& landing : pilot.first) {
    Fate& fate = pilot.paths[landing.path];
    float radius2 = 0, flux = 0;
    map.for_each_nearest<8>(landing.position, radius2, [&](const Landing& other) { flux += other.flux; });
    fate.chance = radius2 > 0 ? flux / (sqr(pi) * radius2 * fate.radiance) : 1;
  }
}

struct ShareVisitor {
  const PilotLight& pilot;
  const LandingMap& surfaces;
  const LandingMap& media;
  float& share;  ///< of rare light; negative: neither surface nor medium

  Continuation operator()(const SurfaceVertex& vertex) const {
    if (!has_non_delta(vertex.at.bsdf)) return Continuation::go_on();
    if (wide_share(vertex) < 0.5f) return Continuation::go_on();
    return measure(surfaces, vertex.at.position);
  }
  Continuation operator()(const MediumVertex& vertex) const { return measure(media, vertex.position); }
  Continuation measure(const LandingMap& map, const Point& position) const {
    float radius2 = 0, rare = 0, hidden = 0, all = 0, square = 0;
    map.for_each_nearest<24>(position, radius2, [&](const Landing& landing) {
      all += landing.flux;
      const Fate& fate = pilot.paths[landing.path];
      if (!fate.hidden) return;
      hidden += landing.flux;
      if (fate.chance < least_chance) rare += landing.flux;
      square += landing.flux / std::max(fate.chance, 1e-6f);
    });
    // Directions meet light of share s with probability c, and then bring s / c: the variance is s² / c.
    if (all > 0) share = (hidden * square > most_noise * sqr(all) ? hidden : rare) / all;
    return Continuation::stop();
  }
  void operator()(const EscapeVertex&) const {}
};

}  // namespace

bool has_specular_surfaces(const Scene& scene) {
  const std::vector<Obstacle> obstacles = scene.obstacles();
  return std::any_of(obstacles.begin(), obstacles.end(), [](const Obstacle& o) { return o.is_specular; });
}

double rare_light_share(const RenderJob& job) {
  if (!has_specular_surfaces(job.scene)) return 0;
  const PassDraw draw = draw_for_pass(job, 0);
  PilotLight pilot = trace_light(job, draw);
  if (pilot.first.empty()) return 0;
  find_chances(pilot);
  const LandingMap surfaces(pilot.surfaces), media(pilot.media);
  const PixelWindow& window = job.view.crop;
  const int columns = std::min(eye_grid, window.width()), rows = std::min(eye_grid, window.height());
  std::vector<float> shares(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), -1.0f);
  for_each_pilot_path(job, draw, window, columns, rows, [&](const PathContext&, const Ray&, std::uint32_t index) {
    return ShareVisitor{pilot, surfaces, media, shares[index]};
  });
  std::erase_if(shares, [](float share) { return share < 0; });
  double sum = 0;
  for (const float share : shares) sum += static_cast<double>(share);
  return shares.empty() ? 0 : sum / static_cast<double>(shares.size());
}

}  // namespace lanthorn
