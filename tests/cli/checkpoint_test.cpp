// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The program's checkpoints, without the ten minutes between them.
#include "interim_files.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "render/state.h"
#include "support/temporary_dir.h"
#include "support/whole_film.h"

namespace lanthorn::checkpoint_test {
namespace {

using namespace program;
namespace fs = std::filesystem;

RenderState state_of(std::uint64_t passes) {
  RenderState state;
  test::set_film(state, Film(4, 4, 1));
  state.integrator = "path";
  for (std::uint64_t pass = 0; pass < passes; ++pass) state.add_pass(pass);
  return state;
}

class CheckpointFile : public testing::Test {
 protected:
  Checkpoints checkpoints(bool automatic) { return {file_, 600, automatic, progress_}; }

  test::TemporaryDir dir_;
  fs::path file_ = dir_.path() / "a.state";
  ProgressDisplay progress_{{}, true};
};

TEST_F(CheckpointFile, IsSavedWhenItIsDue) {
  Checkpoints saved = checkpoints(true);
  EXPECT_FALSE(saved.save_if_due(state_of(1), 599));
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_TRUE(saved.save_if_due(state_of(2), 600));
  EXPECT_EQ(load_state(file_).pass_count(), 2u);
}

TEST_F(CheckpointFile, IsRemovedAfterTheRenderIfNobodyAskedForIt) {
  for (const bool automatic : {true, false}) {
    Checkpoints saved = checkpoints(automatic);
    saved.save_if_due(state_of(2), 600);
    saved.finish(state_of(3), /*interrupted=*/false);
    EXPECT_EQ(fs::exists(file_), !automatic);
  }
  // The file now holds another render's state, which is not its own.
  Checkpoints unused = checkpoints(true);
  unused.finish(state_of(3), /*interrupted=*/false);
  EXPECT_TRUE(fs::exists(file_));
}

TEST_F(CheckpointFile, HoldsAllPassesOfARenderThatWasInterrupted) {
  Checkpoints saved = checkpoints(true);
  saved.finish(state_of(2), /*interrupted=*/true);
  EXPECT_FALSE(fs::exists(file_)) << "a render of less than ten minutes";
  saved.save_if_due(state_of(2), 600);
  saved.finish(state_of(5), /*interrupted=*/true);
  EXPECT_EQ(load_state(file_).pass_count(), 5u);
}

TEST_F(CheckpointFile, ThatCannotBeWrittenEndsNoRender) {
  fs::create_directory(file_);
  Checkpoints saved = checkpoints(true);
  EXPECT_TRUE(saved.save_if_due(state_of(2), 600));
  saved.finish(state_of(3), /*interrupted=*/false);
  EXPECT_TRUE(fs::is_directory(file_));
}

}  // namespace
}  // namespace lanthorn::checkpoint_test
