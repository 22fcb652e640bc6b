// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>

namespace lanthorn {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

/// Appends a number in little-endian order to a string or vector of bytes.
template <class Bytes, class Number>
void append_number(Bytes& out, Number value) {
  const auto* const bytes = reinterpret_cast<const typename Bytes::value_type*>(&value);
  for (std::size_t i = 0; i < sizeof value; ++i) out.push_back(bytes[i]);
}

}  // namespace lanthorn
