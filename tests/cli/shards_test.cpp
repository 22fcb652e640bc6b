// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Renders in parts: `shards` and `merge --expect`.
#include "shards.h"

#include "cli_fixture.h"

namespace lanthorn::shards_test {
namespace {

using namespace program;
using Ranges = std::vector<PassRange>;

TEST(SplitPasses, CoversEachPassOnce) {
  EXPECT_EQ(split_passes(10, 3), (Ranges{{0, 3}, {3, 6}, {6, 10}}));
  EXPECT_EQ(split_passes(2, 2), (Ranges{{0, 1}, {1, 2}}));
}

TEST(CheckPasses, FindsWhatIsMissingAndDouble) {
  const auto check = [](const Ranges& passes) {
    const PassCheck found = check_passes({0, 10}, passes);
    return ranges_text(found.missing) + "; " + ranges_text(found.doubled);
  };
  EXPECT_EQ(check({{5, 10}, {0, 5}}), "; ");
  EXPECT_EQ(check({}), "0:10; ");
  EXPECT_EQ(check({{2, 4}, {6, 8}}), "0:2, 4:6, 8:10; ");
  EXPECT_EQ(check({{0, 6}, {4, 10}}), "; 4:6");
  EXPECT_EQ(check({{0, 10}, {2, 3}}), "; 2:3");
  EXPECT_EQ(check({{0, 12}}), "; ");
  EXPECT_EQ(check({{12, 14}}), "0:10; ");
}

class Shards : public Cli {
 protected:
  Words shards(const Words& more) const {
    return Words{"shards", "tiny.pbrt", "-i", "path", "-p", "7", "--shards", "3", "-o", "all.exr"} + more;
  }
};

TEST_F(Shards, TheScriptRendersWhatOneProcessDoes) {
  // Names with blanks and quotes must be quoted for the shell.
  fs::rename(path("tiny.pbrt"), path("it's tiny.pbrt"));
  const std::string script = succeed({"shards", "it's tiny.pbrt", "-i", "path", "-r", "12", "-p", "7", "--shards", "3",
                                      "-o", "all of it.state"})
                                 .out;
  dir_.write("all.sh", "lanthorn() { '" LANTHORN_PROGRAM R"(' "$@" --reproducible; }
)" + script);
  const Ending ending = run_shell("sh all.sh");
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  succeed({"render", "it's tiny.pbrt", "-i", "path", "-r", "12", "-p", "7", "-o", "alone.state", "--reproducible"});
  expect_equal_files("all of it.state", "alone.state");
  EXPECT_TRUE(fs::exists(path("all of it.shard-2.state")));
}

TEST_F(Shards, JsonHasACommandForEachShardAndOneThatMerges) {
  const nlohmann::json all = nlohmann::json::parse(succeed(shards({"--format", "json", "-s", "4"})).out);
  ASSERT_EQ(all["shards"].size(), 3u);
  EXPECT_EQ(all["shards"][1]["command"],
            "lanthorn render tiny.pbrt -i path -s 4 --pass-range 2:4 -o all.shard-1.state");
  EXPECT_EQ(all["shards"][1]["passes"], nlohmann::json::array({2, 4}));
  EXPECT_EQ(all["merge"]["command"],
            "lanthorn merge --expect 0:7 all.shard-0.state all.shard-1.state all.shard-2.state -o all.exr");
}

// A replacement for Slurm that runs the jobs one after the other.
TEST_F(Shards, TheScriptForSlurmSubmitsAnArrayAndAMerge) {
  dir_.write("all.sh", succeed(shards({"--format", "slurm"})).out);
  const Ending ending = run_shell("mkdir bin; ln -s " LANTHORN_PROGRAM
                                  R"( bin/lanthorn; cat > bin/sbatch <<'END'
#!/bin/bash
echo "$@" >> calls; script=$(cat)
case "$*" in *--array=0-2*) for i in 0 1 2; do SLURM_ARRAY_TASK_ID=$i bash -c "$script" || exit; done;;
  *) bash -c "$script" ;; esac 1>&2
echo 17
END
chmod +x bin/sbatch; PATH=$PWD/bin:$PATH bash all.sh --partition=long)");
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  const std::string calls = bytes("calls");
  EXPECT_TRUE(contains(calls, "--array=0-2 --requeue")) << calls;
  EXPECT_TRUE(contains(calls, "--dependency=afterany:17 --partition=long")) << calls;
  succeed({"merge", "--expect", "0:7", "all.shard-0.state", "all.shard-1.state", "all.shard-2.state", "-o", "a.exr",
           "--reproducible"});
  succeed({"render", "tiny.pbrt", "-i", "path", "-p", "7", "-o", "alone.exr", "--reproducible", "-q"});
  expect_equal_files("a.exr", "alone.exr");
  EXPECT_TRUE(fs::exists(path("all.exr")));
}

