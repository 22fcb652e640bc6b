// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The maps of `bake_ibl` by compute shaders. The CPU finds the suns, halves the environment and draws the samples; the
// GPU does the sums over them, which take nearly all of the time.
#pragma once

#include <vector>

#include "gl/program.h"
#include "ibl/environment.h"
#include "lanthorn/ibl.h"
#include "realtime/techniques/splitsum/environment_maps.h"

namespace lanthorn {

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
