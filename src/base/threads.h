// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lanthorn {

/// How many threads can be started besides this one, `wanted` at most: starts as many for a moment. Fewer where the
/// system limits the threads of a user or a container, or where their stacks do not fit into memory.
unsigned startable_threads(unsigned wanted);

}  // namespace lanthorn
