// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What the module lanthorn-mpi.so does, which alone links MPI.
#pragma once

#include <optional>

#include "lanthorn/team.h"

namespace lanthorn {

struct MpiFunctions {
  /// Starts MPI. Throws std::runtime_error.
  TeamLink (*join)();
  void (*leave)();
  void (*abort)(int exit_code);
};

/// The function of the module that returns these.
constexpr const char* mpi_functions_symbol = "lanthorn_mpi_functions";
using MpiFunctionsSymbol = const MpiFunctions* (*)();

}  // namespace lanthorn
