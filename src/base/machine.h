// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lanthorn/machine.h"

namespace lanthorn {

/// What /proc and /sys below `root` say of the processor, the memory, limits of control groups, and GPUs.
MachineInfo machine_from_files(const std::filesystem::path& root);

}  // namespace lanthorn
