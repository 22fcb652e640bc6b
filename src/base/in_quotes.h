// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Text of files in messages. Whatever its bytes, a message stays one line, has no effect on a terminal, and shows no
// more of the file than one token.
#pragma once

#include <string>
#include <string_view>

namespace lanthorn {

/// `text` with all but printable UTF-8 (control characters, marks that change the writing direction) written as \xNN.
std::string printable(std::string_view text);

/// `text` as messages show it: printable, and cut after 32 characters.
std::string excerpt(std::string_view text);

/// `text` in quotes for a message: printable, quotes and backslashes in it escaped, and cut after 32 characters.
std::string in_quotes(std::string_view text);

/// The message with "..." in place of all quoted text, so that it reveals nothing of a file's content.
std::string without_quotations(std::string_view message);

}  // namespace lanthorn
