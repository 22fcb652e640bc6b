// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Parses quantities with their units, as users type them.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace lanthorn::program {

/// A whole number: "500000", "200k", "1.5M", "2G" (powers of 1000), "1e6". nullopt for any other text.
std::optional<std::uint64_t> parse_count(std::string_view text);
/// Seconds, with or without a unit: "90", "30s", "1.5m", "-2h". nullopt for any other text.
std::optional<double> parse_seconds(std::string_view text);
/// Seconds, more than 0. nullopt for any other text.
std::optional<double> parse_duration(std::string_view text);
/// Bytes, at least one: "65536", "64k", "512M", "2G" (powers of 1024; "MB" and "MiB" mean the same). nullopt for any
/// other text.
std::optional<std::uint64_t> parse_bytes(std::string_view text);
/// A fraction in (0, 1]: "2%", "0.02". nullopt for any other text.
std::optional<double> parse_share(std::string_view text);
/// A finite number: "1.5", "+1", "-2e-3". nullopt for any other text.
std::optional<double> parse_number(std::string_view text);

}  // namespace lanthorn::program
