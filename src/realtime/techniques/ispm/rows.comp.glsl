// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Sums over the rows of each view.
#include "bounce.glsl"
layout(local_size_x = 1) in;

void main() {
  int size = textureSize(l_position, 0).x;
  uvec4 maps = views[gl_WorkGroupID.x].maps;
  float sum = 0;
  for (uint row = maps.x * size; row < (maps.x + maps.y) * size; ++row) {
    sum += texel_sums[(row + 1u) * size - 1u];
    row_sums[row] = sum;
  }
}
