// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lanthorn::program {

/// Prints what the machine is and what this process may use of it, for `info --machine`.
void show_machine(bool as_json);

}  // namespace lanthorn::program
