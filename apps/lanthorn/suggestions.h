// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
}

namespace lanthorn::program {

/// Replaces CLI11's error messages by our own, which suggest the command or option that was probably meant.
void add_suggestions(CLI::App& program);

}  // namespace lanthorn::program
