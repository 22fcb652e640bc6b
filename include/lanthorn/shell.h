// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace lanthorn {

/// `text` quoted as one word of a POSIX shell's command line: in single quotes, unless it has only plain characters.
/// Text with control characters, which a terminal would obey when the line is pasted, becomes printable ASCII in $'...'
/// (POSIX 2024; bash, zsh, ksh).
std::string shell_word(const std::string& text);

}  // namespace lanthorn
