// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace lanthorn {

/// Number of threads, at most `wanted`, that can be started besides this one; starts them briefly to find out. Less
/// than `wanted` if the system limits the threads of a user or a container, or if their stacks do not fit into memory.
unsigned startable_threads(unsigned wanted);

/// Number of threads that are left to the libraries behind images (image/image_codec.h), which start theirs when they
/// are loaded, and end the program if they cannot.
unsigned threads_of_image_libraries();

/// Number of hardware threads that this process may run on (CPU affinity).
unsigned allowed_threads();

/// Number of threads that use so many cores for as many CPU seconds a second as `quota` grants.
unsigned threads_for(unsigned cores, std::optional<double> quota);

/// Number of threads that keep this process's share of the machine busy: those that it may have, or fewer if a control
/// group (container) grants less CPU time; a share of a core counts as one.
unsigned usable_threads();

std::string version_of_tbb();

}  // namespace lanthorn
