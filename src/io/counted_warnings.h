// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "lanthorn/scene_description.h"

namespace lanthorn {

using MessageOfNames = std::function<std::string(const std::vector<std::string>&)>;

/// The verb of a sentence about these names.
inline const char* is_or_are(const std::vector<std::string>& names) { return names.size() > 1 ? "are" : "is"; }

/// Collects warnings, one per kind of problem: the first one, followed by the number of further ones.
class CountedWarnings {
 public:
  /// Adds the warning to the list; if the list has one with this `key`, only increases its count. All calls must pass
  /// the same list.
  void add(std::vector<description::Warning>& list, std::string_view key, const SourceLocation& place,
           const std::string& message);
  /// Adds a warning about something with this name. One line lists the names of all warnings with this `key`:
  /// `message_of` gets these, different from each other.
  void add_name(std::vector<description::Warning>& list, std::string_view key, const SourceLocation& place,
                const std::string& name, const MessageOfNames& message_of);

 private:
  struct Kind {
    std::size_t index = 0;   ///< into the list
    std::size_t length = 0;  ///< of the first message
    std::size_t more = 0;
    std::vector<std::string> names = {};
  };
  std::unordered_map<std::string, Kind> kinds_;
};

}  // namespace lanthorn
