// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Direct light by the lights' views, shadowed by their maps or by traced rays.
#include "shade.glsl"
#include "shadow_maps.glsl"
uniform int view_count;
uniform float least_sky_alpha;  // GGX width of lobes in which light all around is shown here
uniform int shadows;  // ShadowKind
layout(binding = unit_visibility) uniform usampler2D visibility;  // bit i: light view i is visible

vec3 shade(ivec2 pixel, Surface at, vec3 wi) {
  if (is_drawn_by_paths(at.material)) return vec3(0);
  vec3 sum = vec3(0);
  uint seen = shadows == shadows_traced ? texelFetch(visibility, pixel, 0).x : ~0u;
  for (int i = 0; i < view_count; ++i) {
    if ((seen >> i & 1u) == 0u) continue;
    LightView v = views[i];
    vec3 way = v.origin.xyz - at.position;
    float distance_to_light = length(way);
    vec3 wo = v.origin.a == view_parallel ? v.axis.xyz : way / distance_to_light;
    vec3 light = v.colour.rgb;
    if (v.origin.a != view_parallel) light *= falloff(v, -wo) / (distance_to_light * distance_to_light);
    if (light == vec3(0)) continue;
    Surface shown = at;
    if (v.cone.w > 0 && at.colour.a < least_sky_alpha) shown.material.flags |= flag_smooth;
    vec3 f = eval_bsdf(shown, wi, wo);
    if (f == vec3(0)) continue;
    if (shadows == shadows_mapped) light *= share_lit(i, at.position, at.facing, at.triangle, wo, 0);
    sum += f * abs(dot(wo, at.normal)) * light;
  }
  return sum;
}
