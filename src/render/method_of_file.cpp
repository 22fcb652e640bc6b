// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/method_of_file.h"

#include <map>

#include "integrators/integrator.h"

namespace lanthorn {

std::string integrator_of_file(const std::string& name) {
  if (name == "lightpath") return "light";
  for (const char* known : {"path", "volpath", "simplepath", "simplevolpath", "randomwalk", "ambientocclusion"})
    if (name == known) return "path";
  for (const IntegratorInfo& info : integrator_registry())
    if (name == info.name) return name;
  return "";
}

std::optional<KnownMethod> method_of_file(const std::string& name) {
  const std::string ours = integrator_of_file(name);
  if (ours.empty()) return std::nullopt;
  const IntegratorInfo& info = find_integrator(ours);
  return KnownMethod{info.parameters, [&info](const std::map<std::string, std::string>& set) {
                       static_cast<void>(info.make({info.parameters, set, info.name}));
                     }};
}

}  // namespace lanthorn
