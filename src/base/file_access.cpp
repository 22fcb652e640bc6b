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
  return Error({path.string()}, "no such file in the scene's folder; with --sandbox no others are read");
}

}  // namespace

bool is_lfs_pointer(const fs::path& path) {
  constexpr std::string_view beginning = "version https://git-lfs.github.com/spec/";
  constexpr std::uintmax_t largest = 1024;  // by Git LFS's specification
  std::error_code code;
  const std::uintmax_t size = fs::file_size(path, code);
  if (code || size < beginning.size() || size > largest) return false;
  std::string found(beginning.size(), '\0');
  std::ifstream(path, std::ios::binary).read(found.data(), static_cast<std::streamsize>(found.size()));
  return found == beginning;
}

namespace {

void refuse_lfs_pointer(const fs::path& path) {
  if (is_lfs_pointer(path))
    throw Error({path.string()}, "only a pointer of Git LFS is here; git lfs pull fetches the file");
}

}  // namespace

fs::path FileAccess::checked(const fs::path& path) const {
  // A zero byte would cut the name short where it is opened.
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

// The first of the folder's entries that are called `name` but for case.
std::optional<fs::path> entry_but_case(const fs::path& folder, const fs::path& name) {
  std::optional<fs::path> first;
  std::error_code code;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    const fs::path found = entry->path().filename();
    if (equal_but_case(found.string(), name.string()) && (!first || found < *first)) first = found;
  }
  return first;
}

bool is_absolute(const std::string& name) { return name.starts_with('/') || (name.size() > 1 && name[1] == ':'); }

}  // namespace

fs::path FileAccess::find(const fs::path& folder, const fs::path& name) const {
  const fs::path path = folder / name;
  if (!is_missing(path)) return path;
  fs::path found = folder;
  for (const fs::path& part : is_absolute(name.string()) ? name.filename() : name) {
    std::error_code code;
    if (is_sandboxed() && !lies_in(fs::canonical(found, code), sandbox)) return path;
    const bool is_there = fs::exists(found / part, code);
    found /= is_there ? part : entry_but_case(found, part).value_or(part);
  }
  return is_missing(found) ? path : found;
}

std::string FileAccess::read(const fs::path& path) const {
  const fs::path name = checked(path);
  if (!is_sandboxed()) return read_file(name);
  // Checked again on the opened file: it, or a folder above it, may have been replaced by a link since the first check.
  OpenedFile file = read_opened_file(name);
  if (!lies_in(file.real_path, sandbox)) throw no_such_file(path);
  return std::move(file.bytes);
}

}  // namespace lanthorn
