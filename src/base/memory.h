// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// How much memory there is: asked before much is taken, since systems promise more than they have and then end the
// process without a word.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lanthorn/error.h"

namespace lanthorn {

/// Bytes that this process can still take: the least of what the machine, its control group (version 2) and its own
/// limit of addresses (ulimit -v) leave. nullopt where none of them is known.
std::optional<std::uint64_t> available_memory();

/// "1.5 GiB"; whole bytes below a KiB.
std::string memory_text(double bytes);

/// Throws Error, "WHAT takes SIZE of memory, but there are only ...", if so many bytes cannot be had. Cheap below 64
/// MiB, which are always granted.
void require_memory(double bytes, const SourceLocation& where, const std::string& what);

}  // namespace lanthorn
