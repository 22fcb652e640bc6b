// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>
#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "cluster/launcher.h"
#include "cluster/mpi_functions.h"
#include "lanthorn/error.h"

namespace lanthorn {

namespace {

#ifdef LANTHORN_MPI_MODULE
const MpiFunctions& load() {
  // RTLD_GLOBAL, because MPI's plug-ins look up MPI's symbols globally.
  void* const module = dlopen(LANTHORN_MPI_MODULE, RTLD_LAZY | RTLD_GLOBAL);
  void* const symbol = module != nullptr ? dlsym(module, mpi_functions_symbol) : nullptr;
  if (symbol == nullptr) throw Error(std::string("the module for MPI cannot be loaded: ") + dlerror());
  return *reinterpret_cast<MpiFunctionsSymbol>(symbol)();
}
#else
const MpiFunctions& load() {
  throw Error(
      "an MPI launcher has started several processes, but this program is built without MPI (-DLANTHORN_BUILD_MPI=ON)");
}
#endif

const MpiFunctions& functions() {
  static const MpiFunctions& loaded = load();
  return loaded;
}

}  // namespace

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

std::optional<TeamLink> join_mpi() {
  const auto launcher = find_launcher([](const char* name) { return std::getenv(name); });
  if (!launcher || launcher->size == 1) return std::nullopt;
  try {
    TeamLink link = functions().join();
    if (link.size > 1) return link;
  } catch (const std::runtime_error& problem) {
    throw Error(std::string("MPI does not start: ") + problem.what());
  }
  throw Error(
      fmt::format("{} indicates {} processes, but Open MPI finds only this one: each would render the whole picture; "
                  "start them with mpirun, or srun --mpi=pmix",
                  launcher->variable, launcher->size));
}

void leave_mpi() { functions().leave(); }

void abort_mpi(int exit_code) {
  functions().abort(exit_code);
  std::_Exit(exit_code);
}

}  // namespace lanthorn
