// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lanthorn/machine.h"

namespace lanthorn {

/// Reads processor, memory, control group limits and GPUs from /proc and /sys below `root`.
MachineInfo machine_from_files(const std::filesystem::path& root);

}  // namespace lanthorn
