// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "lanthorn/description_data.h"
#include "lanthorn/error.h"
#include "lanthorn/plain_data.h"

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

constexpr auto option_members =
    std::tuple(Member<RenderOptions, decltype(RenderOptions::resolution)>{"resolution", &RenderOptions::resolution},
               Member<RenderOptions, decltype(RenderOptions::crop)>{"crop", &RenderOptions::crop},
               Member<RenderOptions, decltype(RenderOptions::clamp)>{"clamp", &RenderOptions::clamp},
               field("integrator", &RenderOptions::integrator), field("passes", &RenderOptions::passes),
               field("seconds", &RenderOptions::seconds), field("noise", &RenderOptions::noise),
               field("seed", &RenderOptions::seed), field("color", &RenderOptions::color),
               field("photons", &RenderOptions::photons), field("max_depth", &RenderOptions::max_depth),
               field("memory", &RenderOptions::memory));

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
  std::apply([&](const auto&... member) { (read_member(reader, dict, options, member, known), ...); }, option_members);
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
    // Parameter names use hyphens where Python uses underscores.
    std::string parameter = name;
    std::replace(parameter.begin(), parameter.end(), '_', '-');
    options.set[parameter] = parameter_text(value);
  }
  return options;
}

}  // namespace lanthorn
