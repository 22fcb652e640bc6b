// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "realtime/lights/light_maps.h"
#include "realtime/scene/gpu_scene.h"
#include "realtime/scene/projection.h"
#include "realtime/techniques/voxelcones/voxels.h"
#include "scene/scene.h"

namespace lanthorn {

inline constexpr int most_voxel_bounces = 16;

/// Settings of a frame.
struct VoxelSettings {
  int size = 64;    ///< voxels along an edge of each grid, a power of two
  int bounces = 4;  ///< on surfaces before the one that the eye sees; at least 1
  int grids = 0;    ///< of the clipmap (`voxel_grids`); 0: as many as the view needs
  float turn = 0;   ///< of the cones around the normal, in turns
  bool has_shadows = true;
};

/// Turns that cover the circle evenly over any number of frames: the golden ratio's.
float turn_of_frame(std::uint32_t frame);

/// Voxel cone tracing (Crassin et al. 2011): light of the voxels on visible surfaces.
class VoxelLight {
 public:
  explicit VoxelLight(const gl::ShaderFiles& files);

  /// Voxelises the surfaces in the grids that the view needs, if surfaces or grids have changed; returns whether they
  /// have.
  bool prepare(const Scene& scene, const GpuScene& gpu_scene, const View& view, const VoxelSettings& settings);
  /// Lights the voxels anew. The scene must be bound; the maps belong to the views.
  void light(const LightMaps& maps, int view_count, const VoxelSettings& settings) const;
  /// Uses the program cones.frag.glsl with the voxels. G-buffer and scene must be bound.
  void use(const WindowRays& rays, const VoxelSettings& settings, const EyePaths& eye_paths) const;

 private:
  void upload();
  void set_grids(const gl::Program& program) const;
  void shade_sides(int view_count, const VoxelSettings& settings, bool has_cones) const;
  void fill_levels() const;

  gl::Program shade_, leaves_, mips_, cones_;
  gl::Buffer sides_, radiance_, leaf_list_;
  gl::Texture voxels_;
  std::vector<Voxels> grids_;  // of a clipmap, the widest first
  int side_count_ = 0, leaf_count_ = 0;
  Bounds bounds_;              // of the surfaces
  std::uint64_t version_ = 0;  // of the surfaces that are voxelised; 0: none
};

}  // namespace lanthorn
