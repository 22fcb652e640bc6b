// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/voxel_light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "realtime/voxels.h"

namespace lanthorn {

namespace {

constexpr GLuint voxel_unit = 16;  // of voxels.glsl
constexpr int directions = 6;

GLuint groups(int invocations, int group) { return static_cast<GLuint>((invocations + group - 1) / group); }

}  // namespace

float turn_of_frame(std::uint32_t frame) {
  const double turns = frame / std::numbers::phi;
  return static_cast<float>(turns - std::floor(turns));
}

VoxelLight::VoxelLight(const gl::ShaderFiles& files)
    : shade_(gl::Program::compute(files, "voxel_shade.comp.glsl")),
      leaves_(gl::Program::compute(files, "voxel_leaves.comp.glsl")),
      mips_(gl::Program::compute(files, "voxel_mips.comp.glsl")),
      cones_(files, "screen.vert.glsl", "cones.frag.glsl") {}

bool VoxelLight::prepare(const Scene& scene, const GpuScene& gpu_scene, int size) {
  if (version_ == gpu_scene.surface_version() && size_ == size) return false;
  const Voxels voxels = voxelise(scene, gpu_scene, size);
  sides_ = gl::Buffer(voxels.sides);
  radiance_ = gl::Buffer(std::max<std::size_t>(1, voxels.sides.size()) * sizeof(glm::vec4));
  leaf_list_ = gl::Buffer(voxels.leaves);
  voxels_ =
      gl::Texture::volume(GL_RGBA16F, size, size, directions * size, std::countr_zero(static_cast<unsigned>(size)));
  voxels_.filter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR, GL_CLAMP_TO_EDGE);
  voxels_.clear();
  size_ = size;
  side_count_ = static_cast<int>(voxels.sides.size());
  leaf_count_ = static_cast<int>(voxels.leaves.size());
  voxel_side_ = voxels.side;
  corner_ = voxels.corner;
  version_ = gpu_scene.surface_version();
  return true;
}

void VoxelLight::set_grid(const gl::Program& program) const {
  voxels_.bind(voxel_unit);
  program.set("grid_corner", corner_);
  program.set("voxel_side", voxel_side_);
  program.set("grid_size", size_);
}

void VoxelLight::shade_sides(int view_count, const VoxelSettings& settings, bool has_cones) const {
  shade_.use();
  set_grid(shade_);
  shade_.set("side_count", side_count_);
  shade_.set("view_count", view_count);
  shade_.set("has_shadows", settings.has_shadows ? 1 : 0);
  shade_.set("has_cones", has_cones ? 1 : 0);
  shade_.set("turn", settings.turn);
  constexpr int group = 64;
  glDispatchCompute(groups(side_count_, group), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void VoxelLight::fill_levels() const {
  constexpr int leaf_group = 64, mip_group = 4;
  leaves_.use();
  leaves_.set("leaf_count", leaf_count_);
  leaves_.set("voxel_side", voxel_side_);
  voxels_.bind_image(0, GL_WRITE_ONLY, GL_RGBA16F);
  glDispatchCompute(groups(leaf_count_, leaf_group), 1, 1);
  mips_.use();
  voxels_.bind(voxel_unit);
  for (int level = 1; level < voxels_.levels(); ++level) {
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    mips_.set("level", level);
    voxels_.bind_image(0, GL_WRITE_ONLY, GL_RGBA16F, level);
    const int size = size_ >> level;
    glDispatchCompute(groups(size, mip_group), groups(size, mip_group), groups(directions * size, mip_group));
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void VoxelLight::light(const LightMaps& maps, int view_count, const VoxelSettings& settings) const {
  if (leaf_count_ == 0) return;
  maps.bind();
  sides_.bind_storage(5);
  radiance_.bind_storage(6);
  leaf_list_.bind_storage(7);
  for (int bounce = 0; bounce < settings.bounces; ++bounce) {
    shade_sides(view_count, settings, bounce > 0);
    fill_levels();
  }
}

void VoxelLight::use(const WindowRays& rays, const VoxelSettings& settings) const {
  cones_.use();
  set_grid(cones_);
  cones_.set("eye", rays.eye);
  cones_.set("axis", glm::vec4(rays.axis, rays.parallel ? 1 : 0));
  cones_.set("turn", settings.turn);
}

}  // namespace lanthorn
