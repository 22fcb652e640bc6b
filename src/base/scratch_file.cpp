// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "base/scratch_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

#include "lanthorn/error.h"

namespace lanthorn {

namespace fs = std::filesystem;

namespace {

constexpr const char* another_folder = "set TMPDIR to another folder";

std::string reason(int code) { return std::generic_category().message(code); }

// Some file systems do not support unnamed files: there the name is removed immediately.
int open_nameless(const fs::path& folder) {
  const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != ENOENT)) return file;
  std::string name = (folder / "lanthorn.XXXXXX").string();
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

}  // namespace

fs::path scratch_folder() {
  const fs::path in_memory_on_some_systems = "/tmp", on_disk = "/var/tmp";
  std::error_code code;
  const fs::path folder = fs::temp_directory_path(code);
  const bool is_default = code || folder == in_memory_on_some_systems;
  return is_default && ::access(on_disk.c_str(), W_OK) == 0 ? on_disk : folder;
}

ScratchFile::ScratchFile(fs::path folder) : folder_(std::move(folder)), descriptor_(open_nameless(folder_)) {
  if (descriptor_ < 0)
    throw Error({folder_.string()},
                fmt::format("cannot create a temporary file here: {}; {}", reason(errno), another_folder));
}

ScratchFile::~ScratchFile() { ::close(descriptor_); }

void ScratchFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0)
      throw Error({folder_.string()}, fmt::format("a temporary file cannot be written: {}; {}",
                                                  reason(written < 0 ? errno : EIO), another_folder));
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

bool ScratchFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t got = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
  return true;
}

std::uint64_t free_space(const fs::path& folder) {
  std::error_code code;
  const fs::space_info space = fs::space(folder, code);
  return code ? ~std::uint64_t{0} : static_cast<std::uint64_t>(space.available);
}

}  // namespace lanthorn
