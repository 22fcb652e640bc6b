// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Available memory. Checked before large allocations, because systems overcommit and then kill the process without a
// message.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lanthorn/error.h"

namespace lanthorn {

/// Bytes that this process can still allocate: the minimum of the memory that the machine, its control groups
/// (base/control_group.h) and its address-space limit (ulimit -v) leave; nullopt if none of them is known.
std::optional<std::uint64_t> available_memory();

/// "1.5 GiB"; whole bytes below one KiB.
std::string memory_text(double bytes);

/// Throws Error, "WHAT takes SIZE of memory, but there are only ...", if `bytes` exceeds the available memory. Requests
/// below 64 MiB are always granted and cost nothing.
void require_memory(double bytes, const SourceLocation& where, const std::string& what);

}  // namespace lanthorn
