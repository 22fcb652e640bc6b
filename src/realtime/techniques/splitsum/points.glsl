// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Light from points (PointFlux of ibl/environment.h), for sums of kernels over them.
#include "constants.glsl"
#include "splitsum_constants.glsl"
struct PointFlux {
  vec4 direction;
  vec4 flux;
};
layout(std430, binding = storage_points) readonly buffer Points { PointFlux points[]; };
uniform int point_count;
