// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lanthorn {

/// The name that `word` was probably meant to be: the one that the fewest insertions, deletions, replacements and swaps
/// of neighbours lead to, if they are at most a third of its letters; else the only one that begins with `word` (three
/// letters or more). Nothing if there is none. The first of equals.
std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string> known);

/// "; did you mean NAME?", or nothing: to go at the end of a message.
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

}  // namespace lanthorn
