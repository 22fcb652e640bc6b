// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Fills a G-buffer: of the eye (EYE is defined), or of a light.
#include "scene.glsl"
#include "bsdf.glsl"
uniform vec3 eye;       // orthographic: any point
uniform vec4 axis;      // forward; a: 1 if all rays are parallel
in vec3 position;
in vec3 normal;
in vec2 uv;
flat in uint draw;
layout(location = 0) out vec4 out_position;
layout(location = 1) out uvec4 out_surface;
layout(location = 2) out vec4 out_colour;
#ifdef EYE
layout(location = 3) out vec4 out_emission;
#endif

vec3 corner(Draw d, uint i) {
  return vertices[d.base_vertex + indices[d.first_index + 3u * uint(gl_PrimitiveID) + i]].position_u.xyz;
}

void main() {
  Draw d = draws[draw];
  vec3 p0 = corner(d, 0u);
  vec3 facing = normalize((d.normal_to_world * vec4(cross(corner(d, 1u) - p0, corner(d, 2u) - p0), 0)).xyz);
  vec3 shading = dot(normal, normal) > 0 ? normalize(normal) : facing;
  if (dot(facing, shading) < 0) facing = -facing;
  Material m = materials[d.material];
  vec4 colour = (m.flags & flag_textured) != 0u ? vec4(textureLod(textures, vec3(uv, m.layer), 0)) : m.colour;
  float depth = dot(position - eye, axis.xyz);
  out_position = vec4(position, max(depth, 1e-30));
  out_surface = uvec4(encode_octahedral(shading), encode_octahedral(facing), d.material,
                      d.first_index / 3u + uint(gl_PrimitiveID));
  out_colour = colour;
#ifdef EYE
  vec3 back = axis.a > 0 ? -axis.xyz : eye - position;
  bool emits = d.emission.a > 0 || dot(facing, back) > 0;
  out_emission = vec4(emits ? d.emission.rgb : vec3(0), 1);
#endif
}
