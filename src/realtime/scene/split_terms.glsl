// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A closure as split-sum shading represents it (surface/closure.h).
#include "bsdf.glsl"
struct SplitTerms {
  vec3 diffuse;         // reflectance for light from the viewer's side
  vec3 diffuse_behind;  // transmittance for light from the other side
  vec3 f0, f90;         // Fresnel term of the lobe at normal incidence and at grazing angles
  float alpha;          // its GGX width
};

// The shading normal on the viewer's side.
vec3 facing_normal(Surface at, vec3 wi) { return dot(wi, at.normal) >= 0 ? at.normal : -at.normal; }

SplitTerms split_terms(Surface at, float cos_i) {
  Material m = at.material;
  if (m.kind == kind_diffuse) return SplitTerms(at.colour.rgb, at.lobe.rgb, vec3(0), vec3(0), 1);
  if (m.kind == kind_metal) {
    vec3 f0 = fresnel_conductor(1, m.through.rgb, m.specular.rgb);
    return SplitTerms(vec3(0), vec3(0), f0, vec3(greaterThan(f0, vec3(0))), at.colour.a);
  }
  vec3 f0 = at.lobe.rgb;
  float f90 = at.lobe.a;
  if (m.kind == kind_none) return SplitTerms(vec3(0), vec3(0), f0, vec3(f90), at.colour.a);
  vec2 terms = albedo_terms(cos_i * plastic_cosines, at.colour.a);
  return SplitTerms(at.colour.rgb * (1 - (f0 * terms.x + f90 * terms.y)), vec3(0), f0, vec3(f90), at.colour.a);
}
