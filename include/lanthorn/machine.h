// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The machine, and the resources that this process may use.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lanthorn {

/// A name and its value.
struct NamedText {
  std::string name, text;
};

/// Cores of one kind, on processors that have several: performance cores and efficiency cores.
struct CoreKind {
  std::string name;
  unsigned threads = 0;  ///< hardware threads
};

/// An empty text means unknown; nullopt means unknown or unlimited.
struct MachineInfo {
  std::string processor;
  std::vector<std::string> instruction_sets;  ///< only those that affect speed, by the kernel's names
  std::string compiled_for;                   ///< instruction set of the library: x86-64, x86-64-v2, -v3 or -v4
  unsigned cores = 0;                         ///< 0: unknown
  unsigned hardware_threads = 0;
  std::vector<CoreKind> core_kinds;               ///< empty if all cores are alike
  unsigned allowed_threads = 0;                   ///< hardware threads that the process may run on (CPU affinity)
  std::optional<double> cpu_quota;                ///< CPU seconds per second that control groups grant
  unsigned default_threads = 0;                   ///< number of render threads without --threads
  std::optional<std::uint64_t> memory;            ///< bytes, of the machine
  std::optional<std::uint64_t> memory_limit;      ///< bytes, of the control groups
  std::optional<std::uint64_t> memory_available;  ///< bytes that the process can still allocate
  std::vector<std::string> gpus;                  ///< those that drivers list in /proc or /sys
  std::vector<NamedText> libraries;               ///< versions
};

/// Inspects the machine. To report its version, loads the module that reads images; throws Error if that fails.
MachineInfo machine_info();

}  // namespace lanthorn
