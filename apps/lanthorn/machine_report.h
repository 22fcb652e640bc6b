// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lanthorn::program {

/// Prints the machine's hardware and the resources that this process may use, for `info --machine`.
void show_machine(bool as_json);

}  // namespace lanthorn::program
