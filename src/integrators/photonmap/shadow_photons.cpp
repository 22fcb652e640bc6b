// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/photonmap/shadow_photons.h"

#include <array>

#include "photon/gather/kernels.h"
#include "photon/photon.h"

namespace lanthorn {

namespace {

constexpr int normal_bits = 12;

}  // namespace

void ShadowPhotons::follow(const PathContext& path, const LightPath& start, float time, Chunk& to) {
  // Bounds the number of surfaces: coincident surfaces and meshes seen edge-on could otherwise hold a ray forever.
  constexpr int most_surfaces = 64;
  const std::optional<EmissionSample> emission = sample_emission_of(start, path.sampler, path.w);
  // Lights that are media have no shadow photons: shadow alone does not decide how much of their light arrives.
  if (!emission || emission->flux.is_black() || is_volume(start.light)) return;
  Ray ray = spawn_from_light(*emission, time);
  // Surfaces in front of a portal occlude it.
  if (emission->from_infinity) ray.origin -= 2 * path.scene.bounding_sphere().radius * emission->direction;
  bool lit = true;
  for (int i = 0; i < most_surfaces; ++i) {
    ++path.counts.walk;
    const std::optional<SurfacePoint> at = path.scene.intersect(ray, path.w);
    if (!at) return;
    if (!at->is_interface) {
      const Normal normal = dot(at->normal, ray.direction) > 0 ? -at->normal : at->normal;
      to.positions.push_back(at->position);
      to.records.push_back({start.index, encode_octahedral<normal_bits>(normal), lit});
      lit = false;
    }
    ray = pass_surface(*at, ray);
  }
}

ShadowPhotons ShadowPhotons::trace(const Scene& scene, const LightPass& pass, const PassDraw& draw, RayCounts& counts) {
  const LightPaths paths(scene, pass);
  std::vector<Chunk> chunks(paths.chunk_count());
  counts += paths.for_each([&](const LightPath& start, Sampler& sampler, RayCounts& rays, std::size_t chunk) {
    const PathDraw own = draw.of_path(sampler);
    follow(PathContext{scene, own.w, sampler, rays}, start, own.time, chunks[chunk]);
  });
  std::vector<Point> positions;
  std::vector<Record> records;
  for (const Chunk& chunk : chunks) {
    positions.insert(positions.end(), chunk.positions.begin(), chunk.positions.end());
    records.insert(records.end(), chunk.records.begin(), chunk.records.end());
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
    if (!is_in_disc(dot(index_.position(n.slot) - p, normal), radius)) continue;
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
