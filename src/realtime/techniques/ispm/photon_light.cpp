// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/ispm/photon_light.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/parallel.h"
#include "math/frame.h"

namespace lanthorn {

namespace {

constexpr GLsizei corners_of_box = 14;  // of a strip of triangles

void set_common(const gl::Program& program, const WindowRays& rays, const PhotonVolume& volume) {
  program.set("radius", volume.radius);
  program.set("half_height", volume.half_height);
  program.set("eye", rays.eye);
  program.set("axis", glm::vec4(rays.axis, rays.parallel ? 1 : 0));
}

void require_texels(std::size_t texels) {
  gl::require_buffer_texels(texels, "photons of a frame", "fewer photons (-n), or a smaller radius");
}

/// Tiles [left, right) x [top, bottom).
struct TileRange {
  int left = 0, right = 0, top = 0, bottom = 0;
};

/// Tiles along an axis from the lowest to the highest clip coordinate of a box, over w.
struct Interval {
  int begin, end;
};
Interval tiles_between(float low, float high, int pixels, int tiles) {
  constexpr float margin = 0.5f;  // pixels, for the rasteriser's rounding
  const auto tile = [&](float clip, float more) {
    const float pixel = (0.5f * clip + 0.5f) * static_cast<float>(pixels) + more;
    return std::clamp(pixel / TileGrid::side, -1.0f, static_cast<float>(tiles));
  };
  return {std::max(0, static_cast<int>(std::floor(tile(low, -margin)))),
          std::min(tiles, static_cast<int>(std::floor(tile(high, margin))) + 1)};
}

/// Tiles that the box around a photon's volume touches; all of them if it crosses the plane of the eye.
TileRange tiles_of(const GpuPhoton& photon, const Mat4& to_clip, const PhotonVolume& volume, const TileGrid& grid) {
  const Frame frame{photon.surface_normal()};
  const Mat4 box(glm::vec4(gpu::box_enlargement * volume.radius * frame.s, 0),
                 glm::vec4(gpu::box_enlargement * volume.radius * frame.t, 0),
                 glm::vec4(gpu::box_enlargement * volume.half_height * frame.n, 0), glm::vec4(photon.position, 1));
  const Mat4 m = to_clip * box;
  // w is the distance from the plane of the eye; its extent over the box:
  const float w_extent = std::fabs(m[0].w) + std::fabs(m[1].w) + std::fabs(m[2].w);
  if (m[3].w + w_extent <= 0) return {};
  if (m[3].w - w_extent <= 0) return {0, grid.columns(), 0, grid.rows()};
  Vec2 low(infinity), high(-infinity);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec4 p = m[3] + ((corner & 1) != 0 ? m[0] : -m[0]) + ((corner & 2) != 0 ? m[1] : -m[1]) +
                        ((corner & 4) != 0 ? m[2] : -m[2]);
    const Vec2 at(p.x / p.w, p.y / p.w);
    low = min(low, at);
    high = max(high, at);
  }
  const auto [left, right] = tiles_between(low.x, high.x, grid.width, grid.columns());
  const auto [top, bottom] = tiles_between(low.y, high.y, grid.height, grid.rows());
  return {left, right, top, bottom};
}

template <class Visit>
void for_each_tile(const TileRange& range, const TileGrid& grid, Visit&& visit) {
  for (int y = range.top; y < range.bottom; ++y)
    for (int x = range.left; x < range.right; ++x) {
      const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.columns());
      visit(row + static_cast<std::size_t>(x));
    }
}

}  // namespace

TilePhotons photons_by_tile(std::span<const GpuPhoton> photons, std::uint32_t first, const Mat4& to_clip,
                            const PhotonVolume& volume, const TileGrid& grid) {
  std::vector<TileRange> ranges(photons.size());
  constexpr std::size_t chunk = 1024;
  parallel_chunks(photons.size(), chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ranges[i] = tiles_of(photons[i], to_clip, volume, grid);
  });
  const auto tiles = static_cast<std::size_t>(grid.columns()) * static_cast<std::size_t>(grid.rows());
  TilePhotons result;
  result.begins.assign(tiles + 1, 0);
  for (const TileRange& range : ranges) for_each_tile(range, grid, [&](std::size_t t) { ++result.begins[t + 1]; });
  for (std::size_t t = 0; t < tiles; ++t) result.begins[t + 1] += result.begins[t];
  std::vector<std::uint32_t> next(result.begins.begin(), result.begins.end() - 1);
  result.entries.resize(result.begins.back());
  for (std::size_t i = 0; i < photons.size(); ++i)
    for_each_tile(ranges[i], grid, [&](std::size_t t) {
      result.entries[next[t]++] = {photons[i].position, first + static_cast<std::uint32_t>(i)};
    });
  return result;
}

