// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The sum of the layers for a screen.
#include "constants.glsl"
layout(binding = unit_layer_emission) uniform sampler2D layer_emission;
layout(binding = unit_layer_direct) uniform sampler2D layer_direct;
layout(binding = unit_layer_indirect) uniform sampler2D layer_indirect;
layout(binding = unit_layer_caustic) uniform sampler2D layer_caustic;
uniform vec4 shown;     // factors of the four layers
uniform float exposure;
uniform int curve;      // ToneSettings::Curve; Reinhard's is x/(1+x)
uniform float highlight_strength;  // of film/display.h's HighlightCurve
uniform int height;     // of the picture; > 0: the first row is drawn at the upper edge
layout(location = 0) out vec4 colour;

vec3 encode_srgb(vec3 x) {
  return mix(12.92 * x, 1.055 * pow(max(x, vec3(0.0031308)), vec3(1 / 2.4)) - 0.055, greaterThan(x, vec3(0.0031308)));
}
// Narkowicz 2015, "ACES filmic tone mapping curve".
vec3 filmic(vec3 x) { return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14); }

// As in film/display.h; the knee is where it is there.
vec3 highlights(vec3 x) {
  const float knee = 0.7;
  vec3 bright = knee + log(1 + highlight_strength * max(x - knee, vec3(0))) / max(highlight_strength, 1e-6);
  return highlight_strength > 0 ? mix(x, bright, greaterThan(x, vec3(knee))) : x;
}

// AgX, as in film/display.h, to display values.
vec3 agx_sigmoid(vec3 x) {
  const float pivot = 10 / 16.5;
  vec3 toe = vec3(lessThan(x, vec3(pivot)));
  vec3 power = mix(vec3(3.25), vec3(3), toe), end = 2 * mix(vec3(1 - pivot), vec3(pivot), toe);
  vec3 size = pow((pow(2 * end, power) - 1) * pow(end, -power), -1 / power);
  vec3 t = 2 * abs(x - pivot) / size;
  vec3 y = size * t / pow(1 + pow(t, power), 1 / power);
  return 0.5 + mix(y, -y, toe);
}
vec3 agx(vec3 x) {
  const vec3 white = 0.2 * vec3(0.2120, 0.3921, 0.3959);
  x = log2(max(0.8 * x + dot(white, x), vec3(1e-9)) / 0.18);
  x = agx_sigmoid(clamp((x + 10) / 16.5, vec3(0), vec3(1)));
  return clamp((x - dot(white, x)) / 0.8, vec3(0), vec3(1));
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (height > 0) pixel.y = height - 1 - pixel.y;
  vec3 x = exposure * (shown.x * texelFetch(layer_emission, pixel, 0).rgb + shown.y * texelFetch(layer_direct, pixel, 0).rgb +
                       shown.z * texelFetch(layer_indirect, pixel, 0).rgb + shown.w * texelFetch(layer_caustic, pixel, 0).rgb);
  x = max(x, vec3(0));
  if (curve == curve_reinhard) x = x / (1 + x);
  if (curve == curve_filmic) x = filmic(x);
  if (curve == curve_highlights) x = highlights(x);
  colour = curve == curve_agx ? vec4(agx(x), 1) : vec4(encode_srgb(clamp(x, vec3(0), vec3(1))), 1);
}
