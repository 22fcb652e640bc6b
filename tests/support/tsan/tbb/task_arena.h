// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <thread>

namespace tbb::this_task_arena {

inline int max_concurrency() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

}  // namespace tbb::this_task_arena
