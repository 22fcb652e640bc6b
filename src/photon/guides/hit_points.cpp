// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/guides/hit_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "index/bucket_kdtree.h"
#include "math/sampling.h"
#include "path/direct_light.h"
#include "photon/gather/photon_gather.h"
#include "photon/media/volume_gather.h"
#include "photon/pilot_paths.h"

namespace lanthorn {

namespace {

// Longest sides of the grids of pilot pixels.
constexpr int learning_grid = 96, landing_grid = 256;

/// Stores hit points at the first two vertices of an eye path that have a wide lobe.
struct HitPointVisitor {
  const PathContext& path;
  std::uint64_t seed;
  std::uint32_t number;  ///< of the path
  bool in_media;         ///< there are photons in media
  std::array<HitPoint, 2>& hits;

  Continuation operator()(const SurfaceVertex& vertex) const {
    if (!has_non_delta(vertex.at.bsdf)) return Continuation::go_on();
    if (wide_share(vertex) < 0.5f) return Continuation::go_on();
    return add(vertex, vertex.at.normal, albedo(vertex.at.bsdf, vertex.wi_local) * inv_pi);
  }
  Continuation operator()(const MediumVertex& vertex) const {
    if (!in_media || gather_probability(vertex.phase) < 0.5f) return Continuation::go_on();
    // Photons and the eye's flight each contain the scattering coefficient; it counts only once.
    const Spectrum scattering = scattering_at(path.scene.medium(vertex.state.medium), vertex.position, path.w);
    return add(vertex, Normal(0),
               map(scattering, [](float sigma) { return sigma > 0 ? pdf_uniform_sphere / sigma : 0.0f; }));
  }
  void operator()(const EscapeVertex&) const {}

 private:
  template <class Vertex>
  Continuation add(const Vertex& vertex, const Normal& normal, const Spectrum& scattered) const {
    const bool is_second = hits[0].radius > 0;
    hits[is_second ? 1 : 0] = {.position = position_of(vertex),
                               .normal = normal,
                               .radius = infinity,
                               .ends_gather = is_second,
                               .throughput = sum_of(vertex.state.beta * scattered) / sum_of(unit_beta(path.w)),
                               .direct = is_second ? hits[0].direct : direct_light(vertex)};
    return is_second ? Continuation::stop() : Continuation::go_on();
  }
  template <class Vertex>
  float direct_light(const Vertex& vertex) const {
    constexpr std::uint32_t samples = 4;
    float sum = 0;
    for (std::uint32_t i = 1; i <= samples; ++i) {
      Sampler sampler = Sampler::for_pixel(seed, Stream::pilot_camera, number, i);
      sum += sum_of(next_event(path.with(sampler), vertex, Continuation::stop()).radiance);
    }
    return sum / samples;
  }
};

/// Sets each radius to the distance of the nearest other hit points, so that the discs cover the visible surfaces.
void set_radii(std::vector<HitPoint>& hits) {
  std::vector<Point> positions(hits.size());
  std::transform(hits.begin(), hits.end(), positions.begin(), [](const HitPoint& h) { return h.position; });
  const BucketKdTree index = BucketKdTree::build(positions).index;
  for (HitPoint& hit : hits) {
    std::array<Neighbour, 6> others;  // the point itself is one of them
    const std::span<const Neighbour> found = index.nearest(hit.position, infinity, others);
    hit.radius = found.empty() ? 0.0f : std::sqrt(found.front().dist2);
  }
}

struct ImportanceVisitor {
  Landings& landings;
  int wide_lobes;  ///< met so far; from 1 on, landings are collected
  bool in_media;

  Continuation operator()(const SurfaceVertex& vertex) {
    const WalkState& state = vertex.state;
    if (wide_lobes > 0) landings.places.push_back(vertex.at.position);
    if (wide_lobes > 0 && has_non_delta(vertex.at.bsdf))
      landings.importance.push_back(
          {{state.beta, vertex.at.position, vertex.wi, vertex.at.normal, {.dispersed = state.dispersed}},
           state.previous});
    if (wide_share(vertex) >= 0.5f) ++wide_lobes;
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& vertex) {
    if (in_media && wide_lobes > 0) landings.places.push_back(vertex.position);
    if (in_media && gather_probability(vertex.phase) >= 0.5f) ++wide_lobes;
    return Continuation::go_on();
  }
  void operator()(const EscapeVertex&) const {}
};

}  // namespace

std::vector<HitPoint> find_hit_points(const RenderJob& job, PhotonUse use, bool in_media, const PassDraw& draw) {
  const PixelWindow film = job.view.film();
  const int columns = std::min(learning_grid, film.width()), rows = std::min(learning_grid, film.height());
  std::vector<std::array<HitPoint, 2>> of_paths(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for_each_pilot_path(job, draw, film, columns, rows, [&](const PathContext& path, const Ray&, std::uint32_t index) {
    return HitPointVisitor{path, job.settings.seed, index, in_media, of_paths[index]};
  });
  std::vector<HitPoint> hits;
  for (const auto& of_path : of_paths)
    for (const HitPoint& hit : of_path)
      if (hit.radius > 0 && (!hit.ends_gather || use == PhotonUse::gathering)) hits.push_back(hit);
  set_radii(hits);
  return hits;
}

Landings find_landings(const RenderJob& job, PhotonUse use, bool in_media, const PassDraw& draw) {
  const PixelWindow film = job.view.film();
  const int columns = std::min(landing_grid, film.width()), rows = std::min(landing_grid, film.height());
  std::vector<Landings> of_paths(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for_each_pilot_path(job, draw, film, columns, rows, [&](const PathContext&, const Ray&, std::uint32_t index) {
    return ImportanceVisitor{of_paths[index], use == PhotonUse::gathering ? 1 : 0, in_media};
  });
  Landings all;
  for (const Landings& of_path : of_paths) all.append(of_path);
  return all;
}

}  // namespace lanthorn
