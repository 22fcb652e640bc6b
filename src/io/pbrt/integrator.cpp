// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Integrator and sampler.
#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

#include "io/pbrt/builders.h"
#include "lanthorn/text.h"

namespace lanthorn::pbrt {

namespace {

using description::RenderHints;

std::optional<int> find_at_least(const ParameterList& list, std::string_view name, int least) {
  const auto value = list.find_integer(name);
  if (value && *value < least) throw list.error(name, "must be at least " + std::to_string(least));
  return value;
}

void read_seed(const ParameterList& list, RenderHints& hints) {
  if (const auto seed = list.find_integer("seed")) hints.seed = static_cast<std::uint32_t>(*seed);
}

// The value of a method's parameter in the command line's notation.
std::string setting(const Parameter& p, const ParameterList& list) {
  const auto text = [&](const auto& values) {
    if (values.size() != 1) throw list.error(p.name, "must have one value");
    return fmt::format("{}", static_cast<typename std::decay_t<decltype(values)>::value_type>(values[0]));
  };
  return std::visit(text, p.values);
}

// Reads parameters of Lanthorn's methods, under their own names.
void read_method_parameters(const KnownMethod& method, const ParameterList& list, RenderHints& hints) {
  for (const ParameterInfo& known : method.parameters)
    if (const Parameter* p = list.find(known.name)) hints.parameters[known.name] = setting(*p, list);
  try {
    method.check(hints.parameters);
  } catch (const Error& problem) {
    throw Error(list.place().location(), problem.message);
  }
}

}  // namespace

void read_integrator(const std::string& kind, const ParameterList& list, Context& context) {
  RenderHints& hints = context.scene.hints;
  hints.integrator = kind;
  hints.parameters.clear();
  hints.max_depth = find_at_least(list, "maxdepth", 0);
  hints.regularize = list.get("regularize", false);
  if (const auto photons = list.find_integer("photonsperiteration"); photons && *photons > 0)
    hints.photons_per_iteration = *photons;
  read_seed(list, hints);
  if (const std::optional<KnownMethod> method = context.methods(kind))
    read_method_parameters(*method, list, hints);
  else
    context.warn("integrator", list.place(),
                 "neither pbrt nor Lanthorn has an integrator " + in_quotes(kind) + ": the default method is used");
  report_unused(list, context);
}

void read_sampler(const std::string&, const ParameterList& list, Context& context) {
  RenderHints& hints = context.scene.hints;
  hints.pixel_samples = find_at_least(list, "pixelsamples", 1);
  const auto x = find_at_least(list, "xsamples", 1), y = find_at_least(list, "ysamples", 1);
  if (x || y) hints.pixel_samples = std::min(x.value_or(4), 65536) * std::min(y.value_or(4), 32767);
  read_seed(list, hints);
  // The kind of sampler has no effect: Lanthorn uses its own.
  for (const std::string_view name : {"randomization", "jitter"}) list.find(name);
  report_unused(list, context);
}

}  // namespace lanthorn::pbrt
