// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The page of `serve`: one document that contains its style and script, and requests only the server's pictures.
#pragma once

#include <string>

namespace lanthorn::program {

/// The document. `nonce`: from the content security policy, authorises style and script.
std::string page_html(const std::string& nonce);

}  // namespace lanthorn::program
