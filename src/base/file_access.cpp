// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/file_access.h"

#include <algorithm>
#include <fstream>
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

std::string FileAccess::read(const fs::path& path) const {
  const fs::path name = checked(path);
  if (!is_sandboxed()) return read_file(name);
  // Checked again on the opened file: it, or a folder above it, may have been replaced by a link since the first check.
  OpenedFile file = read_opened_file(name);
  if (!lies_in(file.real_path, sandbox)) throw no_such_file(path);
  return std::move(file.bytes);
}

}  // namespace lanthorn
