// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The program under mpirun, with all processes on this machine.
#include <chrono>
#include <thread>

#include "cli_fixture.h"

namespace lanthorn::mpi_test {
namespace {

class Mpi : public Cli {
 protected:
  static Words launched(int processes, const Words& words) {
    constexpr const char* limit = "60";  // seconds, for processes that wait for each other for ever
    return Words{"--oversubscribe",         "--allow-run-as-root", "--timeout", limit, "--bind-to", "none", "-n",
                 std::to_string(processes), LANTHORN_PROGRAM} +
           words;
  }
  Ending mpirun(int processes, const Words& words) const {
    return ChildProcess(LANTHORN_MPIRUN, launched(processes, words), dir_.path()).wait();
  }
  void render_shared(int processes, const Words& words) const {
    const Ending ending = mpirun(processes, words);
    ASSERT_EQ(ending.exit_code, 0) << ending.err;
    EXPECT_EQ(ending.err, "") << "with --quiet";
    EXPECT_EQ(ending.out, "");
  }
  // The number of passes in a state; they must start with the first and have no gaps.
  std::uint64_t passes_of(const std::string& name) const {
    const nlohmann::json ranges = nlohmann::json::parse(succeed({"info", name, "--json"}).out)["passes"];
    EXPECT_EQ(ranges.size(), 1u) << ranges;
    EXPECT_EQ(ranges[0][0], 0) << ranges;
    return ranges[0][1];
  }
  // Waits until the render has saved a checkpoint.
  void await_file(const std::string& name) const {
    using namespace std::chrono_literals;
    for (int i = 0; i < 3000 && !fs::exists(path(name)); ++i) std::this_thread::sleep_for(10ms);
    ASSERT_TRUE(fs::exists(path(name))) << name;
  }
};

TEST_F(Mpi, AnyNumberOfProcessesWritesTheSameFiles) {
  for (const std::string method : {"auto", "vcm"}) {
    const Words command = render({"-i", method, "-p", "18", "--force"});
    succeed(command + Words{"-o", "alone.exr", "-o", "alone.state"});
    for (const int processes : {1, 2, 3, 4}) {
      ASSERT_NO_FATAL_FAILURE(render_shared(processes, command + Words{"-o", "shared.exr", "-o", "shared.state"}));
      expect_equal_files("shared.exr", "alone.exr");
      expect_equal_files("shared.state", "alone.state");
    }
  }
}

TEST_F(Mpi, TheBoundOfTheErrorEndsAfterTheSamePass) {
  const Words command = render({"-i", "path", "--noise", "30%", "-p", "1000"});
  succeed(command + Words{"-o", "alone.state"});
  EXPECT_GT(passes_of("alone.state"), 4u);
  render_shared(3, command + Words{"-o", "shared.state"});
  expect_equal_files("shared.state", "alone.state");
}

TEST_F(Mpi, AKilledProcessCostsWhatCameAfterTheCheckpoint) {
  const Words command = render({"-i", "path", "-r", "32"});
  ChildProcess job(LANTHORN_MPIRUN, launched(3, command + Words{"-p", "1000000", "-o", "a.exr", "--checkpoint", "0.3"}),
                   dir_.path());
  await_file("a.state");
  ASSERT_EQ(std::system(("pkill -9 -n -P " + std::to_string(job.pid())).c_str()), 0);
  const Ending ending = job.wait();
  EXPECT_NE(ending.exit_code, 0);
  EXPECT_TRUE(contains(ending.err, "signal 9")) << ending.err;
  EXPECT_FALSE(fs::exists(path("a.exr")));

  const std::uint64_t saved = passes_of("a.state");
  ASSERT_GT(saved, 0u);
  const std::string more = std::to_string(saved + 20);
  render_shared(2, command + Words{"-p", more, "--resume", "a.state", "-o", "resumed.state"});
  succeed(command + Words{"-p", more, "-o", "alone.state"});
  expect_equal_files("resumed.state", "alone.state");
}

TEST_F(Mpi, ASignalEndsAllProcessesAndSaves) {
  ChildProcess job(
      LANTHORN_MPIRUN,
      launched(3, render({"-i", "path", "-p", "1000000", "-o", "a.png", "-o", "b.state", "--checkpoint", "0.3"})),
      dir_.path());
  await_file("a.state");
  job.send(SIGUSR1);
  const Ending ending = job.wait();
  EXPECT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_TRUE(contains(ending.err, "finishing this pass, then saving")) << ending.err;
  const std::string passes = std::to_string(passes_of("b.state"));
  succeed(render({"-i", "path", "-p", passes, "-o", "alone.state"}));
  expect_equal_files("b.state", "alone.state");
}

TEST_F(Mpi, FramesAreRenderedOneAfterTheOther) {
  const Words command = render({"-i", "path", "-p", "5", "--turntable", "3"});
  succeed(command + Words{"-o", "alone.#.state"});
  render_shared(3, command + Words{"-o", "shared.#.state", "--json", "shared.#.json"});
  for (const std::string frame : {"0", "1", "2"}) {
    expect_equal_files("shared." + frame + ".state", "alone." + frame + ".state");
    EXPECT_EQ(nlohmann::json::parse(bytes("shared." + frame + ".json"))["passes"], 5);
  }
}

TEST_F(Mpi, TheReportCountsTheWorkOfAllProcesses) {
  const Words command = render({"-i", "probppm", "-p", "12", "-o", "a.exr", "--force"});
  succeed(command + Words{"--json", "alone.json"});
  render_shared(3, command + Words{"--json", "shared.json"});
  const auto alone = nlohmann::json::parse(bytes("alone.json")), shared = nlohmann::json::parse(bytes("shared.json"));
  for (const std::string count : {"passes", "rays", "photons_emitted", "photons_stored"})
    EXPECT_EQ(shared[count], alone[count]) << count;
}

TEST_F(Mpi, ErrorsAreSaidOnce) {
  for (const auto& [words, message] : std::vector<std::pair<Words, std::string>>{
           {{"-i", "sppm", "-o", "a.exr"}, "lanthorn: each pass of sppm depends"},
           {{"-i", "path", "-o", "no/a.exr"}, "lanthorn: -o no/a.exr"},
           {{"-i", "nosuch", "-o", "a.exr"}, "nosuch"}}) {
    const Ending ending = mpirun(2, render(words));
    EXPECT_EQ(ending.exit_code, 2) << ending.err;
    const std::size_t first = ending.err.find(message);
    ASSERT_NE(first, std::string::npos) << ending.err;
    EXPECT_EQ(ending.err.find(message, first + 1), std::string::npos) << ending.err;
  }
  EXPECT_EQ(files(), Words{"tiny.pbrt"});
}

TEST_F(Mpi, ALauncherOfAnotherMpiIsNoticed) {
  const Ending ending = run_shell("PMI_SIZE=4 L render tiny.pbrt -p 1 -o a.exr");
  EXPECT_EQ(ending.exit_code, 2) << ending.err;
  EXPECT_TRUE(contains(ending.err, "PMI_SIZE indicates 4 processes")) << ending.err;
}

}  // namespace
}  // namespace lanthorn::mpi_test
