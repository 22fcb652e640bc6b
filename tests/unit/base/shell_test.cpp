// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/shell.h"

#include <gtest/gtest.h>

namespace lanthorn::shell_test {
namespace {

TEST(ShellWord, QuotesWhatAShellWouldTakeApart) {
  EXPECT_EQ(shell_word("scenes/ring-2.pbrt"), "scenes/ring-2.pbrt");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("my scene.pbrt"), "'my scene.pbrt'");
  EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
}

}  // namespace
}  // namespace lanthorn::shell_test
