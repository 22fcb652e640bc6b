// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "base/scratch_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <filesystem>

#include "support/error_text.h"
#include "support/temporary_dir.h"

namespace lanthorn::scratch_file_test {
namespace {

using Bytes = std::array<std::byte, 4>;
constexpr Bytes some{std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}};

TEST(ScratchFile, HasNoNameAndGivesBackWhatWasWritten) {
  const test::TemporaryDir folder;
  ScratchFile file(folder.path());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  file.write(1000, some);
  Bytes read{};
  EXPECT_TRUE(file.read(1000, read));
  EXPECT_EQ(read, some);
  EXPECT_FALSE(file.read(1002, read));  // beyond the end
}

TEST(ScratchFile, NamesTheFolderWhenItCannotBeMadeOrWritten) {
  EXPECT_EQ(test::error_text([] { ScratchFile("/no/such/folder"); }),
            "/no/such/folder: cannot create a temporary file here: No such file or directory; set TMPDIR to another "
            "folder");
  const test::TemporaryDir folder;
  ScratchFile file(folder.path());
  // Simulates a full disk.
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{1 << 16, before.rlim_max};
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string problem = test::error_text([&] { file.write(1 << 16, some); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(problem, folder.path().string() +
                         ": a temporary file cannot be written: File too large; set TMPDIR to another folder");
}

}  // namespace
}  // namespace lanthorn::scratch_file_test
