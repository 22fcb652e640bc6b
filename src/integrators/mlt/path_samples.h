// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The random numbers of the paths of Metropolis light transport, and the number of their scatterings.
#pragma once

#include <cstdint>
#include <vector>

#include "math/primary_samples.h"

namespace lanthorn {

/// The random numbers of a path's two subpaths.
struct PathSamples {
  PrimarySamples eye, light;

  explicit PathSamples(float sigma) : eye(sigma), light(sigma) {}
  void start(std::uint64_t key);
  void set_key(std::uint64_t key);
  void propose(Mutation mutation);
  void accept();
  void reject();
};

/// Distribution of the number of scatterings, at least 1, of independently drawn paths of fixed length. In most scenes,
/// most light scatters a few times only. The probabilities affect noise alone.
class PathLengths {
 public:
  PathLengths() = default;
  explicit PathLengths(int most);
  float probability(int scatterings) const { return probability_[static_cast<std::size_t>(scatterings) - 1]; }
  /// `u` in [0,1).
  int at(float u) const;

 private:
  std::vector<float> probability_, sums_;  // by scatterings less 1
};

}  // namespace lanthorn
