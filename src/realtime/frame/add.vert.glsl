// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Light that the CPU has found, pixel by pixel, to be blended into the GPU's layers (realtime/frame/specular_light.h).
// Four texels for each pixel: emission, direct, indirect, caustic; a of the first two: the pixel.
#include "constants.glsl"
layout(binding = unit_eye_paths) uniform samplerBuffer pixels;
uniform vec2 size;  // of the picture, pixels
flat out vec4 emission, direct, indirect, caustic;

void main() {
  int i = 4 * gl_VertexID;
  emission = texelFetch(pixels, i);
  direct = texelFetch(pixels, i + 1);
  indirect = texelFetch(pixels, i + 2);
  caustic = texelFetch(pixels, i + 3);
  gl_Position = vec4(2 * (vec2(emission.a, direct.a) + 0.5) / size - 1, 0, 1);
}
