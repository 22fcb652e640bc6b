// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The same as splat.frag.glsl, tile by tile: each tile finds among the photons that may cover it those near its surfaces,
// each pixel adds them up in their order (Mara, Luebke & McGuire 2013, "Toward Practical Real-Time Photon Mapping", section 4.3).
#include "gbuffer.glsl"
#include "eye.glsl"
#include "photon.glsl"
const uint side = 16u, batch = side * side;
layout(local_size_x = 16, local_size_y = 16) in;
layout(binding = 0, rgba32f) uniform image2D radiance;
// Element t: where the list of tile t begins here; the lists are numbers of photons (realtime/photon_tiles.h).
layout(std430, binding = 9) readonly buffer TilePhotons { uint tile_photons[]; };
shared uint low[3], high[3];
shared uint near_tile[batch / 32u];

// Floats as integers of the same order.
uint ordered(float x) {
  uint bits = floatBitsToUint(x);
  return (bits >> 31u) != 0u ? ~bits : bits | 0x80000000u;
}
float unordered(uint bits) { return uintBitsToFloat((bits >> 31u) != 0u ? bits & 0x7fffffffu : ~bits); }

void bound_tile(vec3 p, bool is_surface) {
  uint i = gl_LocalInvocationIndex;
  if (i < 3u) {
    low[i] = ~0u;
    high[i] = 0u;
  }
  barrier();
  if (is_surface)
    for (int k = 0; k < 3; ++k) {
      atomicMin(low[k], ordered(p[k]));
      atomicMax(high[k], ordered(p[k]));
    }
  barrier();
}

bool is_near(Photon p) {
  vec3 a = vec3(unordered(low[0]), unordered(low[1]), unordered(low[2]));
  vec3 b = vec3(unordered(high[0]), unordered(high[1]), unordered(high[2]));
  // A box around the volume, in world space.
  vec3 n = abs(p.normal.xyz), reach = 1.001 * (radius * sqrt(max(vec3(0), 1 - n * n)) + half_height * n);
  return all(greaterThanEqual(p.position.xyz + reach, a)) && all(lessThanEqual(p.position.xyz - reach, b));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  bool is_surface = all(lessThan(pixel, imageSize(radiance))) && !is_background(pixel);
  Surface at = surface_at(pixel);
  vec3 wi = direction_to_eye(at.position);
  bound_tile(at.position, is_surface);
  uint i = gl_LocalInvocationIndex;
  vec3 sum = vec3(0);
  uint tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x, last = tile_photons[tile + 1u];
  for (uint begin = tile_photons[tile]; begin < last; begin += batch) {
    if (i < batch / 32u) near_tile[i] = 0u;
    barrier();
    uint own = begin + i;
    if (own < last && is_near(photons[tile_photons[own]])) atomicOr(near_tile[i / 32u], 1u << (i % 32u));
    barrier();
    for (uint word = 0u; word < batch / 32u; ++word)
      for (uint bits = near_tile[word]; bits != 0u; bits &= bits - 1u)
        if (is_surface)
          sum += photon_light(at, wi, photons[tile_photons[begin + 32u * word + uint(findLSB(bits))]]);
    barrier();
  }
  if (is_surface) imageStore(radiance, pixel, vec4(sum, 0));
}
