// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Unit vectors as two signed normalised integers of 16 bits (Cigolle et al. 2014).
uint encode_octahedral(vec3 v) {
  vec2 p = v.xy / (abs(v.x) + abs(v.y) + abs(v.z));
  if (v.z < 0) p = (1 - abs(p.yx)) * mix(vec2(-1), vec2(1), greaterThanEqual(p, vec2(0)));
  return packSnorm2x16(p);
}
vec3 decode_octahedral(uint code) {
  vec2 p = unpackSnorm2x16(code);
  vec3 v = vec3(p, 1 - abs(p.x) - abs(p.y));
  float fold = max(-v.z, 0);
  v.xy -= mix(vec2(-fold), vec2(fold), greaterThanEqual(v.xy, vec2(0)));
  return normalize(v);
}
