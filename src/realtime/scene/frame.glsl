// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Duff et al. 2017: a basis around n, as math/frame.h has it.
mat3 frame_around(vec3 n) {
  float s = n.z >= 0 ? 1.0 : -1.0, a = -1 / (s + n.z), b = n.x * n.y * a;
  return mat3(vec3(1 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}
