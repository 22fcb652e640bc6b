// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace lanthorn {

/// Number of threads, at most `wanted`, that can be started besides this one; determined by starting them briefly. Less
/// than `wanted` if the system limits the threads of a user or container, or if their stacks do not fit into memory.
unsigned startable_threads(unsigned wanted);

/// Number of threads and processes that opening the image codec (image/image_codec.h) is expected to need at a time;
/// left free for it where threads are scarce.
unsigned threads_of_image_libraries();

/// Number of hardware threads that this process may run on (CPU affinity).
unsigned allowed_threads();

/// Number of threads that use up to `cores` cores within a quota of `quota` CPU seconds per second.
unsigned threads_for(unsigned cores, std::optional<double> quota);

/// Number of threads that fully use this process's share of the machine: all allowed threads, or fewer if a control
/// group (container) grants less CPU time; a fraction of a core counts as one.
unsigned usable_threads();

std::string version_of_tbb();

}  // namespace lanthorn
