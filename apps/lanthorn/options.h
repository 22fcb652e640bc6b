// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The table of options. One entry defines everything about an option: names, help, type and variable. The parser,
// --help, man pages, completion, messages and printed command lines are derived from it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "value_types.h"

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
}  // namespace CLI

namespace lanthorn::program {

enum class Arity : std::uint8_t {
  flag,      ///< no value
  one,       ///< one value, once
  repeated,  ///< one value; may be given several times
  several    ///< several values one after the other
};

/// A variable that an option sets, and its type. The variable must outlive this object. Its value at construction is
/// the default.
struct OptionValue {
  Arity arity = Arity::one;
  std::string type{};  ///< name of the type; empty for flags
  /// Sets the variable from a word. Throws CLI::ValidationError, naming the option, if the text is not of the type.
  std::function<void(const std::string& option, const std::string& word)> read;
  /// The words from which `read` would restore the variable's current value. No words if it is the default; one empty
  /// word for a flag.
  std::function<std::vector<std::string>()> print;
};

struct Option {
  std::string names;  ///< "-n,--photons"; for a positional argument, its name in the help
  OptionValue value;
  std::string brief;        ///< what it is or does, in one line, for --help
  std::string details{};    ///< more sentences, for --help --all and the man page
  std::string otherwise{};  ///< the default, where there is one to tell
  bool required = false;
  std::string excludes{};  ///< name of another option that cannot be given at the same time
  /// The title in the help above this option, which -h does not show; for options that `help.cpp` does not list.
  std::string group{};

  bool is_argument() const { return !names.starts_with('-'); }
  /// The longest name: "--photons".
  std::string long_name() const { return names.substr(names.rfind(',') + 1); }
  /// The shortest name: "-n".
  std::string short_name() const { return names.substr(0, names.find(',')); }
  /// The help text; `in_short`: without the details.
  std::string description(bool in_short) const;
};

/// The text, ended by a full stop.
std::string sentence(const std::string& text);

using OptionTable = std::vector<Option>;

/// An option or argument whose value is the name of a file.
Option file_option(const std::string& names, std::string& file, const std::string& brief);
/// The same for one that must be given.
Option required_file(const std::string& names, std::string& file, const std::string& brief);

OptionTable joined(OptionTable table, OptionTable more);
/// The table without the option of this name.
OptionTable without(OptionTable table, const std::string& name);

/// A subcommand: its name, options, help and action.
struct Command {
  std::string name;
  std::string summary;
  OptionTable options;
  std::string footer;  ///< of the help: text, then "Example:" or "Examples:" and indented lines
  std::function<void()> run;
};

/// Registers a subcommand with the program.
CLI::App& add_command(CLI::App& program, Command command);

/// A command line, quoted for a shell, that sets the variables of the table's options to their current values; omits
/// options that have their defaults.
std::string command_line(const std::string& command, const OptionTable& table);

std::vector<std::string> joined(std::vector<std::string> words, const std::vector<std::string>& more);
/// Rejects a value: ends parsing with a message.
[[noreturn]] void refuse_value(const std::string& option, const std::string& text, const std::string& expected,
                               const std::vector<std::string>& known);

template <class Value>
Value parse_value(const ValueType<Value>& type, const std::string& option, const std::string& text) {
  std::optional<Value> value = type.parse(text);
  if (!value) refuse_value(option, text, type.expected, joined(type.words, type.similar(text)));
  return *std::move(value);
}

/// An option whose value is accessed through `set` and `get`; `get` returns nullopt for the default.
template <class Value>
OptionValue through(const ValueType<Value>& type, std::function<void(Value)> set,
                    std::function<std::optional<Value>()> get) {
  return {Arity::one, type.name,
          [type, set = std::move(set)](const std::string& option, const std::string& word) {
            set(parse_value(type, option, word));
          },
          [type, get = std::move(get)] {
            const std::optional<Value> value = get();
            return value ? std::vector<std::string>{type.print(*value)} : std::vector<std::string>();
          }};
}

/// For a variable that holds a value, or an optional value.
template <class Variable, class Value>
OptionValue into(Variable& variable, const ValueType<Value>& type) {
  return through<Value>(
      type,
      [&variable](Value value) {
        if constexpr (requires { variable.has_value(); })
          variable = static_cast<typename Variable::value_type>(std::move(value));
        else
          variable = static_cast<Variable>(std::move(value));
      },
      [&variable, initial = variable]() -> std::optional<Value> {
        if (variable == initial) return std::nullopt;
        if constexpr (requires { variable.has_value(); })
          return static_cast<Value>(variable.value());
        else
          return static_cast<Value>(variable);
      });
}

/// A flag that sets a variable to `value`.
template <class Variable>
OptionValue flag(Variable& variable, Variable value) {
  return {Arity::flag, "", [&variable, value](const std::string&, const std::string&) { variable = value; },
          [&variable, value, initial = variable] {
            return variable == value && variable != initial ? std::vector<std::string>{""} : std::vector<std::string>();
          }};
}
inline OptionValue flag(bool& variable) { return flag(variable, true); }

/// For a vector or map to which each value is added.
template <class Variable, class Value>
OptionValue each_into(Variable& variable, const ValueType<Value>& type, Arity arity = Arity::repeated) {
  return {arity, type.name,
          [&variable, type](const std::string& option, const std::string& word) {
            Value value = parse_value(type, option, word);
            if constexpr (requires { typename Variable::mapped_type; })
              variable.insert_or_assign(std::move(value.first), std::move(value.second));
            else
              variable.push_back(std::move(value));
          },
          [&variable, type] {
            std::vector<std::string> words;
            words.reserve(variable.size());
            for (const auto& value : variable) words.push_back(type.print(value));
            return words;
          }};
}

}  // namespace lanthorn::program
