// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "bindings.h"
#include "plain_data.h"

namespace lanthorn::python {

template <>
struct Names<ColorMode> {
  static constexpr std::array<std::pair<std::string_view, ColorMode>, 2> list{
      {{"rgb", ColorMode::rgb}, {"spectral", ColorMode::spectral}}};
};

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

// As the command line has it.
std::string parameter_text(py::handle value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  return py::str(value).cast<std::string>();
}

}  // namespace

RenderOptions options_of(const py::dict& keywords) {
  Reader reader;
  RenderOptions options;
  Keys known{"pass_range"};
  std::apply([&](const auto&... member) { (read_member(reader, keywords, options, member, known), ...); },
             option_members);
  if (keywords.contains("pass_range") && !keywords["pass_range"].is_none()) {
    reader.at("pass_range", [&] {
      std::array<std::uint64_t, 2> range{};
      read(reader, keywords["pass_range"], range);
      options.pass_range = PassRange{range[0], range[1]};
    });
  }
  for (const auto& [key, value] : keywords) {
    const auto name = key.cast<std::string>();
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      // Parameters have hyphens where Python has underscores.
      std::string parameter = name;
      std::replace(parameter.begin(), parameter.end(), '_', '-');
      options.set[parameter] = parameter_text(value);
    }
  }
  return options;
}

py::list texts_of(const std::vector<description::Warning>& warnings) {
  py::list texts;
  for (const description::Warning& warning : warnings) texts.append(Error(warning.location, warning.message).what());
  return texts;
}

}  // namespace lanthorn::python
