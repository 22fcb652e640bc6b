// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Closures of the GPU (realtime/scene/materials.h): eval without cosine, 1/sr. Directions point away from the surface. Kinds
// that no material of the scene has are left out (NO_METAL, NO_PLASTIC): software drivers execute all branches.
#include "constants.glsl"
#include "layouts.glsl"
#include "octahedral.glsl"

layout(std430, binding = storage_materials) readonly buffer Materials { Material materials[]; };
layout(binding = unit_surfaces) uniform sampler2DArray textures;
layout(binding = unit_plastic_albedo) uniform sampler2D plastic_albedo;

// Eye paths of the CPU draw materials whose flags, masked by the first, equal the second (realtime/scene/gpu_scene.h).
uniform uint eye_paths_looked_at, eye_paths_wanted;
bool is_drawn_by_paths(Material m) { return (m.flags & eye_paths_looked_at) == eye_paths_wanted; }

// A point of the G-buffer.
struct Surface {
  vec3 position;
  vec3 normal;   // shading
  vec3 facing;   // geometric
  vec4 colour;   // as Material::colour, textured
  vec4 lobe;     // as Material::through, textured; a: f90
  Material material;
  uint triangle;
};

// Heitz 2014, eq. 85, for one width.
float ggx_d(float cos_m, float alpha) {
  float a2 = alpha * alpha, e = (1 - cos_m * cos_m) / a2 + cos_m * cos_m;
  return 1 / (pi * a2 * e * e);
}
float stretched(float cos_w, float alpha) { return sqrt(alpha * alpha * (1 - cos_w * cos_w) + cos_w * cos_w); }
// Height-correlated Smith term over both cosines (Heitz 2014, eq. 99).
float ggx_g_over_cosines(float cos_i, float cos_o, float alpha) {
  return 2 / (cos_o * stretched(cos_i, alpha) + cos_i * stretched(cos_o, alpha));
}
// Fresnel's equations of a conductor eta + i k (Born & Wolf, section 14.2).
vec3 fresnel_conductor(float cos_i, vec3 eta, vec3 k) {
  float cos2 = cos_i * cos_i, sin2 = max(0, 1 - cos2);
  vec3 n2 = eta * eta, k2 = k * k, difference = n2 - k2 - sin2;
  vec3 sum = sqrt(difference * difference + 4 * n2 * k2);
  vec3 a = sqrt(0.5 * max(vec3(0), sum + difference));
  vec3 s = sum + cos2, s_cross = 2 * a * cos_i;
  vec3 perpendicular = (s - s_cross) / (s + s_cross);
  vec3 p = cos2 * sum + sin2 * sin2, p_cross = s_cross * sin2;
  return 0.5 * (perpendicular + perpendicular * (p - p_cross) / (p + p_cross));
}
float schlick(float cos_i) {
  float x = 1 - cos_i;
  return x * x * x * x * x;
}

// Albedo of the plastic's reflection at a cosine: the table is linear between its nodes.
vec2 albedo_terms(float column, float alpha) {
  float row = alpha * (plastic_widths - 1);
  int low = min(int(row), plastic_widths - 2);
  int first = min(int(column), plastic_cosines - 1);
  float x = column - first, y = row - low;
  vec2 below = mix(texelFetch(plastic_albedo, ivec2(first, low), 0).xy,
                   texelFetch(plastic_albedo, ivec2(first + 1, low), 0).xy, x);
  vec2 above = mix(texelFetch(plastic_albedo, ivec2(first, low + 1), 0).xy,
                   texelFetch(plastic_albedo, ivec2(first + 1, low + 1), 0).xy, x);
  return mix(below, above, y);
}
vec2 mean_albedo_terms(float alpha) {
  float row = alpha * (plastic_widths - 1);
  int low = min(int(row), plastic_widths - 2);
  const int column = plastic_cosines + 1;
  return mix(texelFetch(plastic_albedo, ivec2(column, low), 0).xy,
             texelFetch(plastic_albedo, ivec2(column, low + 1), 0).xy, row - low);
}

vec3 eval_microfacets(vec3 fresnel, float cos_m, float cos_i, float cos_o, float alpha) {
  return fresnel * (0.25 * ggx_d(cos_m, alpha) * ggx_g_over_cosines(cos_i, cos_o, alpha));
}

// Kelemen & Szirmay-Kalos 2001, eq. 5: as surface/plastic.cpp.
vec3 eval_plastic(Material m, vec4 colour, vec4 lobe, float cos_i, float cos_o, float cos_m, float cos_d) {
  vec3 f0 = lobe.rgb;
  float f90 = lobe.a;
  vec2 ti = albedo_terms(cos_i * plastic_cosines, colour.a),
       to = albedo_terms(cos_o * plastic_cosines, colour.a);
  vec2 tm = mean_albedo_terms(colour.a);
  vec3 rest = max(vec3(1e-6), 1 - (f0 * tm.x + f90 * tm.y));
  vec3 below = colour.rgb / pi * (1 - (f0 * ti.x + f90 * ti.y)) * (1 - (f0 * to.x + f90 * to.y)) / rest;
  if ((m.flags & flag_smooth) != 0u) return below;
  vec3 fresnel = f0 + (f90 - f0) * schlick(cos_d);
  return below + eval_microfacets(fresnel, cos_m, cos_i, cos_o, colour.a);
}

// Nothing passes an opaque facet (surface/bent.h).
bool is_blocked(Surface at, vec3 wi, vec3 wo) {
  bool is_opaque = at.material.kind != kind_diffuse || at.lobe.rgb == vec3(0);
  return is_opaque && dot(wi, at.facing) * dot(wo, at.facing) <= 0;
}

// f(wi, wo), 1/sr, without the cosine and without delta lobes.
vec3 eval_bsdf(Surface at, vec3 wi, vec3 wo) {
  Material m = at.material;
  if (is_blocked(at, wi, wo)) return vec3(0);
  float cos_i = dot(wi, at.normal), cos_o = dot(wo, at.normal);
  if (m.kind == kind_diffuse) return (cos_i * cos_o > 0 ? at.colour.rgb : at.lobe.rgb) / pi;
  if (cos_i * cos_o <= 0 || m.kind == kind_none) return vec3(0);
#if !defined(NO_METAL) || !defined(NO_PLASTIC)
  vec3 half_way = normalize(wi + wo);
  float cos_m = abs(dot(half_way, at.normal)), cos_d = abs(dot(wi, half_way));
  cos_i = abs(cos_i);
  cos_o = abs(cos_o);
#endif
#ifndef NO_PLASTIC
  if (m.kind == kind_plastic) return eval_plastic(m, at.colour, at.lobe, cos_i, cos_o, cos_m, cos_d);
#endif
#ifndef NO_METAL
  if (m.kind == kind_metal && (m.flags & flag_smooth) == 0u)
    return eval_microfacets(fresnel_conductor(cos_d, m.through.rgb, m.specular.rgb), cos_m, cos_i, cos_o, at.colour.a);
#endif
  return vec3(0);
}

// Share of the light along the normal that is scattered: the importance of a photon there. Unknown for materials that
// the CPU draws, such as hair.
vec3 rough_albedo(Surface at, float cos_i) {
  Material m = at.material;
  if (m.kind == kind_none || (m.flags & flag_traced) != 0u) return vec3(1);
  if (m.kind == kind_diffuse) return at.colour.rgb + m.through.rgb;
#ifndef NO_METAL
  if (m.kind == kind_metal) return fresnel_conductor(cos_i, m.through.rgb, m.specular.rgb);
#endif
  return at.colour.rgb + m.through.rgb;
}
