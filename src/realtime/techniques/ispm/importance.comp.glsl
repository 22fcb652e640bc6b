// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Running sums of the importances of a row's texels: the light that the surface there scatters.
#include "bounce.glsl"
layout(local_size_x = work_group) in;
uniform int view_count;
uniform int row_count;

float importance(LightView v, Window window, ivec3 texel, int size) {
  if (texelFetch(l_position, texel, 0).a == 0) return 0;
  Surface at = surface_in(texel);
  vec3 flux = flux_of(v, window, texel.xy, size);
  float cos_i = abs(dot(direction_of(v, window, texel.xy, size), at.normal));
  return window.boost * dot(luminance_weights, flux * rough_albedo(at, cos_i));
}

void main() {
  int row = int(gl_GlobalInvocationID.x);
  if (row >= row_count) return;
  int size = textureSize(l_position, 0).x;
  uint layer = uint(row / size);
  for (int i = 0; i < view_count; ++i) {
    uvec4 maps = views[i].maps;
    if (layer < maps.x || layer >= maps.x + maps.y) continue;
    LightView v = views[i];
    Window window = window_of(i, layer - maps.x, size);
    float sum = 0;
    for (int x = 0; x < size; ++x) {
      sum += importance(v, window, ivec3(x, row % size, layer), size);
      texel_sums[row * size + x] = sum;
    }
  }
}
