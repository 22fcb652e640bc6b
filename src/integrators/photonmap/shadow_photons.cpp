// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/photonmap/shadow_photons.h"

#include <array>
#include <cmath>
#include <span>

#include "photon/kernels.h"
#include "photon/photon.h"

namespace lanthorn {

namespace {

constexpr int normal_bits = 12;

}  // namespace

void ShadowPhotons::follow(const Scene& scene, const LightPath& path, Sampler& sampler, const PathDraw& draw,
                           Chunk& to) {
  // Surfaces that lie on each other, and closed meshes seen along their faces, must not hold a ray for ever.
  constexpr int most_surfaces = 64;
  const std::optional<EmissionSample> emission = sample_emission_of(path, sampler, draw.w);
  if (!emission || emission->flux.is_black()) return;
  Ray ray = spawn_from_light(*emission, draw.time);
  // What stands before a portal shades it.
  if (emission->from_infinity) ray.origin -= 2 * scene.bounding_sphere().radius * emission->direction;
  bool lit = true;
  for (int i = 0; i < most_surfaces; ++i) {
    ++to.counts.walk;
    const std::optional<SurfacePoint> at = scene.intersect(ray, draw.w);
    if (!at) return;
    if (!at->is_interface) {
      const Normal normal = dot(at->normal, ray.direction) > 0 ? -at->normal : at->normal;
      to.positions.push_back(at->position);
      to.records.push_back({path.index, encode_octahedral<normal_bits>(normal), lit});
      lit = false;
    }
    ray = spawn_ray(*at, ray.direction);
  }
}

ShadowPhotons ShadowPhotons::trace(const Scene& scene, const LightPass& pass, const PathDraw& draw, RayCounts& counts) {
  const LightPaths paths(scene, pass);
  std::vector<Chunk> chunks((paths.total() + light_path_chunk - 1) / light_path_chunk);
  parallel_chunks(paths.total(), light_path_chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    paths.for_each_in(begin, end,
                      [&](const LightPath& path, Sampler& sampler) { follow(scene, path, sampler, draw, chunks[c]); });
  });
  std::vector<Point> positions;
  std::vector<Record> records;
  for (const Chunk& chunk : chunks) {
    positions.insert(positions.end(), chunk.positions.begin(), chunk.positions.end());
    records.insert(records.end(), chunk.records.begin(), chunk.records.end());
    counts += chunk.counts;
  }
  ShadowPhotons result;
  IndexBuild<BucketKdTree> built = BucketKdTree::build(positions);
  result.index_ = std::move(built.index);
  for (const std::uint32_t number : built.order) result.records_.push_back(records[number]);
  return result;
}

template <class Visit>
void ShadowPhotons::for_each_around(const Point& p, const Normal& normal, float radius, Visit&& visit) const {
  constexpr float least_cosine = 0.9f;  // between the normals of one surface
  std::array<Neighbour, most_looked_at> memory;
  for (const Neighbour& n : index_.nearest(p, radius, memory)) {
    const Record& record = records_[n.slot];
    if (std::fabs(dot(index_.position(n.slot) - p, normal)) > search_flatness * radius) continue;
    if (dot(decode_octahedral<normal_bits>(record.normal), normal) < least_cosine) continue;
    if (!visit(record)) return;
  }
}

Lighting ShadowPhotons::at(const Point& p, const Normal& normal, std::uint32_t light, float radius) const {
  std::size_t lit = 0, shadowed = 0;
  for_each_around(p, normal, radius, [&](const Record& record) {
    if (record.light == light) ++(record.lit ? lit : shadowed);
    return lit == 0 || shadowed == 0;
  });
  if (lit > 0 && shadowed > 0) return Lighting::unknown;
  if (lit >= least_agreeing) return Lighting::lit;
  return shadowed >= least_agreeing ? Lighting::shadowed : Lighting::unknown;
}

std::optional<float> ShadowPhotons::lit_share(const Point& p, const Normal& normal, float radius) const {
  std::size_t lit = 0, all = 0;
  for_each_around(p, normal, radius, [&](const Record& record) {
    lit += record.lit ? 1 : 0;
    ++all;
    return true;
  });
  if (all == 0) return {};
  return static_cast<float>(lit) / static_cast<float>(all);
}

}  // namespace lanthorn
