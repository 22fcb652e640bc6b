// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Light from points (PointFlux of ibl/environment.h), over which kernels are summed.
#include "constants.glsl"
#include "layouts.glsl"
#include "splitsum_constants.glsl"
layout(std430, binding = storage_points) readonly buffer Points { PointFlux points[]; };
uniform int point_count;
