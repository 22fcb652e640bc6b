// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The page of `serve`: one document with its style and its program, which asks for nothing but the server's pictures.
#pragma once

#include <string>

namespace lanthorn::program {

/// The document. `nonce`: of the content security policy, by which style and program may run.
std::string page_html(const std::string& nonce);

}  // namespace lanthorn::program
