// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A light view in a buffer, after scene/layouts.glsl. This text is valid in C++ and in shaders.
struct LightView {
  vec4 origin;  // world; a: view_point ...
  vec4 axis;    // of a spot or a surface; parallel light: towards it; a: 1 if both sides emit
  vec4 colour;  // W/sr, of surfaces at normal incidence; parallel light: W/m²
  vec4 cone;    // 1 - cos of the angles where a spot's light begins to fall and ends; 1: square falloff; 1: all around
  uvec4 maps;   // first layer, number of layers, first photon, number of photons
  mat4 clip[most_windows];
  // Directions of the layers' windows, or points of parallel light. If parallel light has two windows, the first covers
  // some texels of the second.
  vec4 corner[most_windows];
  vec4 right[most_windows];
  vec4 down[most_windows];
};
