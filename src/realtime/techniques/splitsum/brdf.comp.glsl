// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reflection of a white environment by GGX with Schlick's Fresnel term, as ibl/split_sum.cpp: scale of F0 and bias.
#include "constants.glsl"
#include "layouts.glsl"
#include "splitsum_constants.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = storage_samples) readonly buffer Samples { vec2 samples[]; };  // cosine of the azimuth, height in the cap
layout(binding = image_of_technique, rg32f) uniform writeonly image2D table;
uniform int sample_count;

void main() {
  ivec2 size = imageSize(table), own = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(own, size))) return;
  vec2 place = (vec2(own) + 0.5) / vec2(size);
  float c = place.x, s = sqrt(1 - c * c), alpha = place.y * place.y, alpha2 = alpha * alpha;
  float length_v = sqrt(alpha2 * s * s + c * c);
  vec2 v = vec2(alpha * s, c) / length_v;
  vec2 sum = vec2(0);
  for (int i = 0; i < sample_count; ++i) {
    float cos_phi = samples[i].x, z = samples[i].y * (1 + v.y) - v.y, across2 = 1 - z * z;
    float across = sqrt(max(across2, 0));
    float hx = alpha * (across * cos_phi + v.x), hz = z + v.y, hy2 = alpha2 * across2 * (1 - cos_phi * cos_phi);
    float per_length = 1 / sqrt(hx * hx + hy2 + hz * hz);
    float v_h = (s * hx + c * hz) * per_length;
    float l = max(2 * v_h * hz * per_length - c, 0), length_l = sqrt(alpha2 * (1 - l * l) + l * l);
    float weight = l * (c + length_v) / (l * length_v + c * length_l);
    float grazing = 1 - v_h, grazing2 = grazing * grazing, schlick = grazing2 * grazing2 * grazing;
    sum += weight * vec2(1 - schlick, schlick);
  }
  imageStore(table, own, vec4(sum / sample_count, 0, 0));
}
