// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Text in messages: suggestions for misspelt names, durations, numbers, quotations from files. Whatever bytes a file
// holds, a message stays on one line, has no effect on a terminal, and shows at most one token of the file. Also quotes
// words for a shell.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lanthorn {

/// `text` with everything but printable UTF-8 (control characters, marks that change the writing direction) as \xNN.
std::string printable(std::string_view text);

/// `text` as messages show it: printable, and cut after 32 characters.
std::string excerpt(std::string_view text);

/// `text` in quotes for a message: printable, quotes and backslashes in it escaped, and cut after 32 characters.
std::string in_quotes(std::string_view text);

/// The first eight names in quotes, separated by commas; "..." stands for the rest.
std::string quoted_list(std::span<const std::string> names);

/// The message with "..." in place of all quoted text, so that it reveals nothing of a file's content.
std::string without_quotations(std::string_view message);

/// The known name that `word` was probably meant to be: the one with the fewest insertions, deletions, replacements and
/// swaps of neighbouring letters, if these are at most a third of the letters of `word`; else the only one that begins
/// with `word` (at least three letters). The first of several equally near names. nullopt if there is none.
std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string> known);

/// "; did you mean NAME?" to append to a message, or an empty string.
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

/// Seconds as "1:02:03 h", "2:03 min" or "4 s".
std::string format_duration(double seconds);

/// Two significant digits ("0.0012", "12"), or a whole number from 100 to a million ("100", "12345"). Numbers beyond a
/// million and below .0001 have an exponent ("2.3e+07").
std::string short_number(double number);

/// `text` quoted as one word of a POSIX shell's command line: in single quotes, unless it has only plain characters.
/// Text with control characters, which a terminal would obey when the line is pasted, becomes printable ASCII in $'...'
/// (POSIX 2024; bash, zsh, ksh).
std::string shell_word(const std::string& text);

}  // namespace lanthorn
