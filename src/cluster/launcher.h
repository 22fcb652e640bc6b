// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace lanthorn {

struct Launcher {
  std::string variable;  ///< the environment variable that shows the launcher
  int size = 1;          ///< number of processes that the launcher has started
};

/// Finds the MPI launcher that has started this process by environment variables. Returns nullopt if there is none.
/// `variable` returns the value of an environment variable, or null, as std::getenv does.
std::optional<Launcher> find_launcher(const std::function<const char*(const char*)>& variable);

}  // namespace lanthorn
