// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/counted_warnings.h"

namespace lanthorn {

void CountedWarnings::add(std::vector<description::Warning>& list, std::string_view key, const SourceLocation& place,
                          const std::string& message) {
  const auto [it, is_new] = kinds_.try_emplace(std::string(key), Kind{list.size(), message.size()});
  if (is_new) {
    list.push_back({place, message});
    return;
  }
  Kind& kind = it->second;
  ++kind.more;
  std::string& counted = list[kind.index].message;
  counted.resize(kind.length);
  counted += " (and " + std::to_string(kind.more) + " more like it)";
}

}  // namespace lanthorn
