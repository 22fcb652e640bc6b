// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "lanthorn/scene_description.h"

namespace lanthorn {

/// Collects warnings, one per kind of problem: the first one, followed by the number of further ones.
class CountedWarnings {
 public:
  /// Adds the warning to the list; if the list has one with this `key`, only increases its count. All calls must pass
  /// the same list.
  void add(std::vector<description::Warning>& list, std::string_view key, const SourceLocation& place,
           const std::string& message);

 private:
  struct Kind {
    std::size_t index = 0;   ///< into the list
    std::size_t length = 0;  ///< of the first message
    std::size_t more = 0;
  };
  std::unordered_map<std::string, Kind> kinds_;
};

}  // namespace lanthorn
