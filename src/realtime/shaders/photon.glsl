// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photons on surfaces and their volumes: ellipsoids compressed along the normal (McGuire & Luebke 2009, section 3.4).
struct Photon {
  vec4 position;  // world; w: scattering events of its path, the one here included
  vec4 power;     // W, with the gain of grazing incidence (photon/incidence.h)
  vec4 towards;   // unit, to the previous vertex of its path
  vec4 normal;    // of its surface
};
layout(std430, binding = 8) readonly buffer Photons { Photon photons[]; };
uniform float radius;     // m
uniform float half_height;  // of a volume, m

// Radiance towards the eye (in direction `wi`) of one photon: K f power |cos_s| / |cos_g|, as photon/photon_hit.h has it,
// with Epanechnikov's kernel in the photon's tangent plane.
vec3 photon_light(Surface at, vec3 wi, Photon p) {
  vec3 offset = at.position - p.position.xyz;
  float height = dot(offset, p.normal.xyz);
  float flat2 = dot(offset, offset) - height * height;
  if (flat2 >= radius * radius || abs(height) > half_height) return vec3(0);
  vec3 f = eval_bsdf(at, wi, p.towards.xyz);
  float ratio = abs(dot(p.towards.xyz, at.normal)) / max(abs(dot(p.towards.xyz, at.facing)), 0.1);
  float kernel = 2 / (pi * radius * radius) * (1 - flat2 / (radius * radius));
  return f * p.power.rgb * (ratio * kernel);
}
