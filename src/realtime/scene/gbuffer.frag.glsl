// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Fills a G-buffer: of the eye (EYE is defined), or of a light. HAS_PATTERNS: emission or opacity of
// some draws varies. NO_TEXTURED_LOBES, NO_NORMAL_MAPS: software drivers execute all branches.
#include "scene.glsl"
#include "bsdf.glsl"
#include "random.glsl"
uniform vec3 eye;       // orthographic: any point
uniform vec4 axis;      // forward; a: 1 if all rays are parallel
uniform uint frame;     // for random numbers
in vec3 position;
in vec3 normal;
in vec2 uv;
flat in uint draw;
layout(location = 0) out vec4 out_position;
layout(location = 1) out uvec4 out_surface;
layout(location = 2) out vec4 out_colour;
#ifdef EYE
layout(location = 3) out vec4 out_emission;
layout(location = 4) out vec4 out_lobe;
#endif

Vertex corner(Draw d, uint i) {
  return vertices[d.base_vertex + indices[d.first_index + 3u * uint(gl_PrimitiveID) + i]];
}

#ifndef NO_NORMAL_MAPS
// The normal of a map, as material/relief.cpp: x along dp/du, y along dp/dv, in the hemisphere of the geometric normal.
vec3 mapped_normal(Draw d, Vertex a, Vertex b, Vertex c, vec3 smooth_normal, vec3 facing, vec3 local) {
  mat3 to_world = mat3(d.to_world);
  vec3 along_b = to_world * (b.position - a.position), along_c = to_world * (c.position - a.position);
  vec2 uv_b = vec2(b.u - a.u, b.v - a.v);
  vec2 uv_c = vec2(c.u - a.u, c.v - a.v);
  float area = uv_b.x * uv_c.y - uv_b.y * uv_c.x;
  vec3 dpdu = (uv_c.y * along_b - uv_b.y * along_c) * sign(area);
  vec3 dpdv = (uv_b.x * along_c - uv_c.x * along_b) * sign(area);
  vec3 s = dpdu - dot(dpdu, smooth_normal) * smooth_normal;
  if (dot(s, s) == 0) return smooth_normal;
  s = normalize(s);
  vec3 t = cross(smooth_normal, s);
  if (dot(t, dpdv) < 0) t = -t;
  vec3 mapped = normalize(mat3(s, t, smooth_normal) * local);
  const float lowest = 0.01;
  float cosine = dot(mapped, facing);
  return cosine >= lowest ? mapped : normalize(mapped + (lowest - cosine) * facing);
}
#endif

// Emission as a share of the draw's, and opacity.
vec4 pattern_of(Draw d) {
#ifdef HAS_PATTERNS
  if (d.layer != no_layer) return textureLod(textures, vec3(uv, d.layer), 0);
#endif
  return vec4(1);
}

// Random number in [0,1) of this triangle in this pixel of this frame.
float uniform_number() {
  uvec4 bits = pcg4d(uvec4(uvec2(gl_FragCoord.xy), draw ^ uint(gl_PrimitiveID) << 12u, frame));
  return float(bits.x >> 8u) / 16777216.0;
}

void main() {
  Draw d = draws[draw];
  Material m = materials[d.material];
  vec4 pattern = pattern_of(d);
#ifdef HAS_PATTERNS
#ifdef EYE
  // Eye paths also draw what shows through their surfaces.
  if (pattern.a <= (is_drawn_by_paths(m) ? 0 : uniform_number())) discard;
#else
  if (pattern.a <= 0) discard;
#endif
#endif
  Vertex a = corner(d, 0u), b = corner(d, 1u), c = corner(d, 2u);
  vec3 p0 = a.position;
  vec3 facing = normalize((d.normal_to_world * vec4(cross(b.position - p0, c.position - p0), 0)).xyz);
  vec3 shading = dot(normal, normal) > 0 ? normalize(normal) : facing;
  if (dot(facing, shading) < 0) facing = -facing;
  float layer = m.layer;
  vec4 colour = m.colour, lobe = vec4(m.through.rgb, m.specular.r);
  if ((m.flags & flag_textured) != 0u) colour = textureLod(textures, vec3(uv, layer++), 0);
#ifndef NO_TEXTURED_LOBES
  if ((m.flags & flag_lobes) != 0u) lobe = textureLod(textures, vec3(uv, layer++), 0);
#endif
#ifndef NO_NORMAL_MAPS
  if ((m.flags & flag_normals) != 0u)
    shading = mapped_normal(d, a, b, c, shading, facing, textureLod(textures, vec3(uv, layer), 0).xyz);
#endif
  out_surface = uvec4(encode_octahedral(shading), encode_octahedral(facing), d.material,
                      d.first_index / 3u + uint(gl_PrimitiveID));
  out_colour = colour;
#ifdef EYE
  out_position = vec4(position, max(dot(position - eye, axis.xyz), 1e-30));
  out_lobe = lobe;
  vec3 back = axis.a > 0 ? -axis.xyz : eye - position;
  bool emits = d.emission.a > 0 || dot(facing, back) > 0;
  out_emission = vec4(emits ? d.emission.rgb * pattern.rgb : vec3(0), 1);
#else
  out_position = vec4(position, pattern.a);
#endif
}
