// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "base/machine.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/control_group.h"

namespace lanthorn {

namespace {

namespace fs = std::filesystem;

// x86 and ARM; from the oldest to the newest.
constexpr std::array<std::string_view, 12> fast_sets{"sse4_2",   "avx",      "f16c",  "fma",  "avx2", "avx512f",
                                                     "avx512vl", "avx512dq", "asimd", "fphp", "sve",  "sve2"};

// The x86-64 psABI level whose instructions this library may contain.
constexpr const char* compiled_for =
#if defined(__AVX512F__) && defined(__AVX512BW__) && defined(__AVX512CD__) && defined(__AVX512DQ__) && \
    defined(__AVX512VL__)
    "x86-64-v4";
#elif defined(__AVX2__) && defined(__BMI2__) && defined(__FMA__)
    "x86-64-v3";
#elif defined(__SSE4_2__)
    "x86-64-v2";
#elif defined(__x86_64__)
    "x86-64";
#else
    "";
#endif

std::string trimmed(const std::string& text) {
  constexpr const char* blanks = " \t";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == std::string::npos ? std::string() : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

// Parses a line "key : value".
std::optional<NamedText> named_text(const std::string& line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string::npos) return {};
  return NamedText{trimmed(line.substr(0, colon)), trimmed(line.substr(colon + 1))};
}

void read_flags(const std::string& text, std::vector<std::string>& sets) {
  std::istringstream words(text);
  const std::set<std::string> flags{std::istream_iterator<std::string>(words), {}};
  for (const std::string_view name : fast_sets)
    if (flags.contains(std::string(name))) sets.emplace_back(name);
}

void read_processor(const fs::path& root, MachineInfo& machine) {
  std::set<std::pair<std::string, std::string>> cores;  // socket and core number
  std::string socket;
  std::ifstream in(root / "proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const auto entry = named_text(line);
    if (!entry) continue;
    const auto& [name, text] = *entry;
    if (name == "processor") ++machine.hardware_threads;
    if (name == "model name" && machine.processor.empty()) machine.processor = text;
    if ((name == "flags" || name == "Features") && machine.instruction_sets.empty())
      read_flags(text, machine.instruction_sets);
    if (name == "physical id") socket = text;
    if (name == "core id") cores.emplace(socket, text);
  }
  machine.cores = static_cast<unsigned>(cores.size());
}

// The length of a list such as "0-7,16,18-19"; 0 for anything else.
unsigned length_of_list(const std::string& text) {
  unsigned count = 0;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    unsigned first = 0, last = 0;
    const char* const end = part.data() + part.size();
    const auto number = std::from_chars(part.data(), end, first);
    if (number.ec != std::errc()) return 0;
    last = first;
    if (number.ptr != end && *number.ptr == '-') std::from_chars(number.ptr + 1, end, last);
    if (last < first) return 0;
    count += last - first + 1;
  }
  return count;
}

std::string first_line(const fs::path& file) {
  std::string line;
  std::ifstream in(file);
  std::getline(in, line);
  return line;
}

// Intel's hybrid processors list the threads of each kind of core.
void read_core_kinds(const fs::path& root, MachineInfo& machine) {
  for (const auto& [folder, name] : {std::pair{"cpu_core", "performance"}, std::pair{"cpu_atom", "efficiency"}})
    if (const unsigned threads = length_of_list(first_line(root / "sys/devices" / folder / "cpus")))
      machine.core_kinds.push_back({name, threads});
}

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) entries.push_back(entry.path());
  std::sort(entries.begin(), entries.end());
  return entries;
}

// NVIDIA's driver reports a name; other drivers report vendor and device numbers.
void read_gpus(const fs::path& root, MachineInfo& machine) {
  for (const fs::path& gpu : sorted_entries(root / "proc/driver/nvidia/gpus")) {
    std::ifstream in(gpu / "information");
    for (std::string line; std::getline(in, line);)
      if (const auto entry = named_text(line); entry && entry->name == "Model") machine.gpus.push_back(entry->text);
  }
  for (const fs::path& card : sorted_entries(root / "sys/class/drm")) {
    const std::string name = card.filename().string();
    if (!name.starts_with("card") || name.find('-') != std::string::npos) continue;  // card0-HDMI-A-1 is a connector
    std::string driver, bus;
    std::ifstream in(card / "device/uevent");
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("DRIVER=")) driver = line.substr(7);
      if (line.starts_with("PCI_ID=")) bus = line.substr(7);
    }
    if (!driver.empty() && driver != "nvidia") machine.gpus.push_back(driver + (bus.empty() ? "" : " " + bus));
  }
}

}  // namespace

MachineInfo machine_from_files(const fs::path& root) {
  MachineInfo machine;
  machine.compiled_for = compiled_for;
  read_processor(root, machine);
  read_core_kinds(root, machine);
  read_gpus(root, machine);
  if (const auto kibibytes = find_number(root / "proc/meminfo", "MemTotal:")) machine.memory = *kibibytes * 1024;
  const GroupLimits limits = group_limits(root);
  machine.cpu_quota = limits.cores;
  machine.memory_limit = limits.memory;
  return machine;
}

}  // namespace lanthorn
