// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Man pages and bash completion, generated from what the option tables (options.h) have registered with CLI11.
#pragma once

#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
class Option;
}  // namespace CLI

namespace lanthorn::program {

/// The subcommands that --help lists, in its order.
std::vector<const CLI::App*> visible_commands(const CLI::App& program);

/// The names of an option as they are typed: {"-i", "--integrator"}.
std::vector<std::string> option_names(const CLI::Option& option);

/// The type of an option's value, such as FILE, COUNT or rgb|spectral; empty for flags. Completion depends on it.
std::string value_type(const CLI::Option& option);

/// The man page of `command` in troff; `command` is a subcommand of `program` or `program` itself.
std::string man_page(const CLI::App& program, const CLI::App& command);

/// A completion script for bash to source.
std::string bash_completion(const CLI::App& program);

}  // namespace lanthorn::program
