// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Radiance in voxels and cones through it (Crassin et al. 2011, "Interactive Indirect Illumination Using Voxel Cone
// Tracing", sections 4 to 7). The texture has six blocks one above the other in z, one for each direction +x -x +y -y +z
// -z: what the surfaces in a voxel send to where that axis points, times the share of the voxel that they cover; a: that
// share. Each level is half as fine as the one before.
#include "frame.glsl"
#include "pi.glsl"
layout(binding = 16) uniform sampler3D voxel_radiance;
uniform vec3 grid_corner;
uniform float voxel_side;  // m
uniform int grid_size;     // voxels along an edge

// What a voxel around the point sends against the direction d: from the blocks of the axes that d looks against. Through
// a way of its length, surfaces that cover the share c along an axis lie in the way with the probability |d| c, since
// oblique rays stay in their layer for longer. A layer that covers all must let nothing pass, wherever the samples of
// the way fall in it: they see it in parts. So what is seen counts twice, up to all. Crassin's weights d² leak: a wall
// seen obliquely lets most light pass.
vec4 voxel_towards(vec3 place, vec3 d, float level) {
  // No filter reaches into the next block.
  float margin = 0.5 * exp2(ceil(level)) / grid_size;
  float z = clamp(place.z, margin, 1 - margin);
  vec3 block = vec3(0, 2, 4) + vec3(greaterThan(d, vec3(0)));
  vec3 w = 2 * abs(d);
  vec4 voxel = w.x * textureLod(voxel_radiance, vec3(place.xy, (z + block.x) / 6), level) +
               w.y * textureLod(voxel_radiance, vec3(place.xy, (z + block.y) / 6), level) +
               w.z * textureLod(voxel_radiance, vec3(place.xy, (z + block.z) / 6), level);
  return voxel / max(1, voxel.a);
}

// Radiance of a cone, and in a the share of it that ends at surfaces. `n`: the surface that it starts from. Samples are
// narrower than they are high above it: the filter reaches as far as a voxel is wide, and the back of the surface, which
// may be dark, must stay out of it.
vec4 trace_cone(vec3 from, vec3 n, vec3 d, float tan_half_angle) {
  const float start_height = 1.25;  // voxels above the surface
  const float width_by_height = 0.25;
  vec3 origin = from + start_height * voxel_side * n;
  float slope = dot(n, d), t = 0.5 * voxel_side;
  vec4 sum = vec4(0);
  for (int i = 0; i < 512 && sum.a < 0.995; ++i) {
    vec3 place = (origin + t * d - grid_corner) / (voxel_side * grid_size);
    if (any(lessThan(place, vec3(0))) || any(greaterThan(place, vec3(1)))) break;
    float width = max(voxel_side, min(2 * tan_half_angle * t, width_by_height * (start_height * voxel_side + slope * t)));
    vec4 voxel = voxel_towards(place, d, log2(width / voxel_side));
    sum += (1 - sum.a) * voxel;
    t += width;
  }
  return sum;
}

// (1/pi) times the irradiance on the side of n: a cone of 30 degrees along n, which holds a quarter of the
// cosine-weighted hemisphere, and five around it at 60 degrees for the rest. `turn`: of these, in turns.
vec3 diffuse_cones(vec3 from, vec3 n, float turn) {
  const float tan_half_angle = 0.57735;
  mat3 frame = frame_around(n);
  vec3 sum = 0.25 * trace_cone(from, n, n, tan_half_angle).rgb;
  for (int i = 0; i < 5; ++i) {
    float azimuth = 2 * pi * (i / 5.0 + turn);
    vec3 d = frame * vec3(0.866025 * cos(azimuth), 0.866025 * sin(azimuth), 0.5);
    sum += 0.15 * trace_cone(from, n, d, tan_half_angle).rgb;
  }
  return sum;
}
