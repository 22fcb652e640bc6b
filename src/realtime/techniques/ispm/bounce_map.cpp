// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/ispm/bounce_map.h"

#include <algorithm>

#include "photon/photon.h"

namespace lanthorn {

Normal surface_normal(const PhotonStart& start) { return decode_octahedral<16>(start.normal); }

BounceMap::BounceMap(const gl::ShaderFiles& files, const std::string& closures)
    : importance_(gl::Program::compute(files, "importance.comp.glsl", closures)),
      rows_(gl::Program::compute(files, "rows.comp.glsl")),
      start_(gl::Program::compute(files, "start.comp.glsl")) {}

void BounceMap::start(const LightMaps& maps, int view_count, std::uint32_t photons, std::uint64_t seed,
                      std::uint32_t frame) {
  count_ = photons;
  const int rows = maps.layers() * maps.size();
  const auto row_bytes = static_cast<std::size_t>(rows) * sizeof(float);
  gl::reserve(row_sums_, row_bytes);
  gl::reserve(texel_sums_, row_bytes * static_cast<std::size_t>(maps.size()));
  gl::reserve(starts_, std::max<std::size_t>(1, photons) * sizeof(PhotonStart));
  maps.bind();
  texel_sums_.bind_storage(gpu::storage_texel_sums);
  row_sums_.bind_storage(gpu::storage_row_sums);
  starts_.bind_storage(gpu::storage_photon_starts);
  const auto groups = [](std::uint32_t threads) { return (threads + gpu::work_group - 1) / gpu::work_group; };
  importance_.use();
  importance_.set("view_count", view_count);
  importance_.set("row_count", rows);
  glDispatchCompute(groups(static_cast<std::uint32_t>(rows)), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  rows_.use();
  glDispatchCompute(static_cast<GLuint>(view_count), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  start_.use();
  start_.set("view_count", view_count);
  start_.set("photon_count", photons);
  start_.set("key", static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32), frame);
  glDispatchCompute(groups(photons), 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace lanthorn
