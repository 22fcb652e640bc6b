// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/counted_warnings.h"

#include <algorithm>

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

void CountedWarnings::add_name(std::vector<description::Warning>& list, std::string_view key,
                               const SourceLocation& place, const std::string& name, const MessageOfNames& message_of) {
  constexpr std::size_t most = 64;  // more names than a message shows
  const auto [it, is_new] = kinds_.try_emplace(std::string(key), Kind{list.size()});
  std::vector<std::string>& names = it->second.names;
  if (is_new) list.push_back({place, ""});
  if (names.size() == most || std::find(names.begin(), names.end(), name) != names.end()) return;
  names.push_back(name);
  list[it->second.index].message = message_of(names);
}

}  // namespace lanthorn
