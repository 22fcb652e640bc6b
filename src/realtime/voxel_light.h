// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "realtime/gpu_scene.h"
#include "realtime/light_maps.h"
#include "realtime/projection.h"
#include "scene/scene.h"

namespace lanthorn {

inline constexpr int least_voxels = 16, most_voxels = 256, most_voxel_bounces = 16;

/// Settings of IndirectLight::voxels.
struct VoxelSettings {
  int size = 64;    ///< voxels along an edge of the grid, a power of two
  int bounces = 4;  ///< on surfaces before the one that the eye sees; at least 1
  float turn = 0;   ///< of the cones around the normal, in turns
  bool has_shadows = true;
};

/// Turns that cover the circle evenly over any number of frames: the golden ratio's.
float turn_of_frame(std::uint32_t frame);

/// Voxel cone tracing (Crassin et al. 2011): light of the voxels at what the eye sees.
class VoxelLight {
 public:
  explicit VoxelLight(const gl::ShaderFiles& files);

  /// Voxelises the surfaces, if they or the size are others than before; true if so.
  bool prepare(const Scene& scene, const GpuScene& gpu_scene, int size);
  /// Lights the voxels anew. The scene must be bound; the maps are those of the views.
  void light(const LightMaps& maps, int view_count, const VoxelSettings& settings) const;
  /// Uses the program cones.frag.glsl with the voxels. G-buffer and scene must be bound.
  void use(const WindowRays& rays, const VoxelSettings& settings) const;

 private:
  void set_grid(const gl::Program& program) const;
  void shade_sides(int view_count, const VoxelSettings& settings, bool has_cones) const;
  void fill_levels() const;

  gl::Program shade_, leaves_, mips_, cones_;
  gl::Buffer sides_, radiance_, leaf_list_;
  gl::Texture voxels_;
  int size_ = 0, side_count_ = 0, leaf_count_ = 0;
  float voxel_side_ = 1;
  Point corner_{0};
  std::uint64_t version_ = 0;  // of the surfaces that are voxelised; 0: none
};

}  // namespace lanthorn
