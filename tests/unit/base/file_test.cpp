// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Files are written whole or not at all; a replaced file keeps its permissions and links.
#include "lanthorn/file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <span>
#include <vector>

#include "lanthorn/error.h"
#include "support/temporary_dir.h"

namespace lanthorn::file_test {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) { write_file(path, std::as_bytes(std::span(text))); }

mode_t mode_of(const fs::path& path) {
  struct stat status {};
  EXPECT_EQ(stat(path.c_str(), &status), 0) << path;
  return status.st_mode & 07777;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(WriteFile, KeepsTheModeOfWhatItReplaces) {
  const test::TemporaryDir dir;
  const fs::path file = dir.path() / "a";
  const mode_t mask = umask(022);
  write(file, "new");
  EXPECT_EQ(mode_of(file), 0644u);
  for (const mode_t mode : {0600u, 0640u, 0666u, 0444u}) {
    chmod(file.c_str(), mode);
    write(file, "replaced");
    EXPECT_EQ(mode_of(file), mode);
    EXPECT_EQ(read_file(file), "replaced");
  }
  umask(mask);
}

TEST(WriteFile, KeepsOwnerAndGroupWherePermitted) {
  if (geteuid() != 0) GTEST_SKIP() << "only root may give files away";
  const test::TemporaryDir dir;
  const fs::path file = dir.write("a", "old");
  ASSERT_EQ(chown(file.c_str(), 1234, 4321), 0);
  write(file, "new");
  struct stat status {};
  ASSERT_EQ(stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, 1234u);
  EXPECT_EQ(status.st_gid, 4321u);
}

TEST(WriteFile, LinksStayLinks) {
  const test::TemporaryDir dir;
  const fs::path link = dir.path() / "link", chain = dir.path() / "chain", target = dir.path() / "there" / "target";
  fs::create_directory(target.parent_path());
  fs::create_symlink("there/target", link);  // its target does not exist yet
  fs::create_symlink("link", chain);
  for (const std::string text : {"first", "second"}) {
    write(chain, text);
    EXPECT_TRUE(fs::is_symlink(chain) && fs::is_symlink(link));
    EXPECT_FALSE(fs::is_symlink(fs::symlink_status(target)));
    EXPECT_EQ(read_file(target), text);
  }
  EXPECT_EQ(names_in(target.parent_path()), std::vector<std::string>{"target"});
  fs::create_symlink("circle", dir.path() / "circle");
  EXPECT_THROW(write(dir.path() / "circle", "text"), Error);
}

TEST(WriteFile, RemovesWhatDeadProcessesLeftBehindAndNothingElse) {
  const test::TemporaryDir dir;
  const std::vector<std::string> others{"a.0123456789abcdef.tmp.exr", "a.012.tmp", "a.backup.tmp",
                                        "a.exr.0123456789ABCDEF.tmp", "b.exr.0123456789abcdef.tmp"};
  for (const std::string& name : others) dir.write(name, "kept");
  dir.write("a.exr.0123456789abcdef.tmp", "of a process that was killed");
  const fs::path living = dir.write("a.exr.fedcba9876543210.tmp", "of a living process");
  const int descriptor = open(living.c_str(), O_WRONLY);
  ASSERT_EQ(flock(descriptor, LOCK_EX), 0);
  write(dir.path() / "a.exr", "whole");
  std::vector<std::string> expected = others;
  expected.insert(expected.end(), {"a.exr", living.filename().string()});
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(names_in(dir.path()), expected);
  close(descriptor);
}

TEST(WriteFile, LongNamesHaveTemporaryNamesToo) {
  const test::TemporaryDir dir;
  const fs::path file = dir.path() / std::string(255, 'a');
  write(file, "text");
  EXPECT_EQ(read_file(file), "text");
}

TEST(WritePrivateFile, MakesNewFilesThatOnlyTheUserCanRead) {
  const test::TemporaryDir dir;
  const std::string text = "rescued";
  const auto bytes = std::as_bytes(std::span(text));
  const fs::path first = write_private_file(dir.path(), "a.rescue-", ".state", bytes);
  const fs::path second = write_private_file(dir.path(), "a.rescue-", ".state", bytes);
  EXPECT_NE(first, second);
  EXPECT_EQ(first.filename().string().size(), std::string("a.rescue-.state").size() + 16);
  EXPECT_EQ(mode_of(first), 0600u);
  EXPECT_EQ(read_file(first), text);
  EXPECT_THROW(write_private_file(dir.path() / "nosuch", "a", "b", bytes), Error);
  EXPECT_EQ(names_in(dir.path()).size(), 2u);
}

}  // namespace
}  // namespace lanthorn::file_test
