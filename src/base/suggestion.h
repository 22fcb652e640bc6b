// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lanthorn {

/// The known name that `word` was probably meant to be: the one with the fewest insertions, deletions, replacements and
/// swaps of neighbours, if they are at most a third of its letters; else the only one that begins with `word` (three
/// letters or more). The first of several equally near names. nullopt if there is none.
std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string> known);

/// "; did you mean NAME?", or an empty string, to append to a message.
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

}  // namespace lanthorn
