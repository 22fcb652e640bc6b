// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The bounce maps of the lights, and the distribution of photons over their texels (realtime/techniques/ispm/photon_walk.h).
#include "bsdf.glsl"
#include "light_views.glsl"
#include "ispm_constants.glsl"
layout(binding = unit_map_position) uniform sampler2DArray l_position;  // world; a: opacity, 0: nothing
layout(binding = unit_map_surface) uniform usampler2DArray l_surface;
layout(binding = unit_map_colour) uniform sampler2DArray l_colour;
// Sums of the importances along each row up to and with a texel; rows of all layers, one after the other.
layout(std430, binding = storage_texel_sums) buffer TexelSums { float texel_sums[]; };
// Sums over the rows of each view up to and with a row.
layout(std430, binding = storage_row_sums) buffer RowSums { float row_sums[]; };

const vec3 luminance_weights = vec3(0.2126, 0.7152, 0.0722);

// Data that all texels of a view's window share, so that loops over texels read them once.
struct Window {
  vec3 corner, right, down;
  ivec4 finer;  // texels that another window covers: x and y of the first, and of the first beyond them
  float boost;  // of importance: windows that cover a part of the light have as many photons as the rest
};

// `size`: texels along a side.
Window window_of(int view, uint i, int size) {
  Window w = Window(views[view].corner[i].xyz, views[view].right[i].xyz, views[view].down[i].xyz, ivec4(0), 1);
  if (views[view].origin.a != view_parallel || views[view].maps.y != 2u) return w;
  float share = length(views[view].right[0].xyz) / length(views[view].right[1].xyz);
  if (i == 0u) {
    w.boost = 1 / (share * share);
    return w;
  }
  vec3 way = views[view].corner[0].xyz - w.corner;
  vec2 first = vec2(dot(way, w.right) / dot(w.right, w.right), dot(way, w.down) / dot(w.down, w.down));
  w.finer = ivec4(round(size * vec4(first, first + share)));
  return w;
}
vec3 middle_of(Window w, ivec2 texel, int size) {
  vec2 place = (vec2(texel) + 0.5) / size;
  return w.corner + place.x * w.right + place.y * w.down;
}

// Direction of the light through a texel's middle, away from it.
vec3 direction_of(LightView v, Window w, ivec2 texel, int size) {
  return v.origin.a == view_parallel ? -v.axis.xyz : normalize(middle_of(w, texel, size));
}

// Watts that leave the light through a texel. Of a window at distance 1 along its axis, an area dA is seen under the
// solid angle dA / |q|^3 at its point q.
vec3 flux_of(LightView v, Window w, ivec2 texel, int size) {
  if (all(greaterThanEqual(texel, w.finer.xy)) && all(lessThan(texel, w.finer.zw))) return vec3(0);
  float texel_area = length(cross(w.right, w.down)) / float(size * size);
  if (v.origin.a == view_parallel) return v.colour.rgb * texel_area;
  vec3 q = middle_of(w, texel, size);
  float d = length(q);
  return v.colour.rgb * (falloff(v, q / d) * texel_area / (d * d * d));
}

Surface surface_in(ivec3 texel) {
  uvec4 s = texelFetch(l_surface, texel, 0);
  Material m = materials[s.z];
  return Surface(texelFetch(l_position, texel, 0).xyz, decode_octahedral(s.x), decode_octahedral(s.y),
                 texelFetch(l_colour, texel, 0), vec4(m.through.rgb, m.specular.r), m, s.w);
}
