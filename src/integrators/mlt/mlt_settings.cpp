// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/mlt/mlt_settings.h"

#include "base/parameters.h"

namespace lanthorn {

MltSettings::MltSettings(const Parameters& parameters)
    : multiplexed(choice<bool, 2>(parameters, "over", {{{"bdpt", true}, {"path", false}}})),
      roulette_depth(static_cast<int>(parameters.number("roulette-depth", 1, 1e6))),
      large_steps(static_cast<float>(parameters.number("large-steps", 1e-3, 1))),
      sigma(static_cast<float>(parameters.number("sigma", 1e-6, 1))),
      chain_length(static_cast<std::uint64_t>(parameters.number("chain-length", 1, 1e9))),
      bootstrap(parameters.number("bootstrap", 1e-3, 1e3)) {}

MemoryUse MltSettings::memory_use() const {
  return {0, bootstrap * sizeof(double) + sizeof(RayCounts) / static_cast<double>(chain_length), 0};
}

IntegratorInfo mlt_info() {
  return {"mlt",
          "Metropolis light transport: paths mutated where they carry much light; unbiased",
          "Kelemen et al. 2002; Hachisuka et al. 2014",
          {{"over", "bdpt", "bdpt: each path by one of its techniques (multiplexed); path: paths traced from the eye"},
           {"roulette-depth", "3", "over=path: scattering event from which Russian roulette may end a path, from 1"},
           {"large-steps", "0.3", "probability in (0,1] of a large step, which draws a new path"},
           {"sigma", "0.01", "standard deviation of small steps, in primary samples from [0,1)"},
           {"chain-length", "256", "mutations of each Markov chain in a pass"},
           {"bootstrap", "0.25", "independent paths of a pass / mutations of a pass"}},
          [](const Parameters& p) { return make_metropolis_light_transport(MltSettings(p)); }};
}

}  // namespace lanthorn
