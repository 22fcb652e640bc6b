// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Radiance in voxels, and cones through it (Crassin et al. 2011, "Interactive Indirect Illumination Using Voxel Cone
// Tracing", sections 4 to 7). The texture has six blocks one above the other in z, one for each direction +x -x +y -y
// +z -z: the radiance that the surfaces in a voxel send along that direction, times the share of the voxel that they
// cover; a: that share. Each level is half as fine as the one before. Grids lie side by side in x: grid 0 holds the
// whole scene, and the voxels of each further grid are half as wide as those of the grid before.
#include "frame.glsl"
#include "constants.glsl"
#include "layouts.glsl"
#include "voxelcones_constants.glsl"
layout(binding = unit_voxels) uniform sampler3D voxel_radiance;
uniform int grid_count;
uniform vec3 grid_corners[most_voxel_grids];
uniform float coarsest_side;  // edge of a voxel of grid 0, m
uniform int grid_size;        // voxels along an edge

// Edge of the voxels of a grid, m.
float side_of(int grid) { return ldexp(coarsest_side, -grid); }

// A point in a grid, which reaches from 0 to 1.
vec3 place_in(int grid, vec3 point) { return (point - grid_corners[grid]) / (side_of(grid) * grid_size); }

// The finest grid, up to `finest`, that holds the surroundings of a point: this far, and this many of its voxels. Grid
// 0 holds everything.
int grid_around(vec3 point, float distance, float voxels, int finest) {
  for (int grid = finest; grid > 0; --grid) {
    vec3 place = place_in(grid, point);
    float margin = max(distance / side_of(grid), voxels) / grid_size;
    if (all(greaterThan(place, vec3(margin))) && all(lessThan(place, vec3(1 - margin)))) return grid;
  }
  return 0;
}

// Radiance that a voxel around the point sends against the direction d: from the blocks of directions against d. Along
// a way of one voxel, surfaces that cover the share c along an axis are met with probability |d| c, since oblique rays
// stay in their layer for longer. A layer that covers everything must let nothing pass, wherever the samples fall in
// it, although each sees only a part of it. So the result counts twice, up to full coverage. Crassin's weights d² leak:
// a wall seen obliquely lets most light pass.
vec4 voxel_towards(int grid, vec3 place, vec3 d, float level) {
  // No filter reaches into the next block or grid.
  float margin = 0.5 * exp2(ceil(level)) / grid_size;
  float x = (clamp(place.x, margin, 1 - margin) + grid) / grid_count, z = clamp(place.z, margin, 1 - margin);
  vec3 block = vec3(0, 2, 4) + vec3(greaterThan(d, vec3(0)));
  vec3 w = 2 * abs(d);
  vec4 voxel = w.x * textureLod(voxel_radiance, vec3(x, place.y, (z + block.x) / 6), level) +
               w.y * textureLod(voxel_radiance, vec3(x, place.y, (z + block.y) / 6), level) +
               w.z * textureLod(voxel_radiance, vec3(x, place.y, (z + block.z) / 6), level);
  return voxel / max(1, voxel.a);
}

// The grid for cones from a point: the finest one with a number of its voxels around the point. The number depends on
// the turn of the frame, so that the mean over frames has no seams where grids end.
int grid_of_cones(vec3 from, float turn, int finest) {
  return grid_around(from, 0, 2 + turn * grid_size / 8, finest);
}

// Radiance of a cone; a: the share of it that ends at surfaces. `n`: normal of the surface where it starts, in `grid`.
// Samples are narrower than their height above that surface: the filter is as wide as a voxel, and must not reach the
// back of the surface, which may be dark. Each sample takes the finest grid that holds it.
vec4 trace_cone(vec3 from, vec3 n, vec3 d, float tan_half_angle, int grid) {
  const float width_by_height = 0.25;
  float start_height = 1.25 * side_of(grid);
  vec3 origin = from + start_height * n;
  float slope = dot(n, d), t = 0.5 * side_of(grid);
  vec4 sum = vec4(0);
  for (int i = 0; i < 512 && sum.a < 0.995; ++i) {
    vec3 point = origin + t * d;
    float width = min(2 * tan_half_angle * t, width_by_height * (start_height + slope * t));
    int sampled = grid_around(point, width, 1, grid_count - 1);
    vec3 place = place_in(sampled, point);
    if (any(lessThan(place, vec3(0))) || any(greaterThan(place, vec3(1)))) break;
    float side = side_of(sampled);
    width = max(side, width);
    sum += (1 - sum.a) * voxel_towards(sampled, place, d, log2(width / side));
    t += width;
  }
  return sum;
}

// (1/pi) times the irradiance on the side of n: a cone of 30 degrees along n, which holds a quarter of the
// cosine-weighted hemisphere, and five around it at 60 degrees for the rest. `turn`: of these, in turns. `finest`: of
// the grids from which they may start.
vec3 diffuse_cones(vec3 from, vec3 n, float turn, int finest) {
  const float tan_half_angle = 0.57735;
  int grid = grid_of_cones(from, turn, finest);
  mat3 frame = frame_around(n);
  vec3 sum = 0.25 * trace_cone(from, n, n, tan_half_angle, grid).rgb;
  for (int i = 0; i < 5; ++i) {
    float azimuth = 2 * pi * (i / 5.0 + turn);
    vec3 d = frame * vec3(0.866025 * cos(azimuth), 0.866025 * sin(azimuth), 0.5);
    sum += 0.15 * trace_cone(from, n, d, tan_half_angle, grid).rgb;
  }
  return sum;
}
