// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/method_of_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "integrators/integrator.h"

namespace lanthorn {

namespace {

// An integrator of pbrt-v4, and the method of Lanthorn that does the same.
struct Counterpart {
  const char *of_pbrt, *ours;
};
constexpr std::array<Counterpart, 10> counterparts{{{"ambientocclusion", "path"},
                                                    {"bdpt", "bdpt"},
                                                    {"lightpath", "light"},
                                                    {"mlt", "mlt"},
                                                    {"path", "path"},
                                                    {"randomwalk", "path"},
                                                    {"simplepath", "path"},
                                                    {"simplevolpath", "path"},
                                                    {"sppm", "sppm"},
                                                    {"volpath", "path"}}};

// Null for names that pbrt does not have.
const char* counterpart_of(const std::string& name) {
  const auto* const found =
      std::find_if(counterparts.begin(), counterparts.end(), [&](const Counterpart& c) { return name == c.of_pbrt; });
  return found == counterparts.end() ? nullptr : found->ours;
}

}  // namespace

std::string integrator_of_file(const std::string& name) {
  if (const char* const ours = counterpart_of(name)) return ours;
  for (const IntegratorInfo& info : integrator_registry())
    if (name == info.name) return name;
  return "";
}

DefaultMethod default_method(const std::string& integrator) {
  if (const char* const counterpart = counterpart_of(integrator))
    return {automatic_method,
            fmt::format("method {}: in place of pbrt's \"{}\", which the file names (-i {}: that method)",
                        automatic_method, integrator, counterpart)};
  const std::string ours = integrator_of_file(integrator);
  return {ours.empty() ? automatic_method : ours, {}};
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
