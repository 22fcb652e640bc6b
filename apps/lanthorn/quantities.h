// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Numbers as users type them, with their units, and the options that take them: the same for every command.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
class Option;
}  // namespace CLI

namespace lanthorn::program {

/// A whole number: "500000", "200k", "1.5M", "2G" (powers of 1000), "1e6". Nothing for any other text.
std::optional<std::uint64_t> parse_count(std::string_view text);
/// Seconds, more than 0: "90", "30s", "1.5m", "2h". Nothing for any other text.
std::optional<double> parse_duration(std::string_view text);
/// Bytes, one at least: "65536", "64k", "512M", "2G" (powers of 1024; "MB" and "MiB" are the same). Nothing for any
/// other text.
std::optional<std::uint64_t> parse_bytes(std::string_view text);
/// A finite number. Nothing for any other text.
std::optional<double> parse_number(std::string_view text);

/// The range of an option's values, both ends included.
struct CountRange {
  std::uint64_t low = 0, high = std::numeric_limits<std::uint64_t>::max();
};
struct NumberRange {
  double low = -std::numeric_limits<double>::max(), high = std::numeric_limits<double>::max();
};

/// Options with values of these kinds; `set` receives the value. Other values and those out of range end the parsing
/// with a message that says what was expected. `names`: as for CLI11, such as "-n,--photons".
CLI::Option* add_count_option(CLI::App& command, const std::string& names, const std::string& help, CountRange range,
                              std::function<void(std::uint64_t)> set);
CLI::Option* add_number_option(CLI::App& command, const std::string& names, const std::string& help, NumberRange range,
                               std::function<void(double)> set);
/// As above, or `word`, for which `set` gets nothing.
CLI::Option* add_number_option(CLI::App& command, const std::string& names, const std::string& help, NumberRange range,
                               const std::string& word, std::function<void(std::optional<double>)> set);
CLI::Option* add_duration_option(CLI::App& command, const std::string& names, const std::string& help,
                                 std::function<void(double)> set);
CLI::Option* add_bytes_option(CLI::App& command, const std::string& names, const std::string& help,
                              std::function<void(std::uint64_t)> set);

/// `set` for a variable: a number, or an optional of one. It must outlive the parsing.
template <class Variable>
auto into(Variable& variable) {
  return [&variable](auto value) {
    if constexpr (requires { typename Variable::value_type; })
      variable = static_cast<typename Variable::value_type>(value);
    else
      variable = static_cast<Variable>(value);
  };
}

}  // namespace lanthorn::program
