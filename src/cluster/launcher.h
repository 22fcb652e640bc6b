// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Detects MPI launchers (mpi.cpp).
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace lanthorn {

struct Launcher {
  std::string variable;  ///< the environment variable that indicates the launcher
  int size = 1;          ///< number of processes that the launcher has started
};

/// Detects, from environment variables, the MPI launcher that started this process; nullopt if there is none.
/// `variable` returns the value of an environment variable or null, as std::getenv does.
std::optional<Launcher> find_launcher(const std::function<const char*(const char*)>& variable);

}  // namespace lanthorn
