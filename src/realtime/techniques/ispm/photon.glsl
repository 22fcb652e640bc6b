// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photons on surfaces and their volumes: flat cylinders about the normals (McGuire & Luebke 2009, section 3.4, have ellipsoids
// compressed along the normals).
#include "constants.glsl"
#include "layouts.glsl"
#include "ispm_constants.glsl"
struct Photon {
  vec3 position;  // world
  vec3 normal;    // of its surface
  vec3 power;     // W, with the gain of grazing incidence (photon/incidence.h)
  vec3 wi;        // to the previous vertex of its path
};
// Two texels for each photon: position and normal, power and wi (realtime/techniques/ispm/photon_walk.h). Software drivers fetch texels
// faster than they read storage buffers.
layout(binding = unit_photons) uniform usamplerBuffer photons;
uniform float radius;       // m
uniform float half_height;  // of a volume, m

Photon fetch_photon(int i) {
  uvec4 place = texelFetch(photons, 2 * i), light = texelFetch(photons, 2 * i + 1);
  return Photon(uintBitsToFloat(place.xyz), decode_octahedral(place.w), uintBitsToFloat(light.xyz),
                decode_octahedral(light.w));
}

// Radiance towards the eye (in direction `wi`) of one photon: K f power |cos_s| / |cos_g|, as photon/gather/photon_hit.h has it,
// with Epanechnikov's kernel in the photon's tangent plane.
vec3 photon_light(Surface at, vec3 wi, Photon p) {
  vec3 offset = at.position - p.position;
  float height = dot(offset, p.normal);
  float flat2 = dot(offset, offset) - height * height;
  if (flat2 >= radius * radius || abs(height) > half_height) return vec3(0);
  vec3 f = eval_bsdf(at, wi, p.wi);
  float ratio = abs(dot(p.wi, at.normal)) / max(abs(dot(p.wi, at.facing)), 0.1);
  float kernel = 2 / (pi * radius * radius) * (1 - flat2 / (radius * radius));
  return f * p.power * (ratio * kernel);
}
