// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "output_check.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "shards.h"

namespace lanthorn::program {

namespace {

namespace fs = std::filesystem;

constexpr mode_t any_write = 0222;

std::string named(const OutputFile& output) { return fmt::format("{} {}", output.option, output.path.string()); }

/// Identifies a file independently of its name.
struct Identity {
  dev_t device = 0;
  ino_t inode = 0;
  fs::path name;  ///< for a file that does not exist yet: its real folder and its name
  friend bool operator==(const Identity&, const Identity&) = default;
};

/// nullopt for devices, pipes and sockets: they hold nothing that could be lost.
std::optional<Identity> identity(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) {
    if (!S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) return std::nullopt;
    return Identity{status.st_dev, status.st_ino, {}};
  }
  std::error_code code;
  const fs::path target = follow_links(path);
  const fs::path folder = fs::weakly_canonical(fs::absolute(target, code).parent_path(), code);
  return Identity{0, 0, folder / target.filename()};
}

// True for a device name: it means the printed output, even if standard output is redirected to a file.
bool is_stream(const fs::path& path) {
  const std::string name = fs::absolute(path).lexically_normal().string();
  return name == "/dev/stdout" || name == "/dev/stderr" || name.starts_with("/dev/fd/") ||
         name.starts_with("/proc/self/fd/");
}

std::string list(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

void check_extension(const OutputFile& output) {
  constexpr std::array<std::string_view, 17> other_kinds{".exr",  ".png",  ".jpg", ".hdr",   ".pfm", ".tga",
                                                         ".tif",  ".tiff", ".svg", ".ply",   ".obj", ".mtl",
                                                         ".pbrt", ".gltf", ".glb", ".state", ".spd"};
  const std::string extension = output.path.extension().string();
  const auto& known = output.extensions;
  if (known.empty() && std::find(other_kinds.begin(), other_kinds.end(), extension) != other_kinds.end())
    throw Error(fmt::format("{}: expected a name that ends in .json", named(output)));
  if (!known.empty() && std::find(known.begin(), known.end(), extension) == known.end())
    throw Error(fmt::format("{}: expected a name that ends in {}", named(output), list(known)));
}

// Creates an unnamed file: permission bits alone do not reveal read-only file systems, or what the superuser may do.
bool can_write_to(const fs::path& folder) {
  const int file = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
  if (file >= 0) {
    ::close(file);
    return true;
  }
  if (errno == EACCES || errno == EPERM || errno == EROFS) return false;
  // Some file systems do not support unnamed files.
  const fs::path probe = folder / fmt::format(".lanthorn.{}.tmp", ::getpid());
  const int named_file = ::open(probe.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
  if (named_file < 0) return errno == EEXIST;
  ::close(named_file);
  ::unlink(probe.c_str());
  return true;
}

void check_place(const OutputFile& output, bool force) {
  struct stat status {};
  const bool exists = ::stat(output.path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode))
    throw Error(fmt::format("{}: is a folder; expected the name of a file", named(output)));
  if (exists && !S_ISREG(status.st_mode)) return;
  const fs::path target = follow_links(output.path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored))
    throw Error(fmt::format("{}: there is no folder {}", named(output), folder.string()));
  if (exists && (status.st_mode & any_write) == 0 && !force)
    throw Error(fmt::format("{}: exists and is write-protected; choose another name", named(output)));
  if (!can_write_to(folder))
    throw Error(fmt::format("{}: the folder {} is not writable", named(output), folder.string()));
}

void check_identities(const std::vector<InputFile>& inputs, const std::vector<OutputFile>& outputs) {
  std::vector<std::pair<const InputFile*, Identity>> read;
  for (const InputFile& input : inputs)
    if (const auto what = identity(input.path)) read.emplace_back(&input, *what);
  std::vector<std::pair<const OutputFile*, Identity>> written;
  for (const OutputFile& output : outputs) {
    const auto what = identity(output.path);
    if (!what || is_stream(output.path)) continue;
    const auto is_it = [&](const auto& other) { return other.second == *what; };
    const auto input = std::find_if(read.begin(), read.end(), is_it);
    if (input != read.end() && !output.may_be_input)
      throw Error(fmt::format("{}: is {}; choose another name", named(output), input->first->role));
    const auto other = std::find_if(written.begin(), written.end(), is_it);
    if (other != written.end() && !output.may_repeat)
      throw Error(fmt::format("{}: is also the file of {}", named(output), named(*other->first)));
    written.emplace_back(&output, *what);
  }
}

// The number of passes in `there` that are not in `written`.
std::uint64_t count_missing(const std::vector<PassRange>& there, const std::vector<PassRange>& written) {
  std::uint64_t count = 0;
  for (const PassRange& range : there)
    for (const PassRange& missing : check_passes(range, written).missing) count += missing.end - missing.begin;
  return count;
}

}  // namespace

bool same_file(const fs::path& a, const fs::path& b) {
  const auto one = identity(a), other = identity(b);
  return one && one == other;
}

std::vector<InputFile> files_of(const std::map<std::string, description::File>& read, const fs::path& scene_file) {
  std::vector<InputFile> files{{scene_file, "the scene file"}};
  for (const auto& [name, file] : read)
    files.push_back({file.path, fmt::format("{}, which the scene reads", fs::path(name).filename().string())});
  return files;
}

void check_outputs(const std::vector<InputFile>& inputs, const std::vector<OutputFile>& outputs, bool force) {
  check_identities(inputs, outputs);
  for (const OutputFile& output : outputs) {
    check_extension(output);
    check_place(output, force);
  }
}

void check_replaced_state(const fs::path& path, const RenderState& state, const std::vector<PassRange>& passes,
                          const char* how_to_keep) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return;
  constexpr const char* advice = "choose another name, or replace it with --force";
  std::shared_ptr<RenderState> there;
  try {
    there = open_state(path);
  } catch (const Error& error) {
    throw Error({path.string()}, fmt::format("exists and cannot be read ({}); {}", error.message, advice));
  }
  if (const auto difference = difference_to_replaced(*there, state))
    throw Error({path.string()}, fmt::format("holds another render: it differs in {}; {}", *difference, advice));
  const StateSummary summary = summarize(*there);
  if (const std::uint64_t lost = count_missing(summary.passes, passes))
    throw Error({path.string()}, fmt::format("holds {} passes of this render, of which {} would be lost; {}, {}",
                                             summary.pass_count, lost, how_to_keep, advice));
}

}  // namespace lanthorn::program
