// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The same as splat.frag.glsl, tile by tile: each pixel adds up, in their order, the photons near it among those that may
// cover its tile (Mara, Luebke & McGuire 2013, "Toward Practical Real-Time Photon Mapping", section 4.3).
#include "gbuffer.glsl"
#include "photon.glsl"
layout(local_size_x = tile_side, local_size_y = tile_side) in;  // a tile
layout(binding = image_of_technique, rgba32f) uniform image2D radiance;
uniform int first, count;  // which entries of each list
// The lists of the tiles, one after the other, and where they begin: positions and numbers of photons
// (realtime/techniques/ispm/photon_light.h).
layout(binding = unit_tile_begins) uniform usamplerBuffer tile_begins;
layout(binding = unit_tile_photons) uniform usamplerBuffer tile_photons;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(radiance))) || is_background(pixel)) return;
  Surface at = surface_at(pixel);
  if (is_drawn_by_paths(at.material)) return;
  vec3 wi = direction_to_eye(at.position);
  float reach2 = radius * radius + half_height * half_height;
  int tile = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
  int next = int(texelFetch(tile_begins, tile).x) + first;
  int last = min(next + count, int(texelFetch(tile_begins, tile + 1).x));
  if (next >= last) return;
  vec3 sum = imageLoad(radiance, pixel).rgb;
  // Each pixel looks for its own next photon before all of them add theirs (Aila & Laine 2009, "while-while"). Few
  // pixels of a processor then wait for others, and the kernel is computed for few photons that are too far away.
  while (next < last) {
    uvec4 entry;
    for (bool is_near = false; next < last && !is_near; ++next) {
      entry = texelFetch(tile_photons, next);
      vec3 offset = at.position - uintBitsToFloat(entry.xyz);
      is_near = dot(offset, offset) <= reach2;
    }
    sum += photon_light(at, wi, fetch_photon(int(entry.w)));
  }
  imageStore(radiance, pixel, vec4(sum, 0));
}
