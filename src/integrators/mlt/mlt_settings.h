// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// User settings of Metropolis light transport, and the memory it needs. The method itself is in mlt.cpp.
#pragma once

#include <cstdint>
#include <memory>

#include "integrators/integrator.h"

namespace lanthorn {

struct MltSettings {
  bool multiplexed = true;     ///< over bidirectional path tracing, else over path tracing
  int roulette_depth;          ///< of path tracing
  float large_steps;           ///< probability of large mutations
  float sigma;                 ///< standard deviation of small ones
  std::uint64_t chain_length;  ///< mutations
  double bootstrap;            ///< independent paths for each mutation

  explicit MltSettings(const Parameters& parameters);
  MemoryUse memory_use() const;
};

std::unique_ptr<Integrator> make_metropolis_light_transport(const MltSettings& settings);

}  // namespace lanthorn
