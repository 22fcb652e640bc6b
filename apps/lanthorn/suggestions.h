// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
}

namespace lanthorn::program {

/// Makes the program say in its own words what is wrong with a command line, and what was probably meant by a command
/// or option that does not exist.
void add_suggestions(CLI::App& program);

}  // namespace lanthorn::program
