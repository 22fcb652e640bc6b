// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "lanthorn/description_data.h"
#include "lanthorn/error.h"
#include "lanthorn/methods.h"
#include "lanthorn/plain_data.h"
#include "lanthorn/text.h"

namespace lanthorn {

namespace plain {

template <>
struct Names<ColorMode> {
  static constexpr std::array<std::pair<std::string_view, ColorMode>, 2> list{
      {{"rgb", ColorMode::rgb}, {"spectral", ColorMode::spectral}}};
};

}  // namespace plain

using namespace plain;

namespace {

// Limits, for which each command line has its own words.
constexpr std::tuple limit_members{field("passes", &RenderOptions::passes), field("seconds", &RenderOptions::seconds),
                                   field("noise", &RenderOptions::noise)};

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
  Keys known{"pass_range"};
  const auto read_option = [&](const auto& member) { read_member(reader, dict, options, member, known); };
  for_each_render_option([&](const auto& option) { read_option(field(option.name, option.value)); });
  std::apply([&](const auto&... member) { (read_option(member), ...); }, limit_members);
  const Value* range = dict.find("pass_range");
  if (range != nullptr && !range->is_none()) {
    reader.at("pass_range", [&] {
      std::array<std::uint64_t, 2> passes{};
      read(reader, *range, passes);
      options.pass_range = PassRange{passes[0], passes[1]};
    });
  }
  for (const auto& [name, value] : dict.entries()) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    require_parameter_of_any_method(name, known);
    options.set[with_hyphens(name)] = parameter_text(value);
  }
  return options;
}

}  // namespace lanthorn
