// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The borders of the faces of a level: the nearest texels of the neighbouring faces, and at corners the mean of the three
// that meet there.
#include "constants.glsl"
#include "cube_map.glsl"
layout(local_size_x = work_group) in;
layout(binding = image_of_technique, rgba32f) uniform image2D map;
uniform int first_size;
uniform int level;

vec4 texel(CubeTexel t) { return imageLoad(map, place_of_texel(t, first_size, level)); }
// The texel beside an edge of the face, on the neighbouring face.
vec4 neighbour(int face, ivec2 at, int size) {
  // Just beyond the edge, so that the place along it is the same on both faces.
  const float beyond = 2e-5;
  vec2 place = clamp((2 * vec2(at) + 1) / size - 1, vec2(-1 - beyond), vec2(1 + beyond));
  CubePlace p = cube_place(cube_direction(face, place));
  return texel(CubeTexel(p.face, clamp(ivec2((0.5 * p.at + 0.5) * size), ivec2(0), ivec2(size - 1))));
}

void main() {
  int size = first_size >> level, around = 4 * (size + 1);
  if (gl_GlobalInvocationID.x >= uint(6 * around)) return;
  int face = int(gl_GlobalInvocationID.x) / around, i = int(gl_GlobalInvocationID.x) % around;
  int side = i / (size + 1), along = i % (size + 1) - 1;  // a corner and the texels after it
  ivec2 at = side == 0 ? ivec2(along, -1) : side == 1 ? ivec2(size, along) : side == 2 ? ivec2(size - 1 - along, size)
                                                                                       : ivec2(-1, size - 1 - along);
  vec4 value;
  if (along >= 0) {
    value = neighbour(face, at, size);
  } else {
    ivec2 inner = clamp(at, ivec2(0), ivec2(size - 1));
    value = (texel(CubeTexel(face, inner)) + neighbour(face, ivec2(at.x, inner.y), size) +
             neighbour(face, ivec2(inner.x, at.y), size)) / 3;
  }
  imageStore(map, place_of_texel(CubeTexel(face, at), first_size, level), value);
}
