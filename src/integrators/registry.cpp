// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "base/suggestion.h"
#include "integrators/integrator.h"
#include "lanthorn/error.h"

namespace lanthorn {

const char* phase_name(Phase phase) {
  switch (phase) {
    case Phase::photons:
      return "photons";
    case Phase::build:
      return "build";
    case Phase::eye:
      return "eye";
  }
  return "";
}

const std::vector<IntegratorInfo>& integrator_registry() {
  static const std::vector<IntegratorInfo> registry{
      probppm_info(), sppm_info(),  ppm_info(), photonmap_info(),       vcm_info(), bpm_info(), bdpt_info(),
      path_info(),    light_info(), mlt_info(), reversephotonmap_info()};
  return registry;
}

const IntegratorInfo& find_integrator(const std::string& name) {
  std::vector<std::string> known;
  for (const IntegratorInfo& info : integrator_registry()) {
    if (info.name == name) return info;
    known.push_back(info.name);
  }
  throw Error(
      fmt::format("unknown integrator '{}'; there are {}{}", name, fmt::join(known, ", "), did_you_mean(name, known)));
}

}  // namespace lanthorn
