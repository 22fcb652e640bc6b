// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// How --help presents a command: its options in groups, the common ones first, in lines of 80 columns. Also makes
// man pages and bash completion of these options, which the option tables (options.h) have registered with CLI11.
#pragma once

#include <string>
#include <vector>

#include "options.h"

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
class Option;
}  // namespace CLI

namespace lanthorn::program {

struct HelpGroup {
  std::string title;
  std::vector<const CLI::Option*> options;
};

/// Adds the flags -h, --help and --all. --help prints the common options in brief, --help --all every option with
/// details. Call before the table's options are registered, so that CLI11 handles --help before it checks other words.
void add_help(CLI::App& command, const OptionTable& table);

/// Assigns the registered options of `table` to their groups of the help.
void group_options(CLI::App& command, const OptionTable& table);

/// The options that --help names, in the order of their registration; with `positional`, the arguments without a name
/// instead.
std::vector<const CLI::Option*> visible_options(const CLI::App& command, bool positional);

/// The visible options of a command by group, in the order of the help.
std::vector<HelpGroup> grouped_options(const CLI::App& command);

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
