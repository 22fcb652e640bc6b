// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Numbers in messages.
#pragma once

#include <string>

namespace lanthorn {

/// Two significant digits ("0.0012", "12"), or a whole number from 100 to a million ("100", "12345"). Numbers beyond a
/// million and below .0001 have an exponent ("2.3e+07").
std::string short_number(double number);

}  // namespace lanthorn
