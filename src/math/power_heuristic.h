// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lanthorn {

/// Weight of a sample drawn with density `pdf` when one other technique, one sample each, would draw it with `other`:
/// power heuristic with exponent 2 (Veach 1997, eq. 9.13). Both densities in the same measure, not both 0. The
/// ratio comes first because squares of densities could overflow.
inline float power_heuristic(float pdf, float other) {
  const float ratio = other / pdf;
  return 1.0f / (1.0f + ratio * ratio);
}

}  // namespace lanthorn
