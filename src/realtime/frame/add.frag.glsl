// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
flat in vec4 emission, direct, indirect, caustic;
layout(location = 0) out vec4 out_emission;
layout(location = 1) out vec4 out_direct;
layout(location = 2) out vec4 out_indirect;
layout(location = 3) out vec4 out_caustic;

void main() {
  out_emission = vec4(emission.rgb, 0);
  out_direct = vec4(direct.rgb, 0);
  out_indirect = vec4(indirect.rgb, 0);
  out_caustic = vec4(caustic.rgb, 0);
}
