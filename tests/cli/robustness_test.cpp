// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scenes and machines at their limits: the program renders what it can, or reports what it cannot.
#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <functional>

#include "cli_fixture.h"

namespace lanthorn::robustness_test {
namespace {

const Words integrators{"auto",      "probppm",          "sppm",    "ppm", "vcm", "bpm", "bdpt", "path", "light", "mlt",
                        "photonmap", "reversephotonmap", "splitsum"};

using Robustness = Cli;

// Embree ended the process when a ray became too long on entering an instance.
TEST_F(Robustness, InstancesOfAnyScaleRenderWithEveryMethod) {
  std::string scene(tiny_scene);
  scene +=
      R"(ObjectBegin "o"
Shape "sphere" "float radius" [0.1]
Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2]
ObjectEnd
)";
  for (const char* scale : {"0", "1e-38", "1e-20", "1e-18", "1e-17", "1e-15", "1e-12", "1e12", "1e30"})
    for (const char* factors : {" {} {} {}", " {} 1 1", " -{} {} 1"}) {
      std::string text(factors);
      for (std::size_t at; (at = text.find("{}")) != std::string::npos;) text.replace(at, 2, scale);
      scene += "AttributeBegin\nTranslate 0 1 0\nScale" + text + R"(
ObjectInstance "o"
)" +
               R"(ActiveTransform EndTime
Translate 0 0.1 0
Scale 2 -1 1
ActiveTransform All
ObjectInstance "o"
)" +
               R"(Shape "sphere" "float radius" 0.1
AttributeEnd
)";
    }
  dir_.write("scales.pbrt", R"(Camera "perspective" "float shutterclose" [1]
)" + scene);
  for (const std::string& method : integrators) {
    const Ending ending = succeed({"render", "scales.pbrt", "-o", "a.png", "-p", "1", "-n", "300", "-r", "8x8", "-i",
                                   method, "-q", "--json", "a.json"});
    EXPECT_EQ(ending.err.find("left out"), ending.err.rfind("left out")) << "one warning: " << ending.err;
    EXPECT_TRUE(contains(ending.err, "shapes or instances, the first of them here, are left out")) << ending.err;
    EXPECT_EQ(json("a.json")["film"]["non_finite"], 0) << method;
  }
}

TEST_F(Robustness, ThreadsThatCannotBeHadAreDoneWithout) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the plain threads of this build, and the sanitizer's own, cannot be done without";
#endif
  if (getuid() != 0) GTEST_SKIP() << "only root can become a user who has no other threads that count";
  // A copy in a folder that this user can read; it finds the library beside it.
  fs::create_directory(path("bin"));
  fs::copy(LANTHORN_PROGRAM, path("bin/program"));
  fs::create_directory_symlink(fs::path(LANTHORN_PROGRAM).parent_path().parent_path() / "lib", path("lib"));
  for (const char* name : {"", "bin", "bin/program"}) fs::permissions(path(name), fs::perms(0777));
  const auto run_limited = [&](int limit, const Words& words) {
    const std::string user = "61947";  // a user id that is not in use
    const Words prefix{"--reuid=" + user, "--regid=" + user, "--clear-groups", "prlimit",
                       "--nproc=" + std::to_string(limit)};
    return ChildProcess("/usr/bin/setpriv", prefix + Words{path("bin/program")} + words, dir_.path()).wait();
  };
  succeed(render({"-o", "all.exr", "-p", "2"}));
  int least = 1;  // the minimum for reading images, whose libraries start threads
  for (; least < 1000; ++least) {
    const Ending ending = run_limited(least, {"info", "all.exr"});
    if (ending.exit_code == 0) break;
    EXPECT_EQ(ending.exit_code, 2) << least << " signal " << ending.signal << ending.err;
    EXPECT_TRUE(contains(ending.err, "images cannot be read: the libraries that read them start threads"))
        << ending.err;
    EXPECT_EQ(run_limited(least, {"info", "tiny.pbrt"}).exit_code, 0);
  }
  const Ending serving = run_limited(2, {"serve", "tiny.pbrt", "--port", "0"});
  EXPECT_EQ(serving.exit_code, 2) << serving.err;
  EXPECT_TRUE(contains(serving.err, "the system allows no further threads")) << serving.err;
  for (int limit = least; limit < least + 6; ++limit) {
    const Ending ending = run_limited(limit, render({"-o", "few.exr", "-p", "2", "--threads", "4"}));
    EXPECT_EQ(ending.exit_code, 0) << limit << ", at least " << least << ": " << ending.err;
    expect_equal_files("all.exr", "few.exr");
    EXPECT_EQ(run_limited(limit, {"compare", "all.exr", "few.exr"}).exit_code, 0);
  }
}

TEST_F(Robustness, TextInUtf16IsNamed) {
  const std::string marks[] = {"\xFF\xFEv", "\xFE\xFFv"};
  for (const char* name : {"a.pbrt", "a.gltf", "a.obj"})
    for (const std::string& text : marks) {
      dir_.write(name, text);
      refuse({"info", name}, std::string(name) + ":1:1: expected text in UTF-8, found UTF-16");
    }
}

TEST_F(Robustness, ScenesWithoutShapesHaveNoBounds) {
  dir_.write("empty.obj", "");
  EXPECT_FALSE(contains(succeed({"info", "empty.obj"}).out, "bounds"));
  EXPECT_TRUE(contains(succeed({"info", "tiny.pbrt"}).out, "bounds"));
}

// The progress lines that a terminal of this width shows; carriage returns separate them.
Words progress_in(const fs::path& folder, std::uint16_t columns) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  EXPECT_EQ(grantpt(terminal), 0);
  EXPECT_EQ(unlockpt(terminal), 0);
  const std::string name = ptsname(terminal);
  const int kept = open(name.c_str(), O_RDWR | O_NOCTTY);  // keeps the terminal's content readable
  winsize size{};
  size.ws_col = columns;
  EXPECT_EQ(ioctl(kept, TIOCSWINSZ, &size), 0);
  const std::string command =
      "exec '" LANTHORN_PROGRAM "' render tiny.pbrt -n 300 -p 2 --preview none -o a.exr 2> " + name;
  EXPECT_EQ(ChildProcess("/bin/sh", {"-c", command}, folder).wait().exit_code, 0);
  Words lines{""};
  std::array<char, 4096> bytes{};
  for (ssize_t count; (count = read(terminal, bytes.data(), bytes.size())) > 0;)
    for (const char c : std::string_view(bytes.data(), static_cast<std::size_t>(count))) {
      if (c == '\r')
        lines.emplace_back();
      else
        lines.back() += c;
    }
  close(kept);
  close(terminal);
  std::erase_if(lines, [](const std::string& line) { return !contains(line, " %  "); });
  return lines;
}

// A wrapped line cannot be overwritten.
TEST_F(Robustness, ProgressFitsIntoTheTerminal) {
  const std::string clear = "\x1b[K";
  for (const std::uint16_t columns : std::array<std::uint16_t, 3>{20, 40, 200}) {
    const Words lines = progress_in(dir_.path(), columns);
    ASSERT_FALSE(lines.empty()) << columns;
    for (const std::string& line : lines) {
      ASSERT_TRUE(line.ends_with(clear)) << line;
      EXPECT_LT(line.size() - clear.size(), columns) << line;
      EXPECT_EQ(line.front() == '[', columns == 200) << line;
    }
  }
  // A terminal that does not report its width.
  EXPECT_TRUE(contains(progress_in(dir_.path(), 0).back(), "left"));
}

}  // namespace
}  // namespace lanthorn::robustness_test
