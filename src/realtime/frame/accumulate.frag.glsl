// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The layers of a frame, times a factor. Blending adds them to the mean of the frames before.
#include "constants.glsl"
layout(binding = unit_layer_emission) uniform sampler2D layer_emission;
layout(binding = unit_layer_direct) uniform sampler2D layer_direct;
layout(binding = unit_layer_indirect) uniform sampler2D layer_indirect;
layout(binding = unit_layer_caustic) uniform sampler2D layer_caustic;
uniform float factor;  // pixel value over radiance
uniform float share;   // of the frame in the mean
layout(location = 0) out vec4 emission;
layout(location = 1) out vec4 direct;
layout(location = 2) out vec4 indirect;
layout(location = 3) out vec4 caustic;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  emission = vec4(factor * texelFetch(layer_emission, pixel, 0).rgb, share);
  direct = vec4(factor * texelFetch(layer_direct, pixel, 0).rgb, share);
  indirect = vec4(factor * texelFetch(layer_indirect, pixel, 0).rgb, share);
  caustic = vec4(factor * texelFetch(layer_caustic, pixel, 0).rgb, share);
}
