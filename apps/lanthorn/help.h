// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// How --help presents a command: its options in groups, the common ones first, in lines of 80 columns.
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

}  // namespace lanthorn::program
