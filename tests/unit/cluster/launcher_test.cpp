// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "cluster/launcher.h"

#include <gtest/gtest.h>

#include <map>

namespace lanthorn::launcher_test {
namespace {

int size_of(const std::map<std::string, std::string>& environment) {
  const auto launcher = find_launcher([&](const char* name) -> const char* {
    const auto found = environment.find(name);
    return found == environment.end() ? nullptr : found->second.c_str();
  });
  return launcher ? launcher->size : 0;
}

TEST(Launcher, IsFoundByItsEnvironment) {
  EXPECT_EQ(size_of({}), 0);
  EXPECT_EQ(size_of({{"OMPI_COMM_WORLD_SIZE", "4"}}), 4);
  EXPECT_EQ(size_of({{"PMI_SIZE", "3"}}), 3);
  EXPECT_EQ(size_of({{"SLURM_STEP_NUM_TASKS", "2"}}), 2);
  EXPECT_EQ(size_of({{"SLURM_NTASKS", "2"}}), 0) << "a batch script runs a command once";
  for (const char* wrong : {"", "x", "0", "-1", "4x"}) EXPECT_EQ(size_of({{"PMI_SIZE", wrong}}), 0) << wrong;
}

}  // namespace
}  // namespace lanthorn::launcher_test
