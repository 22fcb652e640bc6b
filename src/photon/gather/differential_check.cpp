// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/gather/differential_check.h"

#include <cmath>

namespace lanthorn {

std::size_t settled_count(std::span<const Neighbour> nearest, std::span<const Spectrum> light, float threshold) {
  // Light per area of the disc up to each photon, without that photon.
  float sum = 0, previous = 0;
  struct Run {
    std::size_t begin = 0;
    float from = 0;
    bool grows = false;
  } run;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const float estimate = nearest[i].dist2 > 0 ? sum / nearest[i].dist2 : 0.0f;
    sum += sum_of(light[nearest[i].slot]);
    const bool grows = estimate > previous;
    if (i < least_checked)
      run = {i, estimate, grows};
    else if (grows != run.grows)
      run = {i - 1, previous, grows};
    if (std::fabs(estimate - run.from) > threshold * run.from && run.from > 0) return run.begin + 1;
    previous = estimate;
  }
  return nearest.size();
}

}  // namespace lanthorn
