// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/mlt/mlt_paths.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "math/hash.h"

namespace lanthorn {

void PathSamples::start(std::uint64_t key) {
  eye.start(hash_words({key, 0}));
  light.start(hash_words({key, 1}));
}
void PathSamples::set_key(std::uint64_t key) {
  eye.set_key(hash_words({key, 0}));
  light.set_key(hash_words({key, 1}));
}
void PathSamples::propose(Mutation mutation) {
  eye.propose(mutation);
  light.propose(mutation);
}
void PathSamples::accept() {
  eye.accept();
  light.accept();
}
void PathSamples::reject() {
  eye.reject();
  light.reject();
}

PathLengths::PathLengths(int most) : sums_(static_cast<std::size_t>(most)) {
  for (int k = 1; k <= most; ++k) probability_.push_back(std::pow(static_cast<float>(k), -1.5f));
  const float sum = std::accumulate(probability_.begin(), probability_.end(), 0.0f);
  for (float& p : probability_) p /= sum;
  std::partial_sum(probability_.begin(), probability_.end(), sums_.begin());
}

int PathLengths::at(float u) const {
  const auto found = std::upper_bound(sums_.begin(), sums_.end() - 1, u);
  return 1 + static_cast<int>(found - sums_.begin());
}

}  // namespace lanthorn
