// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "machine_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "console.h"
#include "json_text.h"
#include "lanthorn/machine.h"

namespace lanthorn::program {

namespace {

std::string gibibytes(std::optional<std::uint64_t> bytes) {
  return bytes ? fmt::format("{:.1f} GiB", static_cast<double>(*bytes) / (1 << 30)) : "unknown";
}

std::string or_unknown(const std::string& text) { return text.empty() ? "unknown" : text; }

std::string cores_text(const MachineInfo& m) {
  std::string text = m.cores > 0 ? fmt::format("{}, ", m.cores) : "";
  text += fmt::format("{} hardware threads", m.hardware_threads);
  for (const CoreKind& kind : m.core_kinds) text += fmt::format(", {} of {} cores", kind.threads, kind.name);
  return text;
}

std::string threads_text(const MachineInfo& m) {
  return fmt::format("{} by default; CPU affinity allows {}, {}", m.default_threads, m.allowed_threads,
                     m.cpu_quota ? fmt::format("the control group grants the time of {:.4g} cores", *m.cpu_quota)
                                 : "no control group limits the time");
}

std::string memory_text(const MachineInfo& m) {
  return fmt::format(
      "{}, {} available; {}", gibibytes(m.memory), gibibytes(m.memory_available),
      m.memory_limit ? "the control group allows " + gibibytes(m.memory_limit) : "no control group limits it");
}

void print_table(const MachineInfo& m) {
  print("processor  {}\n", or_unknown(m.processor));
  print("sets       {}\n", or_unknown(fmt::format("{}", fmt::join(m.instruction_sets, " "))));
  print("compiled   for {}\n", or_unknown(m.compiled_for));
  print("cores      {}\n", cores_text(m));
  print("threads    {}\n", threads_text(m));
  print("memory     {}\n", memory_text(m));
  print("gpu        {}\n", m.gpus.empty() ? "none found" : fmt::format("{}", fmt::join(m.gpus, ", ")));
  for (const NamedText& library : m.libraries) print("{:<10} {}\n", "version", library.name + " " + library.text);
}

template <class Value>
nlohmann::json or_null(const std::optional<Value>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json machine_json(const MachineInfo& m) {
  nlohmann::json kinds = nlohmann::json::object(), libraries = nlohmann::json::object();
  for (const CoreKind& kind : m.core_kinds) kinds[kind.name] = kind.threads;
  for (const NamedText& library : m.libraries) libraries[library.name] = library.text;
  return {{"processor", m.processor},
          {"instruction_sets", m.instruction_sets},
          {"compiled_for", m.compiled_for},
          {"cores", m.cores > 0 ? nlohmann::json(m.cores) : nlohmann::json()},
          {"hardware_threads", m.hardware_threads},
          {"core_kinds", kinds},
          {"allowed_threads", m.allowed_threads},
          {"cpu_quota", or_null(m.cpu_quota)},
          {"default_threads", m.default_threads},
          {"memory_bytes",
           {{"machine", or_null(m.memory)},
            {"limit", or_null(m.memory_limit)},
            {"available", or_null(m.memory_available)}}},
          {"gpus", m.gpus},
          {"libraries", libraries}};
}

}  // namespace

void show_machine(bool as_json) {
  const MachineInfo machine = machine_info();
  if (as_json)
    print_text(report_text(machine_json(machine)));
  else
    print_table(machine);
}

}  // namespace lanthorn::program
