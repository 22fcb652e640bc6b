// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Who may use the server: those who know its address with the random token, from a page of its own.
#pragma once

#include <string>
#include <string_view>

#include "http_message.h"

namespace lanthorn::program {

/// 128 random bits of the operating system as 32 hexadecimal digits. Throws Error if it has none.
std::string random_token();

/// The time depends on the length of `a` alone.
bool equal_in_constant_time(std::string_view a, std::string_view b);

/// True if a Host field (RFC 9110, §7.2) names this machine in a way that no foreign name server can answer for:
/// localhost, an address in numbers, or `own_name` (this machine's, or empty). Any port will do: tunnels change it. A
/// page of another site whose name was turned to this machine's address (DNS rebinding) sends its own name.
bool is_own_host(std::string_view host, std::string_view own_name);

/// Requests that change something must come from a page of this very server: their Origin field names its host. Others
/// may lack the field.
bool is_own_origin(const HttpRequest& request);

}  // namespace lanthorn::program
