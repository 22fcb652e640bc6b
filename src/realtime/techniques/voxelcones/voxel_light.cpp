// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/voxelcones/voxel_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>

#include "realtime/scene/materials.h"

namespace lanthorn {

namespace {

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

bool VoxelLight::prepare(const Scene& scene, const GpuScene& gpu_scene, const View& view,
                         const VoxelSettings& settings) {
  const bool is_new = version_ != gpu_scene.surface_version();
  std::optional<GpuTriangles> triangles;  // read if they are needed
  if (is_new) {
    grids_.clear();
    bounds_ = bounds_of(gpu_scene, triangles.emplace(gpu_scene));
    version_ = gpu_scene.surface_version();
  }
  const std::vector<VoxelGrid> wanted = voxel_grids(bounds_, settings.size, focus_of(scene, view), settings.grids);
  if (std::equal(grids_.begin(), grids_.end(), wanted.begin(), wanted.end(),
                 [](const Voxels& have, const VoxelGrid& want) { return have.grid == want; }))
    return false;
  const auto held = [&](const VoxelGrid& grid) {
    return std::find_if(grids_.begin(), grids_.end(), [&](const Voxels& v) { return v.grid == grid; });
  };
  std::vector<Voxels> grids(wanted.size());
  for (std::size_t g = 0; g < wanted.size(); ++g) {
    if (held(wanted[g]) != grids_.end()) continue;
    if (!triangles) triangles.emplace(gpu_scene);
    grids[g] = voxelise(scene, gpu_scene, *triangles, wanted[g]);
  }
  // Voxelising may throw: grids that stay are moved only when all other grids are complete.
  for (std::size_t g = 0; g < wanted.size(); ++g)
    if (const auto same = held(wanted[g]); same != grids_.end()) grids[g] = std::move(*same);
  grids_ = std::move(grids);
  upload();
  return true;
}

void VoxelLight::upload() {
  std::vector<VoxelSide> sides;
  std::vector<VoxelLeaf> leaves;
  for (std::size_t g = 0; g < grids_.size(); ++g) {
    const auto first_side = static_cast<std::uint32_t>(sides.size());
    for (VoxelSide side : grids_[g].sides) {
      side.normal.w = static_cast<float>(g);
      sides.push_back(side);
    }
    for (VoxelLeaf leaf : grids_[g].leaves) {
      leaf.first_side += first_side;
      leaf.grid = static_cast<std::uint32_t>(g);
      leaves.push_back(leaf);
    }
  }
  sides_ = gl::Buffer(sides);
  radiance_ = gl::Buffer(std::max<std::size_t>(1, sides.size()) * sizeof(glm::vec4));
  leaf_list_ = gl::Buffer(leaves);
  side_count_ = static_cast<int>(sides.size());
  leaf_count_ = static_cast<int>(leaves.size());
  const int size = grids_.front().grid.size, width = size * static_cast<int>(grids_.size());
  if (voxels_.width() != width || voxels_.height() != size) {
    voxels_ =
        gl::Texture::volume(GL_RGBA16F, width, size, directions * size, std::countr_zero(static_cast<unsigned>(size)));
    voxels_.filter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR, GL_CLAMP_TO_EDGE);
  }
  voxels_.clear();
}

void VoxelLight::set_grids(const gl::Program& program) const {
  voxels_.bind(gpu::unit_voxels);
  program.set("grid_count", static_cast<int>(grids_.size()));
  program.set("grid_size", grids_.front().grid.size);
  program.set("coarsest_side", grids_.front().grid.side);
  for (std::size_t g = 0; g < grids_.size(); ++g)
    program.set(fmt::format("grid_corners[{}]", g).c_str(), grids_[g].grid.corner);
}

void VoxelLight::shade_sides(int view_count, const VoxelSettings& settings, bool has_cones) const {
  shade_.use();
  set_grids(shade_);
  shade_.set("side_count", side_count_);
  shade_.set("view_count", view_count);
  shade_.set("has_shadows", settings.has_shadows ? 1 : 0);
  shade_.set("has_cones", has_cones ? 1 : 0);
  shade_.set("turn", settings.turn);
  glDispatchCompute(groups(side_count_, gpu::work_group), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void VoxelLight::fill_levels() const {
  leaves_.use();
  leaves_.set("leaf_count", leaf_count_);
  leaves_.set("coarsest_side", grids_.front().grid.side);
  voxels_.bind_image(gpu::image_of_technique, GL_WRITE_ONLY, GL_RGBA16F);
  glDispatchCompute(groups(leaf_count_, gpu::work_group), 1, 1);
  mips_.use();
  voxels_.bind(gpu::unit_voxels);
  for (int level = 1; level < voxels_.levels(); ++level) {
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    mips_.set("level", level);
    voxels_.bind_image(gpu::image_of_technique, GL_WRITE_ONLY, GL_RGBA16F, level);
    const int size = voxels_.height() >> level, width = voxels_.width() >> level;
    glDispatchCompute(groups(width, gpu::voxel_block), groups(size, gpu::voxel_block),
                      groups(directions * size, gpu::voxel_block));
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void VoxelLight::light(const LightMaps& maps, int view_count, const VoxelSettings& settings) const {
  if (leaf_count_ == 0) return;
  maps.bind();
  sides_.bind_storage(gpu::storage_sides);
  radiance_.bind_storage(gpu::storage_side_radiance);
  leaf_list_.bind_storage(gpu::storage_leaves);
  for (int bounce = 0; bounce < settings.bounces; ++bounce) {
    shade_sides(view_count, settings, bounce > 0);
    fill_levels();
  }
}

void VoxelLight::use(const WindowRays& rays, const VoxelSettings& settings, const EyePaths& eye_paths) const {
  cones_.use();
  set_eye_paths(cones_, eye_paths);
  set_grids(cones_);
  cones_.set("eye", rays.eye);
  cones_.set("axis", glm::vec4(rays.axis, rays.parallel ? 1 : 0));
  cones_.set("turn", settings.turn);
  cones_.set("least_sky_alpha", least_alpha_under_sky);
}

}  // namespace lanthorn
