// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The fraction of the light of views that arrives at a point, by their maps.
#include "bsdf.glsl"
#include "light_views.glsl"
layout(binding = unit_map_position) uniform sampler2DArray l_position;  // world; a: opacity, 0: nothing
layout(binding = unit_map_surface) uniform usampler2DArray l_surface;

// Layer of a point in the light's maps, and its place there in texels; layer -1: in none.
vec3 place_in_map(int view, vec3 point) {
  uvec4 maps = views[view].maps;
  for (uint i = 0u; i < maps.y; ++i) {
    vec4 clip = views[view].clip[i] * vec4(point, 1);
    if (clip.w <= 0 || abs(clip.x) > clip.w || abs(clip.y) > clip.w) continue;
    return vec3((clip.xy / clip.w * 0.5 + 0.5) * vec2(textureSize(l_position, 0).xy), float(maps.x + i));
  }
  return vec3(-1);
}

const uint no_triangle = ~0u;

// A surface in the map shadows the point if its tangent plane lies between the point and the light, by more than
// `slack` metres; unless both may be points of one convex surface, however large the texels: each then lies behind the
// tangent plane of the other, about as far. The point's own triangle does not count. Light that the surface lets pass
// arrives.
float share_past(ivec3 texel, vec3 point, vec3 facing, uint triangle, vec3 towards, float slack) {
  vec4 seen = texelFetch(l_position, texel, 0);
  if (seen.a == 0) return 1;
  uvec4 surface = texelFetch(l_surface, texel, 0);
  if (surface.w == triangle) return 1;
  vec3 seen_facing = decode_octahedral(surface.y);
  vec3 between = seen.xyz - point;
  float incidence = dot(towards, seen_facing);
  float behind_seen = dot(between, seen_facing) * sign(incidence), way = behind_seen / abs(incidence);
  if (abs(incidence) < 0.02) way = dot(between, towards);
  if (way < slack) return 1;
  float below_point = -dot(between, facing) * sign(dot(towards, facing));
  return below_point > max(0, 0.25 * behind_seen - slack) ? 1 : 1 - seen.a;
}

uniform int soft_edges;  // 1: between nine texels

// Quadratic B-spline weights of the texels before, at and after the nearest one, at `f` from its middle.
vec3 spline_weights(float f) { return vec3(0.5 * (0.5 - f) * (0.5 - f), 0.75 - f * f, 0.5 * (0.5 + f) * (0.5 + f)); }

// `least_slack`: m; a thousandth of the map's width at the point is allowed in any case.
float share_lit(int view, vec3 point, vec3 facing, uint triangle, vec3 towards, float least_slack) {
  vec3 place = place_in_map(view, point);
  if (place.z < 0) return 1;
  int layer = int(place.z);
  float width = length(views[view].right[uint(layer) - views[view].maps.x].xyz);
  if (views[view].origin.a != view_parallel) width *= length(views[view].origin.xyz - point);
  float slack = max(least_slack, 0.001 * width);
  float at_middle = share_past(ivec3(place), point, facing, triangle, towards, slack);
  if (soft_edges == 0) return at_middle;
  // Edges that run obliquely across the texels then become straight: the mean of four texels would still be wavy. Where
  // the middle and the corners agree, there is no edge.
  vec2 middle = floor(place.xy), f = place.xy - middle - 0.5;
  vec3 across = spline_weights(f.x), down = spline_weights(f.y);
  ivec2 last = textureSize(l_position, 0).xy - 1;
  float share = across[1] * down[1] * at_middle;
  bool is_even = true;
  for (int pass = 0; pass < 2; ++pass) {  // corners, then sides
    if (pass == 1 && is_even) return at_middle;
    for (int i = 0; i < 4; ++i) {
      ivec2 step = pass == 0 ? ivec2(i & 1, i >> 1) * 2 : ivec2(i < 2 ? 2 * i : 1, i < 2 ? 1 : 2 * i - 4);
      ivec3 texel = ivec3(clamp(ivec2(middle) + step - 1, ivec2(0), last), layer);
      float there = share_past(texel, point, facing, triangle, towards, slack);
      is_even = is_even && there == at_middle;
      share += across[step.x] * down[step.y] * there;
    }
  }
  return share;
}