PhotonLight::PhotonLight(const gl::ShaderFiles& files, const std::string& closures)
    : splat_(files, "splat.vert.glsl", "splat.frag.glsl", closures),
      tiles_(gl::Program::compute(files, "gather.comp.glsl", closures)),
      photon_texels_(GL_RGBA32UI),
      tile_begins_(GL_R32UI),
      tile_photons_(GL_RGBA32UI),
      no_vertices_(gl::make_vertex_array()) {}

void PhotonLight::TileLists::write(const TilePhotons& photons) {
  require_texels(photons.entries.size());
  longest = 0;
  for (std::size_t t = 0; t + 1 < photons.begins.size(); ++t)
    longest = std::max(longest, photons.begins[t + 1] - photons.begins[t]);
  begins.write(photons.begins);
  entries.write(photons.entries);
}

void PhotonLight::upload(FramePhotons photons) {
  require_texels(2 * photons.photons.size());
  frame_ = std::make_shared<FramePhotons>(std::move(photons));
  photons_.write(frame_->photons);
}

void PhotonLight::splat(const GBuffer& seen, const WindowRays& rays, const Mat4& to_clip, const gl::Texture& layer,
                        Range photons) const {
  const gl::Framebuffer target({&layer}, &seen.depth());
  target.bind();
  splat_.use();
  splat_.set("to_clip", to_clip);
  splat_.set("first_photon", photons.first);
  glBindVertexArray(no_vertices_.name());
  // The far sides of the boxes are drawn where they lie behind the visible surface, so that the eye may be inside a
  // box.
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_FALSE);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_FRONT);
  glFrontFace(dot(cross(rays.right, rays.down), rays.axis) < 0 ? GL_CCW : GL_CW);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, corners_of_box, static_cast<GLsizei>(photons.count));
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_GREATER);
  glDisable(GL_DEPTH_TEST);
}

void PhotonLight::gather(const GBuffer& seen, const gl::Texture& layer, const TileLists& lists) const {
  const TileGrid grid{seen.width(), seen.height()};
  tiles_.use();
  tile_begins_.bind(gpu::unit_tile_begins, lists.begins.current());
  tile_photons_.bind(gpu::unit_tile_photons, lists.entries.current());
  layer.bind_image(gpu::image_of_technique, GL_READ_WRITE, GL_RGBA32F);
  // llvmpipe silently ends the loops of a shader after 65,535 iterations in all. Of n entries, w pixels at once may
  // take n (w + 1) iterations.
  constexpr std::uint32_t most = 2048;
  tiles_.set("count", static_cast<int>(most));
  for (std::uint32_t first = 0; first < lists.longest; first += most) {
    tiles_.set("first", static_cast<int>(first));
    glDispatchCompute(static_cast<GLuint>(grid.columns()), static_cast<GLuint>(grid.rows()), 1);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

void PhotonLight::draw(const GBuffer& seen, const WindowRays& rays, const Mat4& to_clip, const PhotonVolume& volume,
                       PhotonGather kind, const EyePaths& eye_paths, const gl::Texture& indirect,
                       const gl::Texture& caustic) {
  if (!frame_ || frame_->photons.empty()) return;
  const auto all = static_cast<std::uint32_t>(frame_->photons.size());
  seen.bind();
  photon_texels_.bind(gpu::unit_photons, photons_.current());
  const gl::Program& program = kind == PhotonGather::splat ? splat_ : tiles_;
  set_common(program, rays, volume);
  set_eye_paths(program, eye_paths);
  const auto add = [&](const gl::Texture& layer, Range photons, TileLists& of_tiles) {
    if (photons.count == 0) return;
    if (kind == PhotonGather::splat) {
      splat(seen, rays, to_clip, layer, photons);
      return;
    }
    of_tiles.write(photons_by_tile(std::span(frame_->photons).subspan(photons.first, photons.count), photons.first,
                                   to_clip, volume, {seen.width(), seen.height()}));
    gather(seen, layer, of_tiles);
  };
  add(indirect, {0, frame_->indirect}, indirect_tiles_);
  add(caustic, {frame_->indirect, all - frame_->indirect}, caustic_tiles_);
}

}  // namespace lanthorn
