// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The functions of the module lanthorn-mpi.so. No other part of the program links MPI.
#pragma once

#include <optional>

#include "lanthorn/team.h"

namespace lanthorn {

struct MpiFunctions {
  /// Starts MPI. Throws std::runtime_error on failure.
  TeamLink (*join)();
  void (*leave)();
  void (*abort)(int exit_code);
};

/// The name of the module's function that returns the MpiFunctions.
constexpr const char* mpi_functions_symbol = "lanthorn_mpi_functions";
using MpiFunctionsSymbol = const MpiFunctions* (*)();

}  // namespace lanthorn
