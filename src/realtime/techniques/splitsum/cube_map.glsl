// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Cube maps with borders, as ibl/cube_map.h has them: faces of size + 2 texels, one above the other. The first level
// lies at the left of its texture; the others, each half as wide as the one before, one above the other beside it.
ivec2 level_corner(int first_size, int level) {
  if (level == 0) return ivec2(0);
  int y = 0;
  for (int l = 1; l < level; ++l) y += 6 * ((first_size >> l) + 2);
  return ivec2(first_size + 2, y);
}

struct CubePlace {
  int face;
  vec2 at;  // in [-1,1]², y down
};
CubePlace cube_place(vec3 d) {
  vec3 a = abs(d);
  if (a.x >= a.y && a.x >= a.z) return CubePlace(d.x >= 0 ? 0 : 1, vec2(d.x >= 0 ? -d.z : d.z, -d.y) / a.x);
  if (a.y >= a.z) return CubePlace(d.y >= 0 ? 2 : 3, vec2(d.x, d.y >= 0 ? d.z : -d.z) / a.y);
  return CubePlace(d.z >= 0 ? 4 : 5, vec2(d.z >= 0 ? d.x : -d.x, -d.y) / a.z);
}
vec3 cube_direction(int face, vec2 at) {
  if (face == 0) return normalize(vec3(1, -at.y, -at.x));
  if (face == 1) return normalize(vec3(-1, -at.y, at.x));
  if (face == 2) return normalize(vec3(at.x, 1, at.y));
  if (face == 3) return normalize(vec3(at.x, -1, -at.y));
  if (face == 4) return normalize(vec3(at, 1) * vec3(1, -1, 1));
  return normalize(vec3(-at, -1));
}

// Bilinear by single texels, so that all devices find the CPU's result: their own filters are less exact.
vec3 cube_lookup(sampler2D maps, int first_size, int level, vec3 d) {
  int size = first_size >> level;
  CubePlace p = cube_place(d);
  vec2 place = 0.5 * p.at * size + 0.5 * (size + 1);
  ivec2 low = min(ivec2(place), ivec2(size));
  vec2 f = place - vec2(low);
  ivec2 corner = level_corner(first_size, level) + ivec2(0, p.face * (size + 2)) + low;
  vec3 above = mix(texelFetch(maps, corner, 0).rgb, texelFetch(maps, corner + ivec2(1, 0), 0).rgb, f.x);
  vec3 below = mix(texelFetch(maps, corner + ivec2(0, 1), 0).rgb, texelFetch(maps, corner + ivec2(1), 0).rgb, f.x);
  return mix(above, below, f.y);
}

// Inside a face of a map that a compute shader fills: one invocation for each texel of a level.
struct CubeTexel {
  int face;
  ivec2 at;
};
CubeTexel own_texel(uint number, int size) {
  int i = int(number);
  return CubeTexel(i / (size * size), ivec2(i % size, i / size % size));
}
vec3 direction_of_texel(CubeTexel t, int size) { return cube_direction(t.face, (2 * vec2(t.at) + 1) / size - 1); }
ivec2 place_of_texel(CubeTexel t, int first_size, int level) {
  int size = first_size >> level;
  return level_corner(first_size, level) + ivec2(1, t.face * (size + 2) + 1) + t.at;
}
