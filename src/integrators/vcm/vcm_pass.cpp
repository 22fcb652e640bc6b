// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/vcm/vcm_pass.h"

#include <algorithm>
#include <span>

#include "photon/photon.h"

namespace lanthorn {

namespace {

MergeShrinks shrinks_of_pass(const RenderJob& job, std::uint32_t number, double alpha, const Effort& effort,
                             const UniformityTests* tests) {
  const double light_paths = static_cast<double>(effort.light_paths()) / static_cast<double>(job.settings.photons);
  return tests ? MergeShrinks(*tests, alpha, number, light_paths)
               : MergeShrinks(merge_radius_shrink(alpha, number, light_paths));
}

}  // namespace

VcmPreparation::VcmPreparation(const RenderJob& job, const VcmSettings& settings)
    : emission(settings.switches.merging ? choose_emission(settings.emission, PhotonUse::merging, job) : Emission()),
      densities(job.scene, emission.starts()),
      effort(job.settings.photons),
      remark(emission.remark) {
  if (!settings.switches.merging) return;
  radii = FirstMergeRadii(job, settings, emission.get());
  volume_radii = FirstVolumeRadii(job, settings, emission.get());
  if (settings.plan_effort) settings.plan_effort(job, settings, *this);
}

VcmPass::VcmPass(const RenderJob& job_, std::uint32_t number_, const VcmSettings& settings_,
                 const VcmPreparation& prepared, LightVertices& vertices_, UniformityTests* tests)
    : job(job_),
      settings(settings_),
      effort(prepared.effort),
      number(number_),
      draw(draw_for_pass(job, number)),
      blocks(prepared.effort.light_paths(), job.settings.photon_block),
      light_paths(job.scene, {job.settings.seed, Stream::light, number, prepared.effort.light_paths(),
                              prepared.emission.starts(), blocks[0], blocks.count() > 1 && !draw.is_of_one_time()}),
      volume_kernels(prepared.volume_radii.kernels(number)),
      sees(connects() && effort.sees()),
      beam_share(volume_kernels.uses_beams() ? share_of_beams(light_paths.total()) : 0.0f),
      bidirectional{job.view, {}, prepared.densities},
      uniformity(tests && !tests->are_done() && number == tests->passes_counted() ? tests : nullptr),
      radii(prepared.radii, shrinks_of_pass(job, number, settings.alpha, effort, tests)),
      vertices(vertices_) {
  const auto paths = static_cast<float>(light_paths.total());
  bidirectional.techniques = {.light_paths = paths,
                              .connects = settings.switches.connections,
                              .volume = volume_kernels.merging(paths, beam_share)};
}

void VcmPass::begin_block(std::uint32_t block) {
  if (block == 0) return;
  surface_merges.reset();
  volume_merges.reset();
  light_paths.begin_block(blocks[block]);
}

void VcmPass::build_merges(PassReport& report) {
  const auto note = [&](const auto& merges) {
    report.photons_stored += merges.size();
    report.photon_map_bytes += merges.memory_bytes();
  };
  // Connections find the light that photons straight from a light would bring.
  note(surface_merges.emplace(vertices, connects() ? 2 : 1, radii));
  report.radius = radii.typical();
  if (!volume_kernels.any()) return;
  note(volume_merges.emplace(vertices, volume_kernels));
  report.volume_radius = volume_kernels.widest_radius();
}

Bidirectional VcmPass::bidirectional_at(const Vec2& raster, const PlaceEffort& here) const {
  Bidirectional result = bidirectional;
  Techniques& t = result.techniques;
  t.connections = here.connections;
  t.lens_part = here.sees ? 1.0f : 0.0f;
  t.goes_on = here.goes_on;
  t.volume_part = here.merges_in_media ? 1.0f : 0.0f;
  if (settings.switches.merging && here.merges) t.merging = t.light_paths * pi * sqr(radii.at(raster));
  return result;
}

std::size_t VcmPass::partner(Sampler& of_eye_path) const {
  of_eye_path.seek(1);
  const auto number_of = static_cast<std::size_t>(of_eye_path.next() * bidirectional.techniques.light_paths);
  return std::min(number_of, std::max<std::size_t>(light_paths.total(), 1) - 1);
}

std::size_t VcmPass::partner(std::size_t first, int i, int count) const {
  const std::size_t all = std::max<std::size_t>(light_paths.total(), 1);
  return (first + all * static_cast<std::size_t>(i) / static_cast<std::size_t>(count)) % all;
}

bool VcmPass::is_of_block(std::size_t path) const {
  const std::size_t first = light_paths.first();
  return path >= first && path - first < std::max<std::size_t>(light_paths.count(), 1);
}

std::span<const LightVertex> VcmPass::light_path(std::size_t path) const {
  return is_of_block(path) ? vertices.path(path - light_paths.first()) : std::span<const LightVertex>();
}

PathDraw VcmPass::draw_of_eye_path(Sampler& sampler, const PixelPlace& place) const {
  // The partner is a random light path, so that the look-up of its vertices would wait for main memory.
  if (const std::size_t path = partner(sampler); connects() && is_of_block(path))
    vertices.prefetch_place(path - light_paths.first());
  PathDraw own = draw.of_eye_path(sampler, place.x, place.y);
  if (draw.is_of_one_time()) return own;
  const std::size_t path = partner(sampler);
  if (blocks.count() > 1 && light_paths.total() > 0) {  // the light path may be one of another block
    Sampler of_light_path = light_paths.sampler_of(path);
    own.time = draw.of_path(of_light_path).time;
  } else if (const std::span<const LightVertex> met = light_path(path); !met.empty()) {
    own.time = met.front().at.time;
  }
  return own;
}

}  // namespace lanthorn
