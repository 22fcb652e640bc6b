// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/text.h"

#include <gtest/gtest.h>

namespace lanthorn::shell_test {
namespace {

TEST(ShellWord, QuotesWhatAShellWouldTakeApart) {
  EXPECT_EQ(shell_word("scenes/ring-2.pbrt"), "scenes/ring-2.pbrt");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("my scene.pbrt"), "'my scene.pbrt'");
  EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(shell_word("caf\u00e9 1.pbrt"), "'caf\u00e9 1.pbrt'");
}

TEST(ShellWord, LeavesNothingThatATerminalObeys) {
  EXPECT_EQ(shell_word("a\nreboot\n"), "$'a\\012reboot\\012'");
  EXPECT_EQ(shell_word("\x1b[31m\xc2\x9b\x7f"), "$'\\033[31m\\302\\233\\177'");
  EXPECT_EQ(shell_word("it's\\n\t"), "$'it\\'s\\\\n\\011'");
}

}  // namespace
}  // namespace lanthorn::shell_test
