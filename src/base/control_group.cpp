// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "base/control_group.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace lanthorn {

namespace {

namespace fs = std::filesystem;

template <class Number>
std::optional<Number> read_number(const fs::path& file) {
  Number value = 0;
  if (std::ifstream in(file); in >> value) return value;
  return {};  // also for "max"
}

template <class Number>
void tighten(std::optional<Number>& limit, std::optional<Number> other) {
  if (other) limit = std::min(*other, limit.value_or(*other));
}

// A mounted hierarchy of control groups, and this process's group in it.
struct Hierarchy {
  bool unified = false;  // version 2
  fs::path mount, group;
};

bool has_word(std::string_view list, std::string_view word) {
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    if (list.substr(begin, end - begin) == word) return true;
    begin = end + 1;
  }
  return false;
}

// The kernel writes spaces and backslashes in paths as octal escapes.
std::string unescaped(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '\\' && i + 3 < text.size();
    plain +=
        escape ? static_cast<char>((text[i + 1] - '0') * 64 + (text[i + 2] - '0') * 8 + text[i + 3] - '0') : text[i];
    if (escape) i += 3;
  }
  return plain;
}

// The path of this process's group in the hierarchy that has `controller`, or in the hierarchy of version 2 if
// `controller` is empty. Parses lines "4:cpu,cpuacct:/path" and "0::/path".
std::optional<std::string> group_path(const fs::path& root, std::string_view controller) {
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (controller.empty() ? controllers.empty() : has_word(controllers, controller)) return line.substr(second + 1);
  }
  return {};
}

// The path relative to the mounted folder. In a container the mount may start at the process's own group, or the path
// may lead outside the mount: then only the mount point is visible.
fs::path below_mount(const fs::path& path, const fs::path& mounted) {
  const fs::path below = path.lexically_relative(mounted);
  return below.empty() || *below.begin() == ".." || below == "." ? fs::path() : below;
}

// Parses lines of mountinfo: id, parent, device, mounted folder, mount point, options ..., "-", type, source, options.
std::vector<Hierarchy> hierarchies_with(const fs::path& root, std::string_view controller) {
  std::vector<Hierarchy> found;
  std::ifstream in(root / "proc/self/mountinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t dash = line.find(" - ");
    if (dash == std::string::npos) continue;
    std::istringstream before(line.substr(0, dash)), after(line.substr(dash + 3));
    std::string skipped, mounted, point, type, options;
    before >> skipped >> skipped >> skipped >> mounted >> point;
    after >> type >> skipped >> options;
    const bool unified = type == "cgroup2";
    if (!unified && !(type == "cgroup" && has_word(options, controller))) continue;
    if (const auto path = group_path(root, unified ? std::string_view() : controller)) {
      const fs::path mount = root / fs::path(unescaped(point)).relative_path();
      found.push_back({unified, mount, mount / below_mount(*path, unescaped(mounted))});
    }
  }
  return found;
}

// Calls `visit(folder, unified)` for the process's group and its visible ancestors.
template <class Visit>
void visit_groups(const fs::path& root, std::string_view controller, Visit&& visit) {
  for (const Hierarchy& h : hierarchies_with(root, controller))
    for (fs::path group = h.group;; group = group.parent_path()) {
      visit(group, h.unified);
      if (group == h.mount || !group.has_relative_path()) break;
    }
}

std::optional<double> cores_of(const fs::path& group, bool unified) {
  double quota = 0, period = 0;
  if (unified) {
    if (std::ifstream in(group / "cpu.max"); !(in >> quota >> period)) return {};  // also for "max"
  } else {
    quota = read_number<double>(group / "cpu.cfs_quota_us").value_or(-1);  // -1 means no limit
    period = read_number<double>(group / "cpu.cfs_period_us").value_or(0);
  }
  if (!(quota > 0 && period > 0)) return {};
  return quota / period;
}

struct MemoryFiles {
  const char *limit, *used, *cached;
};

constexpr MemoryFiles memory_v1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"};
constexpr MemoryFiles memory_v2{"memory.max", "memory.current", "inactive_file"};

void add_memory(const fs::path& group, bool unified, GroupLimits& limits) {
  const MemoryFiles& files = unified ? memory_v2 : memory_v1;
  const auto most = read_number<std::uint64_t>(group / files.limit);
  constexpr std::uint64_t none = std::uint64_t{1} << 62;  // version 1 reports a huge number for no limit
  if (!most || *most >= none) return;
  tighten(limits.memory, most);
  const auto used = read_number<std::uint64_t>(group / files.used);
  if (!used) return;
  const std::uint64_t held = *used - std::min(*used, find_number(group / "memory.stat", files.cached).value_or(0));
  tighten(limits.memory_left, std::optional(*most - std::min(*most, held)));
}

}  // namespace

std::optional<std::uint64_t> find_number(const fs::path& file, std::string_view key) {
  std::ifstream in(file);
  for (std::string name; in >> name; in.ignore(std::numeric_limits<std::streamsize>::max(), '\n')) {
    std::uint64_t value = 0;
    if (name == key && in >> value) return value;
  }
  return {};
}

GroupLimits group_limits(const fs::path& root) {
  GroupLimits limits;
  visit_groups(root, "cpu",
               [&](const fs::path& group, bool unified) { tighten(limits.cores, cores_of(group, unified)); });
  visit_groups(root, "memory", [&](const fs::path& group, bool unified) { add_memory(group, unified, limits); });
  return limits;
}

}  // namespace lanthorn
