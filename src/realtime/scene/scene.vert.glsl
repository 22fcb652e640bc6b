// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene.glsl"
uniform mat4 to_clip;
layout(location = 0) in vec4 position_u;
layout(location = 1) in vec4 normal_v;
layout(location = 2) in uint draw_number;
out vec3 position;
out vec3 normal;
out vec2 uv;
flat out uint draw;

void main() {
  Draw d = draws[draw_number];
  // Triangles that approximate a round shape are moved outwards, so that none of their points lies inside it.
  vec3 local = position_u.xyz;
  position = (d.to_world * vec4(local, 1)).xyz;
  normal = (d.normal_to_world * vec4(normal_v.xyz, 0)).xyz;
  if (d.slack > 0) position += d.slack * normalize(normal);
  uv = vec2(position_u.w, normal_v.w);
  draw = draw_number;
  gl_Position = to_clip * vec4(position, 1);
}
