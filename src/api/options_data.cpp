// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "lanthorn/description_data.h"
#include "lanthorn/error.h"
#include "lanthorn/methods.h"
#include "lanthorn/plain_data.h"
#include "lanthorn/text.h"
#include "plain/type.h"

namespace lanthorn {

using namespace plain;

namespace {

// Names of parameters, which use hyphens where Python uses underscores.
std::string with_hyphens(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

// Throws Error unless some method has this parameter. `options`: what else the name may have been meant to be.
void require_parameter_of_any_method(const std::string& name, const Keys& options) {
  std::vector<std::string> known(options.begin(), options.end());
  for (const MethodInfo& method : methods())
    for (const ParameterInfo& parameter : method.parameters) {
      if (parameter.name == with_hyphens(name)) return;
      known.push_back(parameter.name);
    }
  const std::string meant = did_you_mean(name, known);
  throw Error(fmt::format("{}: there is no such option, and no method has such a parameter{}", name,
                          meant.empty() ? fmt::format("; the options are {}", fmt::join(options, ", ")) : meant));
}

// The value in the command line's notation.
std::string parameter_text(const Value& value) {
  if (const auto* flag = value.as<bool>()) return *flag ? "true" : "false";
  if (const auto* text = value.as<std::string>()) return *text;
  return shown(value);
}

}  // namespace

RenderOptions options_of_data(const Value& data) {
  Reader reader;
  const Dict& dict = dict_of(reader, data);
  RenderOptions options;
  Keys known;
  read_members(reader, dict, type_of<RenderOptions>(), &options, known);
  for (const auto& [name, value] : dict.entries()) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    require_parameter_of_any_method(name, known);
    options.set[with_hyphens(name)] = parameter_text(value);
  }
  return options;
}

}  // namespace lanthorn
