// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "base/machine.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/threads.h"
#include "lanthorn/threads.h"
#include "support/temporary_dir.h"

namespace lanthorn::machine_test {
namespace {

std::string thread_of(int number, int socket, int core) {
  return "processor\t: " + std::to_string(number) +
         "\nmodel name\t: Fast CPU: 9\nphysical id\t: " + std::to_string(socket) +
         "\ncore id\t\t: " + std::to_string(core) + "\nflags\t\t: fpu sse4_2 fma avx2 avx2x\n\n";
}

TEST(Machine, CoresAreCountedOnceForTheirThreads) {
  const test::TemporaryDir root;
  std::string text;
  for (int thread = 0; thread < 8; ++thread) text += thread_of(thread, thread / 4, thread % 2);
  root.write("proc/cpuinfo", text);
  root.write("proc/meminfo", "MemTotal:       1000 kB\nMemAvailable:    500 kB\n");
  const MachineInfo machine = machine_from_files(root.path());
  EXPECT_EQ(machine.processor, "Fast CPU: 9");
  EXPECT_EQ(machine.instruction_sets, (std::vector<std::string>{"sse4_2", "fma", "avx2"}));
  EXPECT_EQ(machine.hardware_threads, 8u);
  EXPECT_EQ(machine.cores, 4u);
  EXPECT_EQ(machine.memory, 1024000u);
  EXPECT_TRUE(machine.core_kinds.empty() && machine.gpus.empty());
  EXPECT_FALSE(machine.memory_limit || machine.cpu_quota);
}

TEST(Machine, HybridCoresAndGpusAreNamed) {
  const test::TemporaryDir root;
  root.write("sys/devices/cpu_core/cpus", "0-7,9\n");
  root.write("sys/devices/cpu_atom/cpus", "16-23\n");
  root.write("proc/driver/nvidia/gpus/0000:01:00.0/information", "Model: \t\t NVIDIA H100\nIRQ:   \t 4\n");
  root.write("sys/class/drm/card0/device/uevent", "DRIVER=amdgpu\nPCI_ID=1002:744C\n");
  root.write("sys/class/drm/card1/device/uevent", "DRIVER=nvidia\nPCI_ID=10DE:2330\n");
  root.write("sys/class/drm/card0-DP-1/device/uevent", "DRIVER=other\n");
  const MachineInfo machine = machine_from_files(root.path());
  ASSERT_EQ(machine.core_kinds.size(), 2u);
  EXPECT_EQ(machine.core_kinds[0].threads, 9u);
  EXPECT_EQ(machine.core_kinds[1].name, "efficiency");
  EXPECT_EQ(machine.core_kinds[1].threads, 8u);
  EXPECT_EQ(machine.gpus, (std::vector<std::string>{"NVIDIA H100", "amdgpu 1002:744C"}));
}

TEST(Machine, NonsenseIsUnknown) {
  const test::TemporaryDir root;
  root.write("sys/devices/cpu_core/cpus", "7-0\n");
  root.write("sys/devices/cpu_atom/cpus", "many\n");
  root.write("proc/cpuinfo", "nonsense\n:\n");
  const MachineInfo machine = machine_from_files(root.path());
  EXPECT_TRUE(machine.core_kinds.empty() && machine.processor.empty());
  EXPECT_EQ(machine.cores, 0u);
  EXPECT_FALSE(machine.memory);
}

TEST(ThreadLimit, SharesOfCoresCountAsCores) {
  EXPECT_EQ(threads_for(8, {}), 8u);
  EXPECT_EQ(threads_for(8, 1.2), 2u);
  EXPECT_EQ(threads_for(8, .2), 1u);
  EXPECT_EQ(threads_for(2, 7.5), 2u);
}

TEST(ThreadLimit, TheNewestCounts) {
  const unsigned all = usable_threads();
  EXPECT_GE(all, 1u);
  const ThreadLimit one(1);
  EXPECT_EQ(thread_count(), 1u);
  {
    const ThreadLimit every(0);
    EXPECT_EQ(thread_count(), all);
  }
  EXPECT_EQ(thread_count(), 1u);
}

}  // namespace
}  // namespace lanthorn::machine_test
