// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The maps of an environment on the GPU, for split-sum shading, and their baker by compute shaders.
#pragma once

#include <vector>

#include "gl/program.h"
#include "gl/texture.h"
#include "ibl/cube_map.h"
#include "ibl/environment.h"
#include "ibl/split_sum.h"
#include "lanthorn/ibl.h"

namespace lanthorn {

/// Cube maps of halving sizes in one texture, RGBA32F, with their borders; the layout of cube_map.glsl.
class CubeAtlas {
 public:
  CubeAtlas() = default;
  /// Room for `levels` maps, the first of `size`.
  CubeAtlas(int size, int levels);
  explicit CubeAtlas(const std::vector<CubeMap>& levels);

  void write(int level, const CubeMap& map);
  /// Waits for the GPU.
  CubeMap read(int level) const;
  int size() const { return size_; }
  int levels() const { return levels_; }
  const gl::Texture& texture() const { return texture_; }

 private:
  struct Corner {
    int x = 0, y = 0;
  };
  Corner corner(int level) const;

  int size_ = 0, levels_ = 0;
  gl::Texture texture_;
};

/// The data of `SplitSum` on the GPU.
struct EnvironmentMaps {
  CubeAtlas reflections, irradiance;
  gl::Texture brdf;  ///< RG32F

  EnvironmentMaps() = default;
  /// Uploads the maps of the CPU's baker.
  explicit EnvironmentMaps(const SplitSum& maps);

  /// For a program that includes environment_maps.glsl.
  void bind(const gl::Program& program) const;
};

/// The maps of `bake_ibl` by compute shaders. The CPU finds the suns, halves the environment and draws the samples; the
/// GPU does the sums over them, which take nearly all of the time.
class EnvironmentBaker {
 public:
  explicit EnvironmentBaker(const gl::ShaderFiles& files);

  /// Irradiance, specular levels and the table of `split_sum_table_size`. Sizes must be powers of two.
  EnvironmentMaps bake(const Image& environment, const IblSettings& settings) const;

 private:
  void bake_irradiance(const std::vector<PointFlux>& points, CubeAtlas& map) const;
  void close_seams(CubeAtlas& map, int level) const;
  void bake_table(gl::Texture& table) const;

  gl::Program irradiance_, prefilter_, seams_, brdf_;
};

}  // namespace lanthorn
