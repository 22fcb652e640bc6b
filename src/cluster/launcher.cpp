// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "cluster/launcher.h"

#include <charconv>
#include <cstring>

namespace lanthorn {

// Open MPI sets the first variable; MPICH, Intel MPI and srun --mpi=pmi2 the second; MVAPICH the third; srun the last.
// SLURM_NTASKS is not used because batch scripts, whose commands run once, also have it.
std::optional<Launcher> find_launcher(const std::function<const char*(const char*)>& variable) {
  for (const char* const name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE", "SLURM_STEP_NUM_TASKS"}) {
    const char* const text = variable(name);
    if (!text) continue;
    int size = 0;
    const auto [end, code] = std::from_chars(text, text + std::strlen(text), size);
    if (code == std::errc() && *end == 0 && size > 0) return Launcher{name, size};
  }
  return std::nullopt;
}

}  // namespace lanthorn
