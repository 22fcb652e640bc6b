// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace lanthorn {

struct Launcher {
  std::string variable;  ///< of the environment, that told of it
  int size = 1;          ///< processes that it has started
};

/// The launcher of MPI that has started this process, by its environment; nothing if there is none. `variable`: as
/// std::getenv.
std::optional<Launcher> find_launcher(const std::function<const char*(const char*)>& variable);

}  // namespace lanthorn
