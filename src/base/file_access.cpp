// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/file_access.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/text.h"

namespace lanthorn {

namespace fs = std::filesystem;

namespace {

bool lies_in(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

Error no_such_file(const fs::path& path) {
  return Error({path.string()}, "no such file in the scene's folder; --sandbox allows no others");
}

}  // namespace

bool is_lfs_pointer(const fs::path& path) {
  constexpr std::string_view beginning = "version https://git-lfs.github.com/spec/";
  constexpr std::uintmax_t largest = 1024;  // according to Git LFS's specification
  std::error_code code;
  const std::uintmax_t size = fs::file_size(path, code);
  if (code || size < beginning.size() || size > largest) return false;
  std::string found(beginning.size(), '\0');
  std::ifstream(path, std::ios::binary).read(found.data(), static_cast<std::streamsize>(found.size()));
  return found == beginning;
}

namespace {

void refuse_lfs_pointer(const fs::path& path) {
  if (is_lfs_pointer(path)) throw Error({path.string()}, "only a Git LFS pointer; git lfs pull fetches the file");
}

}  // namespace

fs::path FileAccess::checked(const fs::path& path) const {
  // A zero byte would truncate the name when the file is opened.
  if (path.native().find('\0') != std::string::npos) throw Error({printable(path.string())}, "no such file");
  std::error_code code;
  if (is_sandboxed()) {
    fs::path real = fs::canonical(path, code);
    if (code || !lies_in(real, sandbox) || !fs::is_regular_file(real, code)) throw no_such_file(path);
    refuse_lfs_pointer(real);
    return real;
  }
  if (!fs::exists(path, code)) throw Error({path.string()}, "no such file");
  if (!fs::is_regular_file(path, code)) throw Error({path.string()}, "not a regular file");
  refuse_lfs_pointer(path);
  return path;
}

bool FileAccess::is_missing(const fs::path& path) const {
  try {
    checked(path);
    return false;
  } catch (const Error&) {
    return true;
  }
}

namespace {

bool equal_but_case(const std::string& a, const std::string& b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return lower(x) == lower(y); });
}

// The first of the folder's entries that equals `name` except for case.
std::optional<fs::path> entry_but_case(const fs::path& folder, const fs::path& name) {
  std::optional<fs::path> first;
  std::error_code code;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    const fs::path found = entry->path().filename();
    if (equal_but_case(found.string(), name.string()) && (!first || found < *first)) first = found;
  }
  return first;
}

// Replaces backslashes by slashes.
fs::path with_slashes(const fs::path& name) {
  std::string text = name.string();
  std::replace(text.begin(), text.end(), '\\', '/');
  return text;
}

// True for names that lead out of the scene's folder: they refer to the machine on which the scene was made.
bool leads_outside(const fs::path& name) {
  const std::string text = name.string();
  return text.starts_with('/') || text.starts_with("../") || (text.size() > 1 && text[1] == ':');
}

// Possible locations of a scene's file, relative to its folder, the most likely first.
std::vector<fs::path> likely_names(const fs::path& name) {
  const fs::path named = with_slashes(name);
  std::vector<fs::path> names;
  if (!named.is_absolute()) names.push_back(named);
  const std::vector<fs::path> parts(named.begin(), named.end());
  for (std::size_t first = 1; leads_outside(named) && first < parts.size(); ++first) {
    fs::path end;
    for (std::size_t i = first; i < parts.size(); ++i) end /= parts[i];
    names.push_back(end);
  }
  for (const char* usual : {"textures", "../textures"}) names.push_back(usual / named.filename());
  return names;
}

// `name` in `folder`, with parts matched regardless of case. It may not exist.
fs::path but_case(const fs::path& folder, const fs::path& name, const FileAccess& access) {
  fs::path found = folder;
  for (const fs::path& part : name) {
    std::error_code code;
    if (access.is_sandboxed() && !lies_in(fs::canonical(found, code), access.sandbox)) return folder / name;
    const bool is_there = fs::exists(found / part, code);
    found /= is_there ? part : entry_but_case(found, part).value_or(part);
  }
  return found;
}

}  // namespace

fs::path FileAccess::find(const fs::path& folder, const fs::path& name) const {
  const fs::path path = folder / name;
  if (!is_missing(path) || name.empty()) return path;
  for (const fs::path& likely : likely_names(name))
    if (const fs::path found = but_case(folder, likely, *this); !is_missing(found)) return found;
  return path;
}

std::string FileAccess::read(const fs::path& path) const {
  const fs::path name = checked(path);
  if (!is_sandboxed()) return read_file(name);
  // Checked again on the opened file: it, or a folder above it, may have been replaced by a link since the first check.
  OpenedFile file = read_opened_file(name);
  if (!lies_in(file.real_path, sandbox)) throw no_such_file(path);
  return std::move(file.bytes);
}

std::shared_ptr<std::FILE> FileAccess::open(const fs::path& path) const {
  OpenedStream stream = open_stream(checked(path));
  if (is_sandboxed() && !lies_in(stream.real_path, sandbox)) throw no_such_file(path);
  return std::move(stream.file);
}

}  // namespace lanthorn
