// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// No render is lost when messages or files cannot be written, or when signals arrive.
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "cli_fixture.h"
#include "render/state.h"

namespace lanthorn::safety_test {
namespace {

class Safety : public Cli {
 protected:
  ChildProcess start(const Words& words) const { return {LANTHORN_PROGRAM, words, dir_.path()}; }

  /// A render that runs until a signal arrives; `more` begins with its resolution.
  static Words endless(const Words& more) {
    return Words{"render", "tiny.pbrt", "-i", "path", "--time", "10m", "--reproducible", "-r"} + more;
  }
  /// Like `endless`, but with passes of a second or more on one thread; `more` begins with the number of mutations.
  static Words slow(const Words& more) {
    return Words{"render", "tiny.pbrt", "-i", "mlt", "-T", "1", "--reproducible", "-n"} + more;
  }
  /// Waits until the program has printed the text.
  static void await(ChildProcess& child, const std::string& text) {
    while (!contains(child.err_so_far(), text) && !child.has_ended())
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_TRUE(contains(child.err_so_far(), text)) << text << " instead of " << child.err_so_far();
  }
  Words rescue_files(const std::string& folder = "") const {
    Words names;
    for (const std::string& name : files())
      if (name.starts_with(folder) && contains(name, ".rescue-")) names.push_back(name);
    return names;
  }
};

const std::vector<int> handled_signals{SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ, SIGXCPU, SIGUSR1, SIGUSR2};

const std::string brief_render = "L render tiny.pbrt -i path -p 3 ";

TEST_F(Safety, MessagesThatCannotBeWrittenEndNoRender) {
  for (const std::string redirection : {"2>/dev/full", "2>&-", "2>&- >&-", "2>&- >&- <&-"}) {
    SCOPED_TRACE(redirection);
    const Ending ending = run_shell(brief_render + "-o a.exr -o a.state " + redirection);
    EXPECT_EQ(ending.exit_code, 0) << "signal " << ending.signal;
    ASSERT_EQ(files(), (Words{"a.exr", "a.state", "tiny.pbrt"}));
    // If a closed standard error were not opened on /dev/null, messages would be written into the files.
    EXPECT_EQ(load_state(path("a.state")).pass_count(), 3u);
    fs::remove(path("a.exr"));
    fs::remove(path("a.state"));
  }
  // The warnings and errors of other commands.
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

TEST_F(Safety, EverySignalIsAcknowledgedAndSavesTheRender) {
  for (const int signal : handled_signals) {
    SCOPED_TRACE(signal);
    ChildProcess child = start(endless({"64x64", "-o", "a.exr", "-o", "a.state"}));
    await(child, "pass 1");
    child.send(signal);
    await(child, "finishing this pass, then saving");
    const Ending ending = child.wait();
    EXPECT_EQ(ending.exit_code, 0) << "signal " << ending.signal << ending.err;
    ASSERT_EQ(files(), (Words{"a.exr", "a.state", "tiny.pbrt"}));
    EXPECT_GE(load_state(path("a.state")).pass_count(), 1u);
    fs::remove(path("a.exr"));
    fs::remove(path("a.state"));
  }
}

TEST_F(Safety, ASecondSignalDropsThePassAndLeavesNoTraceOfIt) {
  ChildProcess child = start(slow({"1500000", "-p", "1000", "-o", "a.state"}));
  await(child, "pass 1/1000");
  child.send(SIGINT);
  await(child, "finishing this pass, then saving");
  child.send(SIGHUP);
  await(child, "abandoning this pass, then saving");
  const Ending ending = child.wait();
  EXPECT_EQ(ending.exit_code, 0) << "signal " << ending.signal << ending.err;
  const std::uint64_t passes = load_state(path("a.state")).pass_count();
  ASSERT_EQ(passes, 1u) << "the second pass was too short for this test";
  succeed(slow({"1500000", "-p", "1", "-o", "b.state", "-q"}));
  expect_equal_files("a.state", "b.state");
  // The same for a resumed render: its first pass can also be abandoned.
  ChildProcess resumed = start(slow({"1500000", "-p", "1000", "--resume", "a.state", "-o", "c.state"}));
  await(resumed, "checkpoint every");
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  resumed.send(SIGINT);
  await(resumed, "finishing this pass");
  resumed.send(SIGINT);
  EXPECT_EQ(resumed.wait().exit_code, 0);
  expect_equal_files("a.state", "c.state");
}

TEST_F(Safety, AnInterruptedRenderReplacesNoStateOfMorePasses) {
  const Words words{"render", "tiny.pbrt", "-i", "path", "--reproducible", "-r", "64x64", "-o", "a.state", "-p"};
  succeed(words + Words{"400"});
  const std::string before = bytes("a.state");
  ChildProcess child = start(words + Words{"1000000"});
  await(child, "pass 1/");
  child.send(SIGINT);
  const Ending ending = child.wait();
  EXPECT_EQ(ending.exit_code, 2) << "signal " << ending.signal;
  EXPECT_TRUE(contains(ending.err, "a.state: ") && contains(ending.err, "The render is saved in ")) << ending.err;
  EXPECT_TRUE(bytes("a.state") == before);
  EXPECT_EQ(rescue_files().size(), 1u);
  // A checkpoint would replace it immediately.
  EXPECT_EQ(run(words + Words{"1000000", "--checkpoint", "1"}).exit_code, 2);
  EXPECT_TRUE(bytes("a.state") == before);
}

TEST_F(Safety, WithoutAPassThereIsNothingToSave) {
  ChildProcess child = start(slow({"30000000", "-p", "1000", "-o", "a.state"}));
  await(child, "checkpoint every");
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  child.send(SIGTERM);
  await(child, "finishing this pass");
  child.send(SIGTERM);
  const Ending ending = child.wait();
  EXPECT_EQ(ending.signal, SIGTERM);
  EXPECT_TRUE(contains(ending.err, "no pass was rendered: nothing to save")) << ending.err;
  EXPECT_EQ(files(), Words{"tiny.pbrt"});
}

TEST_F(Safety, AThirdSignalEndsTheProgram) {
  ChildProcess child = start(endless({"400x400", "-o", "a.state"}));
  await(child, "pass 1");
  for (const int signal : {SIGHUP, SIGINT, SIGTERM}) child.send(signal);
  const Ending ending = child.wait();
  EXPECT_FALSE(ending.exit_code) << ending.err;
  EXPECT_TRUE(contains(ending.err, "ended without saving")) << ending.err;
  EXPECT_EQ(files(), Words{"tiny.pbrt"});
}

TEST_F(Safety, SignalsWhileTheSceneIsLoadedEndTheProgramAndSaySo) {
  std::ofstream scene(path("large.pbrt"));
  scene << tiny_scene;
  for (int i = 0; i < 300'000; ++i)
    scene << R"(Shape "sphere" "float radius" [0.001]
)";
  scene.close();
  ChildProcess child = start({"render", "large.pbrt", "-o", "a.exr"});
  const auto catches_signals = [&] {
    const std::string status = file_bytes("/proc/" + std::to_string(child.pid()) + "/status");
    const std::size_t at = status.find("SigCgt:");
    return at != std::string::npos && (std::stoull(status.substr(at + 7), nullptr, 16) >> (SIGTERM - 1) & 1) != 0;
  };
  while (!catches_signals() && !child.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  child.send(SIGTERM);
  const Ending ending = child.wait();
  EXPECT_EQ(ending.signal, SIGTERM);
  EXPECT_TRUE(contains(ending.err, "nothing is rendered yet")) << ending.err;
}

TEST_F(Safety, IgnoredSignalsStayIgnored) {
  ChildProcess child("/bin/sh", shell("trap '' HUP; L render tiny.pbrt -i path -r 64x64 --time 1s -o a.exr"),
                     dir_.path());
  await(child, "pass 1");
  child.send(SIGHUP);
  const Ending ending = child.wait();
  EXPECT_EQ(ending.exit_code, 0) << "signal " << ending.signal;
  EXPECT_FALSE(contains(ending.err, "finishing")) << ending.err;
}

TEST_F(Safety, MessagesToAClosedPipeSaveTheRender) {
  run_shell("{ '" LANTHORN_PROGRAM
            "' render tiny.pbrt -i path -r 64x64 --time 10m -o a.exr -o a.state; echo $? >code; } 2>&1 | :");
  EXPECT_EQ(bytes("code"), "0\n");
  EXPECT_EQ(files(), (Words{"a.exr", "a.state", "code", "tiny.pbrt"}));
}

TEST_F(Safety, ConvergeShowsProgressAndKeepsWhatItHas) {
  const Words converge{"converge", "tiny.pbrt", "-i",         "path", "-r",     "32x32",
                       "-p",       "16",        "--fit-from", "1",    "--runs", "200"};
  ChildProcess child = start(converge + Words{"--json", "c.json", "--plot", "c.svg"});
  await(child, "render 1/200  pass 1/16");
  // Two more progress lines: a fifth of the renders, or twenty seconds.
  const auto lines = [&] {
    const std::string said = child.err_so_far();
    return std::count(said.begin(), said.end(), '%');
  };
  while (lines() < 3 && !child.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  child.send(SIGINT);
  const Ending ending = child.wait();
  EXPECT_EQ(ending.exit_code, 0) << "signal " << ending.signal << ending.err;
  EXPECT_TRUE(contains(ending.err, "ending with the complete renders")) << ending.err;
  EXPECT_TRUE(contains(ending.out, "variance ~ passes^")) << ending.out;
  const std::uint64_t runs = json("c.json").value("runs", std::uint64_t{0});
  ASSERT_GE(runs, 2u);
  EXPECT_LT(runs, 200u);
  EXPECT_TRUE(fs::exists(path("c.svg")));
  // The results equal those of the same number of complete renders.
  succeed({"converge", "tiny.pbrt", "-i", "path", "-r", "32x32", "-p", "16", "--fit-from", "1", "--runs",
           std::to_string(runs), "--json", "d.json", "-q"});
  expect_equal_files("c.json", "d.json");

  ChildProcess early = start({"converge", "tiny.pbrt", "-i", "path", "-p", "4000000000"});
  await(early, "render 1/50  pass 1/");
  early.send(SIGTERM);
  const Ending nothing = early.wait();
  EXPECT_EQ(nothing.signal, SIGTERM);
  EXPECT_TRUE(contains(nothing.err, "0 of 50 renders complete: too early")) << nothing.err;
}

TEST_F(Safety, AnOutputThatFailsDropsNoOther) {
  fs::create_symlink("/dev/full", path("full.exr"));
  fs::create_symlink("/dev/full", path("full.png"));
  const Ending ending = run(render({"-i", "path", "-p", "2", "-o", "full.exr", "-o", "a.png", "-o", "full.png", "-o",
                                    "a.state", "--json", "a.json"}));
  EXPECT_EQ(ending.exit_code, 2);
  EXPECT_TRUE(contains(ending.err, "full.exr: ") && contains(ending.err, "full.png: ")) << ending.err;
  EXPECT_TRUE(contains(ending.err, "The render is saved in a.state")) << ending.err;
  EXPECT_EQ(files(), (Words{"a.json", "a.png", "a.state", "full.exr", "full.png", "tiny.pbrt"}));
}

TEST_F(Safety, OutputsThatFailDropNoOtherOfCompareAndConverge) {
  fs::create_symlink("/dev/full", path("full.json"));
  succeed(render({"-i", "path", "-p", "1", "-o", "a.exr"}));
  const std::string compare = "compare a.exr a.exr --json ",
                    converge = "converge tiny.pbrt -i path -p 1 --runs 2 --json ";
  for (const std::string& command :
       {compare + "full.json --diff d.png >table", compare + "c.json --diff d.png >/dev/full",
        converge + "full.json --plot c.svg >table", converge + "c.json --plot c.svg >/dev/full"}) {
    SCOPED_TRACE(command);
    const Words before = files();
    const Ending ending = run_shell("L " + command);
    EXPECT_EQ(ending.exit_code, 2) << ending.err;
    EXPECT_TRUE(contains(ending.err, "full.json: ") || contains(ending.err, "standard output")) << ending.err;
    Words written;
    for (const std::string& name : files())
      if (std::find(before.begin(), before.end(), name) == before.end() && fs::file_size(path(name)) > 0)
        written.push_back(name);
    EXPECT_EQ(written.size(), 2u) << testing::PrintToString(written);
    for (const std::string& name : written) fs::remove(path(name));
  }
}

TEST_F(Safety, TheRescueFileIsPrivateAndCannotBeGuessed) {
  fs::create_symlink("/dev/full", path("full.exr"));
  Words names;
  for (int i = 0; i < 2; ++i) {
    const Ending ending = run(render({"-i", "path", "-p", "2", "-o", "full.exr"}));
    EXPECT_EQ(ending.exit_code, 2);
    names = rescue_files();
    ASSERT_EQ(names.size(), static_cast<std::size_t>(i + 1)) << ending.err;
  }
  for (const std::string& name : names) {
    EXPECT_TRUE(name.starts_with("full.rescue-") && name.ends_with(".state"));
    struct stat status {};
    ASSERT_EQ(stat(path(name).c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777, 0600u);
  }
  succeed(render({"-i", "path", "-p", "4", "--resume", names.front(), "-o", "b.exr"}));
  succeed(render({"-i", "path", "-p", "4", "-o", "c.exr"}));
  expect_equal_files("b.exr", "c.exr");
}

// A render whose output folder is removed while it runs.
class VanishingFolder : public Safety {
 protected:
  VanishingFolder() { fs::create_directory(path("sub")); }
  std::unique_ptr<ChildProcess> start_and_remove_folder(const std::string& state_home) const {
    auto child = std::make_unique<ChildProcess>(
        "/bin/sh",
        shell("XDG_STATE_HOME='" + state_home + "'; export XDG_STATE_HOME; L render tiny.pbrt " +
              "-i path -r 64x64 --time 10m -o sub/a.exr -o sub/a.png"),
        dir_.path());
    await(*child, "pass 1");
    fs::remove(path("sub"));
    child->send(SIGTERM);
    return child;
  }
};

TEST_F(VanishingFolder, TheRenderIsRescuedIntoTheUsersOwnFolder) {
  const Ending ending = start_and_remove_folder(path("home").string())->wait();
  EXPECT_EQ(ending.exit_code, 2);
  const Words names = rescue_files("home/lanthorn/a.rescue-");
  ASSERT_EQ(names.size(), 1u) << ending.err;
  EXPECT_TRUE(contains(ending.err, path(names.front()).string())) << ending.err;
  EXPECT_GE(load_state(path(names.front())).pass_count(), 1u);
}

TEST_F(VanishingFolder, TheRenderIsKeptInMemoryUntilItCanBeWritten) {
  const auto child = start_and_remove_folder("/dev/null");
  await(*child, "The render exists only in memory; retrying every 10 s");
  fs::create_directory(path("sub"));
  const Ending ending = child->wait();
  EXPECT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_EQ(files(), (Words{"sub", "sub/a.exr", "sub/a.png", "tiny.pbrt"}));
}

TEST_F(VanishingFolder, ASignalEndsTheWaiting) {
  const auto child = start_and_remove_folder("/dev/null");
  await(*child, "The render exists only in memory");
  child->send(SIGINT);
  const Ending ending = child->wait();
  EXPECT_EQ(ending.exit_code, 2) << "signal " << ending.signal;
  EXPECT_TRUE(contains(ending.err, "it is not saved")) << ending.err;
}

TEST_F(Safety, TheFirstLineSaysWhereCheckpointsGo) {
  const Words words{"render", "tiny.pbrt", "-i", "path", "--reproducible", "-o", "a.exr"};
  const auto first_line = [&](const std::string& passes, const Words& more) {
    const std::string text = succeed(words + Words{"-p", passes} + more).err;
    return text.substr(0, text.find('\n'));
  };
  const std::string automatic = first_line("2", {});
  EXPECT_TRUE(contains(automatic, "checkpoint every 10:00 min in a.exr.checkpoint.state")) << automatic;
  EXPECT_EQ(files(), (Words{"a.exr", "tiny.pbrt"}));
  EXPECT_FALSE(contains(first_line("2", {"--checkpoint", "none"}), "checkpoint"));
  EXPECT_FALSE(contains(first_line("2", {"--time", "5m"}), "checkpoint"));
  EXPECT_TRUE(contains(first_line("2", {"--checkpoint", "60"}), "checkpoint every 1:00 min in a.state"));
  // Names already taken: an output, another render, this render with more passes, the resumed file.
  EXPECT_TRUE(contains(first_line("2", {"-o", "a.exr.checkpoint.state"}), "a.exr.checkpoint-2.state"));
  EXPECT_TRUE(contains(first_line("2", {}), "a.exr.checkpoint-2.state"));
  EXPECT_TRUE(contains(first_line("2", {"--seed", "7"}), "a.exr.checkpoint-2.state"));
  EXPECT_TRUE(contains(first_line("3", {"--resume", "a.exr.checkpoint.state"}), "a.exr.checkpoint-2.state"));
  succeed(words + Words{"-p", "2", "-o", "b.state"});
  EXPECT_TRUE(contains(first_line("3", {"--resume", "b.state"}), "a.exr.checkpoint.state"));
  dir_.write("a.exr.checkpoint-2.state", "something else");
  EXPECT_TRUE(contains(first_line("2", {}), "a.exr.checkpoint-3.state"));
}

}  // namespace
}  // namespace lanthorn::safety_test
