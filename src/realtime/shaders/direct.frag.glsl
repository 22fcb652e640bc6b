// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Light straight from the lights' views, shadowed by their maps or by traced rays.
#include "gbuffer.glsl"
#include "light_views.glsl"
uniform int view_count;
uniform int shadows;  // 0: none, 1: maps, 2: traced
uniform vec3 eye;
uniform vec4 axis;
layout(binding = 7) uniform sampler2DArray l_position;
layout(binding = 8) uniform usampler2DArray l_surface;
layout(binding = 9) uniform usampler2D visibility;  // bit i: light view i is visible
layout(location = 0) out vec4 radiance;

// Layer of a point in the light's maps, and its place there in texels; layer -1: in none.
vec3 place_in_map(LightView v, vec3 point) {
  for (uint i = 0u; i < v.maps.y; ++i) {
    vec4 clip = v.clip[i] * vec4(point, 1);
    if (clip.w <= 0 || abs(clip.x) > clip.w || abs(clip.y) > clip.w) continue;
    return vec3((clip.xy / clip.w * 0.5 + 0.5) * vec2(textureSize(l_position, 0).xy), float(v.maps.x + i));
  }
  return vec3(-1);
}

// Compares depths in the tangent plane of the surface in the map, so that no surface shadows itself.
bool is_lit(LightView v, Surface at, vec3 towards, float distance_to_light) {
  vec3 place = place_in_map(v, at.position);
  if (place.z < 0) return true;
  ivec3 texel = ivec3(place);
  vec4 seen = texelFetch(l_position, texel, 0);
  if (seen.a == 0) return true;
  uvec4 surface = texelFetch(l_surface, texel, 0);
  if (surface.w == at.triangle) return true;
  vec3 facing = decode_octahedral(surface.y);
  float incidence = dot(towards, facing);
  vec3 between = at.position - seen.xyz;
  float behind = abs(incidence) > 0.02 ? -dot(between, facing) / incidence : -dot(between, towards);
  return behind < 0.002 * (v.origin.a == 2 ? 1 : distance_to_light);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  radiance = vec4(0, 0, 0, 1);
  if (is_background(pixel)) return;
  Surface at = surface_at(pixel);
  vec3 wi = axis.a > 0 ? -axis.xyz : normalize(eye - at.position);
  uint seen = shadows == 2 ? texelFetch(visibility, pixel, 0).x : ~0u;
  for (int i = 0; i < view_count; ++i) {
    if ((seen >> i & 1u) == 0u) continue;
    LightView v = views[i];
    vec3 way = v.origin.xyz - at.position;
    float distance_to_light = length(way);
    vec3 wo = v.origin.a == 2 ? v.axis.xyz : way / distance_to_light;
    vec3 light = v.colour.rgb;
    if (v.origin.a != 2) light *= falloff(v, -wo) / (distance_to_light * distance_to_light);
    if (light == vec3(0)) continue;
    vec3 f = eval_bsdf(at, wi, wo);
    if (f == vec3(0)) continue;
    if (shadows == 1 && !is_lit(v, at, wo, distance_to_light)) continue;
    radiance.rgb += f * abs(dot(wo, at.normal)) * light;
  }
}
