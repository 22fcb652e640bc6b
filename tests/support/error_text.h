// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lanthorn/error.h"

namespace lanthorn::test {

/// What the error of this call says; "no error" if there is none.
template <class Call>
std::string error_text(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace lanthorn::test