TEST_F(Shards, WhatCannotBeSharedIsRefused) {
  refuse({"shards", "tiny.pbrt", "-p", "2", "--shards", "3", "-o", "a.exr"}, "at most one shard for each");
  refuse({"shards", "tiny.pbrt", "-p", "2", "--shards", "2", "-o", "a.txt"}, "expected a name that ends in .exr");
  refuse({"shards", "tiny.pbrt", "-p", "2", "-o", "a.exr"}, "--shards");
  const std::string depends = "depends on all before it, so that it can start with pass 0 only";
  for (const std::string method : {"sppm", "ppm"})
    refuse({"shards", "tiny.pbrt", "-i", method, "-p", "4", "--shards", "2", "-o", "a.exr"},
           "--shards: each pass of " + method + " " + depends);
  std::string by_ppm = bytes("tiny.pbrt");
  by_ppm.insert(by_ppm.find("WorldBegin"), R"(Integrator "ppm"
)");
  dir_.write("ppm.pbrt", by_ppm);
  refuse({"shards", "ppm.pbrt", "-p", "4", "--shards", "2", "-o", "a.exr"}, depends);
  succeed({"shards", "ppm.pbrt", "-i", "path", "-p", "4", "--shards", "2", "-o", "a.exr"});
}

TEST_F(Shards, MergeNamesWhatIsMissingDoubleOrDamaged) {
  const auto shard = [&](const std::string& range, const std::string& name, const Words& more = {}) {
    succeed(render({"-i", "path", "--pass-range", range, "-o", name}) + more);
  };
  shard("0:2", "a.state");
  shard("2:4", "b.state");
  shard("3:5", "c.state");
  shard("4:6", "d.state", {"-s", "9"});
  std::string damaged = bytes("b.state");
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
  dir_.write("damaged.state", damaged);

  const auto problems = [&](const Words& states) {
    const Words before = files();
    const Ending ending = run(Words{"merge", "--expect", "0:6", "-o", "all.state"} + states);
    EXPECT_EQ(ending.exit_code, 2) << ending.err;
    EXPECT_EQ(files(), before);
    return ending.err;
  };
  EXPECT_EQ(problems({"a.state", "b.state"}),
            "lanthorn: missing: render again with --pass-range 4:6\n"
            "lanthorn: --expect 0:6: 0 of 2 states cannot be merged, 1 ranges of passes missing: nothing is "
            "written\n");
  const std::string corrupt = problems({"a.state", "damaged.state"});
  EXPECT_TRUE(contains(corrupt, "damaged.state: damaged or truncated")) << corrupt;
  EXPECT_TRUE(contains(corrupt, "--pass-range 2:6\n")) << corrupt;
  const std::string doubled = problems({"a.state", "b.state", "c.state"});
  EXPECT_TRUE(contains(doubled, "several states hold passes 3:4\n")) << doubled;
  EXPECT_TRUE(contains(doubled, "--pass-range 5:6\n")) << doubled;
  const std::string other = problems({"a.state", "b.state", "d.state"});
  EXPECT_TRUE(contains(other, "d.state: cannot merge: the renders differ in --seed")) << other;
  EXPECT_TRUE(contains(other, "--pass-range 4:6\n")) << other;
  EXPECT_TRUE(contains(problems({"nosuch.state"}), "nosuch.state")) << "named, and all the rest, too";

  refuse({"merge", "--expect", "0:3", "a.state", "b.state", "-o", "all.state"}, "also have other passes: 0:4");
  succeed({"merge", "--expect", "0:4", "a.state", "b.state", "-o", "all.state"});
}

}  // namespace
}  // namespace lanthorn::shards_test
