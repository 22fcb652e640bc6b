// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace lanthorn {

/// `text` in quotes for a message: unprintable bytes shown as ?, shortened if long.
std::string in_quotes(std::string_view text);

}  // namespace lanthorn
