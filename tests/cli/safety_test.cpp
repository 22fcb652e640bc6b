// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Nothing is lost: what becomes of a render when messages or files cannot be written, and when signals come.
#include <gtest/gtest.h>

#include <string>

#include "cli_fixture.h"
#include "render/state.h"

namespace lanthorn {
namespace {

class Safety : public Cli {
 protected:
  /// Runs the program by way of the shell, for its redirections and limits. In `command`, L is the program; `exec L`
  /// lets signals reach it.
  static Words shell(const std::string& command) {
    return {"-c", "L() { exec '" LANTHORN_PROGRAM "' \"$@\"; }\n" + command};
  }
  Ending run_shell(const std::string& command) const {
    return ChildProcess("/bin/sh", shell(command), dir_.path()).wait();
  }
};

const std::string brief_render = "L render tiny.pbrt -i path -p 3 ";

TEST_F(Safety, MessagesThatCannotBeWrittenEndNoRender) {
  for (const std::string redirection : {"2>/dev/full", "2>&-", "2>&- >&-", "2>&- >&- <&-"}) {
    SCOPED_TRACE(redirection);
    const Ending ending = run_shell(brief_render + "-o a.exr -o a.state " + redirection);
    EXPECT_EQ(ending.exit_code, 0) << "signal " << ending.signal;
    ASSERT_EQ(files(), (Words{"a.exr", "a.state", "tiny.pbrt"}));
    // Were a closed standard error not opened on something else, messages would be written into the files.
    EXPECT_EQ(load_state(path("a.state")).pass_count(), 3u);
    fs::remove(path("a.exr"));
    fs::remove(path("a.state"));
  }
  // The warning and the error of other commands.
  EXPECT_EQ(run_shell("L render nosuch.pbrt 2>/dev/full").exit_code, 2);
  EXPECT_EQ(run_shell("L compare nosuch.exr a.exr 2>&-").exit_code, 2);
}

TEST_F(Safety, StandardOutputThatCannotBeWrittenIsAnError) {
  succeed(render({"-i", "path", "-p", "1", "-o", "a.exr"}));
  for (const std::string command :
       {"info tiny.pbrt", "info tiny.pbrt --json", "list", "list path", "compare a.exr a.exr", "--help", "--version",
        "compare a.exr a.exr --json -", "converge tiny.pbrt -i path -p 2 --runs 2", "render --help"})
    for (const std::string redirection : {" >/dev/full", " >&-"}) {
      const Ending ending = run_shell("L " + command + redirection);
      EXPECT_EQ(ending.exit_code, 2) << command << redirection << " signal " << ending.signal;
      EXPECT_TRUE(contains(ending.err, "standard output cannot be written: ")) << command << redirection << ending.err;
    }
}

TEST_F(Safety, RendersWhosePicturesAreWrittenDoNotFailForTheirClosingLine) {
  for (const std::string command : {"render tiny.pbrt -i path -p 2 -o a.exr -o a.state",
                                    "photons tiny.pbrt -n 300 -o a.ply", "merge a.state -o b.exr"}) {
    const Ending ending = run_shell("L " + command + " >/dev/full");
    EXPECT_EQ(ending.exit_code, 0) << command;
    EXPECT_TRUE(contains(ending.err, "warning: standard output cannot be written: ")) << ending.err;
  }
  EXPECT_EQ(files(), (Words{"a.exr", "a.ply", "a.state", "b.exr", "tiny.pbrt"}));
}

}  // namespace
}  // namespace lanthorn
