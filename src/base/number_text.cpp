// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/text.h"

#include <fmt/format.h>

#include <cmath>

namespace lanthorn {

std::string short_number(double number) {
  const double size = std::fabs(number);
  return size >= 99.5 && size < 1e6 ? fmt::format("{:.0f}", number) : fmt::format("{:.2g}", number);
}

}  // namespace lanthorn
