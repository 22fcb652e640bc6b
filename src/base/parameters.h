// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/methods.h"
#include "lanthorn/text.h"

namespace lanthorn {

/// The values of an integrator's parameters: defaults, overridden by the user's settings.
class Parameters {
 public:
  /// Throws Error if `set` names a parameter that is not in `known`.
  Parameters(const std::vector<ParameterInfo>& known, const std::map<std::string, std::string>& set,
             const std::string& integrator);

  const std::string& text(const std::string& name) const { return values_.at(name); }
  /// The parameter's value. Throws Error unless it is a number in [min, max].
  double number(const std::string& name, double min, double max) const;
  const std::map<std::string, std::string>& all() const { return values_; }

 private:
  std::map<std::string, std::string> values_;
};

/// The value of a parameter that takes one of several words. Throws Error, listing them, for any other word.
template <class Value, std::size_t n>
Value choice(const Parameters& parameters, const char* name,
             const std::array<std::pair<const char*, Value>, n>& known) {
  const std::string& text = parameters.text(name);
  std::vector<std::string> names;
  for (const auto& [known_name, value] : known) {
    if (text == known_name) return value;
    names.emplace_back(known_name);
  }
  throw Error(
      fmt::format("--set {}={}: expected one of {}{}", name, text, fmt::join(names, ", "), did_you_mean(text, names)));
}

}  // namespace lanthorn
