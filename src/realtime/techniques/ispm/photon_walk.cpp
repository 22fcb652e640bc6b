// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/ispm/photon_walk.h"

#include <algorithm>
#include <atomic>

#include "base/parallel.h"
#include "light/light.h"
#include "path/walk.h"
#include "photon/incidence.h"
#include "realtime/scene/frame_heroes.h"

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

namespace {

struct WalkedPhoton {
  GpuPhoton photon;
  std::uint32_t depth;
};

struct Chunk {
  std::vector<WalkedPhoton> indirect, caustic;
  std::vector<std::uint64_t> per_bounce;
};

struct StoreVisitor {
  const Wavelengths& w;
  Chunk& chunk;

  Continuation operator()(const MediumVertex&) const { return Continuation::stop(); }
  void operator()(const EscapeVertex&) const {}
  Continuation operator()(const SurfaceVertex& vertex) const {
    const WalkState& state = vertex.state;
    if (state.depth < 2) return Continuation::go_on();
    const auto bounces = static_cast<std::size_t>(state.depth - 1);
    chunk.per_bounce.resize(std::max(chunk.per_bounce.size(), bounces));
    ++chunk.per_bounce[bounces - 1];
    if (!has_non_delta(vertex.at.bsdf)) return Continuation::go_on();
    const float gain = grazing_gain(std::fabs(dot(vertex.wi, vertex.at.normal)));
    const Spectrum power = (state.dispersed ? state.beta * w.dispersed : state.beta) * gain;
    const GpuPhoton photon{vertex.at.position, encode_octahedral<16>(vertex.at.normal),
                           Vec3(power[0], power[1], power[2]), encode_octahedral<16>(vertex.wi)};
    (state.non_delta == 0 ? chunk.caustic : chunk.indirect)
        .push_back({photon, static_cast<std::uint32_t>(state.depth)});
    return Continuation::go_on();
  }
};

// Positions of the GPU, which has interpolated them.
constexpr float position_error = 0x1p-16f;

/// The ray of a photon that the GPU has scattered.
Ray leaving_ray(const PhotonStart& start) {
  SurfacePoint at;
  at.position = start.position;
  at.position_error = Vec3(position_error * max_component(abs(start.position)));
  at.normal = surface_normal(start);
  return spawn_ray(at, start.direction);
}

/// The ray of a photon that flies on from just before its first surface, whose closure the GPU does not know. A share
/// of its way is left, because the GPU's triangles are not exactly the surface.
Ray arriving_ray(const PhotonStart& start, const LightView& view, float scene_radius) {
  constexpr float share = 0.02f;
  const float way =
      view.kind == LightView::Kind::parallel ? scene_radius : std::sqrt(distance_squared(start.position, view.origin));
  return {start.position - share * way * start.direction, start.direction, infinity, 0};
}

void follow(const PathContext& path, const PhotonStart& start, const LightView& view, Chunk& chunk) {
  WalkState state;
  state.beta = Spectrum(start.power.x, start.power.y, start.power.z, 0);
  state.previous = start.position;
  if (start.state == gpu::start_scattered) {
    state.depth = 1;
    state.non_delta = 1;
    state.last_delta = false;
    state.previous_normal = surface_normal(start);
    walk<Transport::importance>(path, leaving_ray(start), state, StoreVisitor{path.w, chunk});
  } else {
    state.previous = view.origin;
    const Ray ray = arriving_ray(start, view, path.scene.bounding_sphere().radius);
    walk<Transport::importance>(path, ray, state, StoreVisitor{path.w, chunk});
  }
}

void append(FramePhotons& all, const std::vector<WalkedPhoton>& stored) {
  for (const WalkedPhoton& s : stored) {
    all.photons.push_back(s.photon);
    all.depths.push_back(s.depth);
  }
}

FramePhotons join(const std::vector<Chunk>& chunks) {
  FramePhotons all;
  for (const Chunk& chunk : chunks) {
    append(all, chunk.indirect);
    all.per_bounce.resize(std::max(all.per_bounce.size(), chunk.per_bounce.size()));
    for (std::size_t i = 0; i < chunk.per_bounce.size(); ++i) all.per_bounce[i] += chunk.per_bounce[i];
  }
  all.indirect = static_cast<std::uint32_t>(all.photons.size());
  for (const Chunk& chunk : chunks) append(all, chunk.caustic);
  return all;
}

}  // namespace

FramePhotons walk_photons(const Scene& scene, const std::vector<LightView>& views,
                          const std::vector<PhotonStart>& starts, const WalkSettings& settings) {
  constexpr std::size_t chunk_size = 1024;
  std::vector<Chunk> chunks((starts.size() + chunk_size - 1) / chunk_size);
  std::atomic<std::uint64_t> rays{0}, started{0};
  const FrameHeroes heroes(scene.has_dispersion() && settings.disperses, settings.seed, settings.frame);
  parallel_chunks(starts.size(), chunk_size, [&](std::size_t c, std::size_t begin, std::size_t end) {
    RayCounts counts;
    std::uint64_t alive = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (starts[i].state == gpu::start_none) continue;
      ++alive;
      Sampler sampler = Sampler::for_pixel(settings.seed, stream_of("photons of a frame"),
                                           static_cast<std::uint32_t>(i), settings.frame);
      const Wavelengths w = heroes.of_photon(i);
      const PathContext path{scene, w, sampler, counts, {settings.max_depth - 1, 1}};
      follow(path, starts[i], views[static_cast<std::size_t>(starts[i].view)], chunks[c]);
    }
    rays += counts.walk;
    started += alive;
  });
  FramePhotons all = join(chunks);
  all.rays = rays;
  all.started = started;
  return all;
}

}  // namespace lanthorn
