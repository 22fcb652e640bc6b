// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "base/control_group.h"

#include <gtest/gtest.h>

#include <string>

#include "support/temporary_dir.h"

namespace lanthorn::control_group_test {
namespace {

constexpr const char* unlimited_v1 = "9223372036854771712\n";

// Files that imitate a machine's /proc and /sys.
class ControlGroup : public testing::Test {
 protected:
  void processes(const std::string& groups, const std::string& mounts) const {
    dir_.write("proc/self/cgroup", groups);
    dir_.write("proc/self/mountinfo", "21 1 254:0 / / rw,relatime - ext4 /dev/vda rw\n" + mounts);
  }
  void unified(const std::string& path) const {
    processes("0::" + path + "\n", "30 21 0:26 / /sys/fs/cgroup rw,nosuid shared:4 - cgroup2 cgroup2 rw,nsdelegate\n");
  }
  void file(const std::string& name, const std::string& text) const { dir_.write("sys/fs/cgroup/" + name, text); }
  GroupLimits limits() const { return group_limits(dir_.path()); }

  test::TemporaryDir dir_;
};

TEST_F(ControlGroup, MachinesWithoutGroupsHaveNoLimits) {
  EXPECT_FALSE(limits().cores || limits().memory || limits().memory_left);
  unified("/");
  EXPECT_FALSE(limits().cores || limits().memory || limits().memory_left);
}

TEST_F(ControlGroup, TheStrictestOfNestedGroupsCounts) {
  unified("/batch/job");
  file("batch/cpu.max", "150000 100000\n");
  file("batch/job/cpu.max", "max 100000\n");
  file("batch/memory.max", "8000\n");
  file("batch/memory.current", "7000\n");
  file("batch/memory.stat", "anon 100\nfile 6500\ninactive_file 500\n");
  file("batch/job/memory.max", "5000\n");
  file("batch/job/memory.current", "1000\n");
  EXPECT_DOUBLE_EQ(limits().cores.value_or(0), 1.5);
  EXPECT_EQ(limits().memory, 5000u);
  EXPECT_EQ(limits().memory_left, 1500u);  // of the outer group
  file("batch/job/cpu.max", "20000 100000\n");
  EXPECT_DOUBLE_EQ(limits().cores.value_or(0), .2);
}

TEST_F(ControlGroup, VersionOneHasAHierarchyForEachController) {
  processes("4:memory:/a\n2:cpuacct,cpu:/a/b\n0::/\n",
            "32 31 0:29 / /sys/fs/cgroup/cpu,cpuacct rw - cgroup cgroup rw,cpu,cpuacct\n"
            "35 31 0:32 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n"
            "41 31 0:38 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n");
  file("cpu,cpuacct/a/b/cpu.cfs_quota_us", "-1\n");
  file("cpu,cpuacct/a/b/cpu.cfs_period_us", "100000\n");
  file("memory/a/memory.limit_in_bytes", unlimited_v1);
  file("memory/a/memory.usage_in_bytes", "10\n");
  EXPECT_FALSE(limits().cores || limits().memory || limits().memory_left);
  file("cpu,cpuacct/a/cpu.cfs_quota_us", "250000\n");
  file("cpu,cpuacct/a/cpu.cfs_period_us", "100000\n");
  file("memory/memory.limit_in_bytes", "4096\n");
  file("memory/memory.usage_in_bytes", "1000\n");
  file("memory/memory.stat", "inactive_file 1\ntotal_inactive_file 96\n");
  EXPECT_DOUBLE_EQ(limits().cores.value_or(0), 2.5);
  EXPECT_EQ(limits().memory, 4096u);
  EXPECT_EQ(limits().memory_left, 4096u - 904u);
}

TEST_F(ControlGroup, ContainersSeeTheirGroupAtTheMountPoint) {
  // The container's own group is mounted, and the process reports its path on the host.
  processes("2:cpu:/docker/abc\n", "32 31 0:29 /docker/abc /sys/fs/cgroup/my\\040cpu rw - cgroup cgroup rw,cpu\n");
  file("my cpu/cpu.cfs_quota_us", "300000\n");
  file("my cpu/cpu.cfs_period_us", "100000\n");
  EXPECT_DOUBLE_EQ(limits().cores.value_or(0), 3);
  // A path that leads outside the mounted groups.
  processes("0::/../other\n", "30 21 0:26 / /sys/fs/cgroup rw - cgroup2 cgroup2 rw\n");
  file("cpu.max", "100000 100000\n");
  EXPECT_DOUBLE_EQ(limits().cores.value_or(0), 1);
}

TEST_F(ControlGroup, NonsenseIsNoLimit) {
  processes("nonsense\n0:\n0::/a\n", "1 2\n - \n30 21 0:26 / /sys/fs/cgroup rw - cgroup2 cgroup2 rw\n");
  for (const char* text : {"", "0 0\n", "100 0\n", "-5 100\n", "x y\n"}) {
    file("a/cpu.max", text);
    file("a/memory.max", "many\n");
    EXPECT_FALSE(limits().cores || limits().memory) << text;
  }
}

}  // namespace
}  // namespace lanthorn::control_group_test
