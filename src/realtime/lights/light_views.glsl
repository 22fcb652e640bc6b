// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The views of lights of a frame (realtime/lights/light_views.h), and their maps.
#include "constants.glsl"
#include "layouts.glsl"
#include "light_layout.glsl"
layout(std430, binding = storage_light_views) readonly buffer LightViews { LightView views[]; };

// Intensity in a direction away from the light over that on its axis.
float falloff(LightView v, vec3 d) {
  if (v.origin.a == view_area) {
    float c = dot(d, v.axis.xyz);
    return v.axis.a > 0 ? abs(c) : max(c, 0);
  }
  vec3 way = d - v.axis.xyz;
  float h = 0.5 * dot(way, way);
  if (h >= v.cone.y) return 0;
  if (h <= v.cone.x) return 1;
  float x = (v.cone.y - h) / (v.cone.y - v.cone.x);
  return v.cone.z > 0 ? x * x : x * x * (3 - 2 * x);
}
