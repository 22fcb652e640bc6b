// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/suggestion.h"
#include "integrators/settings.h"
#include "lanthorn/error.h"

namespace lanthorn {

/// The value of a parameter that is one of some words; throws Error, naming them, if it is another.
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
