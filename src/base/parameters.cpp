// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "base/parameters.h"

#include <fmt/format.h>

#include <charconv>

#include "lanthorn/error.h"
#include "lanthorn/text.h"

namespace lanthorn {

Parameters::Parameters(const std::vector<ParameterInfo>& known, const std::map<std::string, std::string>& set,
                       const std::string& integrator) {
  for (const ParameterInfo& p : known) values_[p.name] = p.default_value;
  for (const auto& [name, value] : set) {
    const auto entry = values_.find(name);
    if (entry == values_.end()) {
      std::vector<std::string> names;
      names.reserve(known.size());
      for (const ParameterInfo& p : known) names.push_back(p.name);
      if (known.empty())
        throw Error(fmt::format("--set {}={}: integrator '{}' has no parameters; -i selects another method", name,
                                value, integrator));
      const std::string meant = did_you_mean(name, names);
      throw Error(fmt::format("--set {}={}: integrator '{}' has no such parameter{}", name, value, integrator,
                              meant.empty() ? fmt::format("; 'lanthorn list {}' shows them", integrator) : meant));
    }
    entry->second = value;
  }
}

double Parameters::number(const std::string& name, double min, double max) const {
  const std::string& value = values_.at(name);
  double x = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), x);
  if (error != std::errc() || end != value.data() + value.size() || !(x >= min && x <= max))
    throw Error(fmt::format("--set {}={}: expected a number from {} to {}", name, value, min, max));
  return x;
}

}  // namespace lanthorn
