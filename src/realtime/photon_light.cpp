// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/photon_light.h"

#include <span>
#include <utility>

namespace lanthorn {

namespace {

constexpr GLsizei corners_of_box = 14;  // of a strip of triangles

void set_common(const gl::Program& program, const WindowRays& rays, const PhotonVolume& volume) {
  program.set("radius", volume.radius);
  program.set("half_height", volume.half_height);
  program.set("eye", rays.eye);
  program.set("axis", glm::vec4(rays.axis, rays.parallel ? 1 : 0));
}

}  // namespace

PhotonLight::PhotonLight(const gl::ShaderFiles& files, const std::string& closures)
    : splat_(files, "splat.vert.glsl", "splat.frag.glsl", closures),
      tiles_(gl::Program::compute(files, "gather.comp.glsl", closures)),
      no_vertices_(gl::make_vertex_array()) {}

void PhotonLight::upload(FramePhotons photons) {
  frame_ = std::move(photons);
  photons_.write(frame_.photons);
}

void PhotonLight::splat(const GBuffer& seen, const WindowRays& rays, const Mat4& to_clip, const gl::Texture& layer,
                        Range photons) const {
  const gl::Framebuffer target({&layer}, &seen.depth());
  target.bind();
  splat_.use();
  splat_.set("to_clip", to_clip);
  splat_.set("first_photon", photons.first);
  glBindVertexArray(no_vertices_.name());
  // The far sides of the boxes are drawn where they lie behind what is seen: so the eye may be inside.
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

void PhotonLight::gather(const GBuffer& seen, const gl::Texture& layer, const gl::Buffer& photons_of_tiles) const {
  const TileGrid grid{seen.width(), seen.height()};
  tiles_.use();
  photons_of_tiles.bind_storage(9);
  layer.bind_image(0, GL_WRITE_ONLY, GL_RGBA32F);
  glDispatchCompute(static_cast<GLuint>(grid.columns()), static_cast<GLuint>(grid.rows()), 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

void PhotonLight::draw(const GBuffer& seen, const WindowRays& rays, const Mat4& to_clip, const PhotonVolume& volume,
                       PhotonGather kind, const gl::Texture& indirect, const gl::Texture& caustic) {
  const auto all = static_cast<std::uint32_t>(frame_.photons.size());
  if (all == 0) return;
  seen.bind();
  photons_.current().bind_storage(8);
  set_common(kind == PhotonGather::splat ? splat_ : tiles_, rays, volume);
  const auto add = [&](const gl::Texture& layer, Range photons, gl::AlternatingBuffer& of_tiles) {
    if (photons.count == 0) return;
    if (kind == PhotonGather::splat) {
      splat(seen, rays, to_clip, layer, photons);
      return;
    }
    of_tiles.write(photons_by_tile(std::span(frame_.photons).subspan(photons.first, photons.count), photons.first,
                                   to_clip, volume, {seen.width(), seen.height()}));
    gather(seen, layer, of_tiles.current());
  };
  add(indirect, {0, frame_.indirect}, indirect_tiles_);
  add(caustic, {frame_.indirect, all - frame_.indirect}, caustic_tiles_);
}

}  // namespace lanthorn
