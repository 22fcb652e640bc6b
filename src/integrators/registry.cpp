// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "integrators/integrator.h"
#include "lanthorn/error.h"
#include "lanthorn/text.h"

namespace lanthorn {

// Each is defined in its integrator's own file, or beside it in its settings.
IntegratorInfo auto_info();
IntegratorInfo bdpt_info();
IntegratorInfo bpm_info();
IntegratorInfo light_info();
IntegratorInfo mlt_info();
IntegratorInfo path_info();
IntegratorInfo photonmap_info();
IntegratorInfo ppm_info();
IntegratorInfo probppm_info();
IntegratorInfo reversephotonmap_info();
IntegratorInfo splitsum_info();
IntegratorInfo sppm_info();
IntegratorInfo vcm_info();

void add_stages(std::vector<StageSeconds>& sum, const std::vector<StageSeconds>& stages) {
  for (const StageSeconds& stage : stages) {
    const auto same = std::find_if(sum.begin(), sum.end(), [&](const StageSeconds& s) { return s.name == stage.name; });
    if (same == sum.end())
      sum.push_back(stage);
    else
      same->seconds += stage.seconds;
  }
}

void add_bounces(std::vector<std::uint64_t>& sum, const std::vector<std::uint64_t>& photons) {
  sum.resize(std::max(sum.size(), photons.size()));
  for (std::size_t i = 0; i < photons.size(); ++i) sum[i] += photons[i];
}

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

namespace {

std::vector<IntegratorInfo>& registry() {
  static std::vector<IntegratorInfo> all{
      auto_info(), probppm_info(), sppm_info(),  ppm_info(), photonmap_info(),        vcm_info(),     bpm_info(),
      bdpt_info(), path_info(),    light_info(), mlt_info(), reversephotonmap_info(), splitsum_info()};
  return all;
}

}  // namespace

const std::vector<IntegratorInfo>& integrator_registry() { return registry(); }

void add_integrator(IntegratorInfo info) {
  for (const IntegratorInfo& known : registry())
    if (known.name == info.name) throw Error(fmt::format("an integrator named '{}' exists already", info.name));
  registry().push_back(std::move(info));
}

const IntegratorInfo& find_integrator(const std::string& name) {
  std::vector<std::string> known;
  for (const IntegratorInfo& info : integrator_registry()) {
    if (info.name == name) return info;
    known.push_back(info.name);
  }
  throw Error(
      fmt::format("unknown integrator '{}'; known: {}{}", name, fmt::join(known, ", "), did_you_mean(name, known)));
}

std::vector<MethodInfo> methods() { return {registry().begin(), registry().end()}; }

const MethodInfo& find_method(const std::string& name) { return find_integrator(name); }

void require_independent_passes(const std::string& option, const std::string& method) {
  const IntegratorInfo& info = find_integrator(method);
  if (info.make(Parameters(info.parameters, {}, info.name))->passes_are_independent()) return;
  throw Error(fmt::format("{}: each pass of {} depends on all before it, so that it can start with pass 0 only", option,
                          info.name));
}

}  // namespace lanthorn
