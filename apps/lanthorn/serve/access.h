// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Access control of the server: clients must know the random token in its address; edits must come from its own page.
#pragma once

#include <string>
#include <string_view>

#include "http_message.h"

namespace lanthorn::program {

/// 128 random bits of the operating system as 32 hexadecimal digits. Throws Error if it provides none.
std::string random_token();

/// Compares texts in a time that depends only on the length of `a`.
bool equal_in_constant_time(std::string_view a, std::string_view b);

/// True if a Host field (RFC 9110, §7.2) names this machine in a way that no foreign name server can answer for:
/// localhost, a numeric address, or `own_name` (this machine's, or empty). Any port is accepted, because tunnels change
/// it. A page of another site whose name was redirected to this machine's address (DNS rebinding) sends its own name.
bool is_own_host(std::string_view host, std::string_view own_name);

/// Requests that change something must come from one of this server's own pages: their Origin field names its host.
/// Other requests may lack the field.
bool is_own_origin(const HttpRequest& request);

}  // namespace lanthorn::program
