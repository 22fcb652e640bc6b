// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The program rejects input that needs too many resources, and files that it must not touch.
#include <sched.h>
#include <sys/stat.h>

#include <algorithm>
#include <string>
#include <vector>

#include "cli_fixture.h"
#include "support/gzip.h"
#include "support/images.h"

namespace lanthorn::bounds_test {
namespace {

// The tiny scene with an image on its floor.
std::string textured(const std::string& file) {
  std::string scene = tiny_scene;
  const std::string material = R"(Material "diffuse" "rgb reflectance" [0.7 0.6 0.5]
)";
  return scene.replace(scene.find(material), material.size(),
                       R"(Texture "t" "spectrum" "imagemap" "string filename" ")" + file +
                           R"("
Material "diffuse" "texture reflectance" "t"
)");
}

class Bounds : public Cli {
 protected:
  void write(const std::string& name, const std::string& bytes) const { dir_.write(name, bytes); }
};

TEST_F(Bounds, PhotonsThatDoNotFitAreRefusedWithWhatTheyWouldTake) {
  for (const std::string method : {"sppm", "ppm", "photonmap", "reversephotonmap"}) {
    refuse({"render", "tiny.pbrt", "-i", method, "-n", "4000000000", "--memory", "20G", "-o", "a.exr"},
           "4000000000 light paths a pass take ");
    refuse({"render", "tiny.pbrt", "-i", method, "-n", "10000000", "--memory", "100M", "-o", "a.exr"},
           "or a method that does not need all of them at a time (probppm");
  }
  for (const std::string method : {"auto", "probppm", "vcm", "bdpt", "bpm"})
    refuse({"render", "tiny.pbrt", "-i", method, "-n", "4000000000", "--memory", "100M", "-o", "a.exr"},
           " light paths at a time take ");
  for (const std::string method : {"path", "light", "probppm", "auto"})
    refuse({"render", "tiny.pbrt", "-i", method, "-n", "1000000000000", "-o", "a.exr"},
           "a pass can have at most 4294967295 light paths");
  refuse({"render", "tiny.pbrt", "-n", "10000000", "--memory", "100M", "-o", "a.exr"},
         "--memory allows 100 MiB: choose fewer with --photons");
  refuse({"converge", "tiny.pbrt", "-n", "10000000", "--memory", "100M"}, "choose fewer with --photons");
}

TEST_F(Bounds, PicturesThatDoNotFitAreRefusedWithWhatTheyWouldTake) {
  for (const std::string method : {"path", "light", "probppm", "sppm", "mlt"})
    refuse({"render", "tiny.pbrt", "-i", method, "-r", "4000x4000", "--memory", "1G", "-o", "a.exr"},
           "4000 x 4000 pixels take ");
  refuse({"render", "tiny.pbrt", "-i", "path", "-r", "46000x46000", "-o", "a.exr"},
         "46000 x 46000 pixels take 1.1 TiB");
  refuse({"render", "tiny.pbrt", "-r", "100000x100000", "-o", "a.exr"}, "its sums would take 2.2 TiB of memory");
}

TEST_F(Bounds, MethodsThatKeepNoPhotonsTakeAnyNumber) {
  succeed({"render", "tiny.pbrt", "-i", "path", "-p", "1", "-n", "4000000000", "--memory", "64M", "-o", "a.exr", "-q"});
}

// The instances' boxes are so large that every photon may hit all of them: without bounds, the projection map's
// per-cell lists take 1.6 GB.
TEST_F(Bounds, ProjectionMapsTakeLittleMemory) {
  std::string scene =
      R"(LookAt 0 0 4  0 0 0  0 1 0
Camera "perspective"
Film "rgb" "integer xresolution" [8] "integer yresolution" [8]
WorldBegin
LightSource "spot" "point3 from" [0 1 0]
Shape "sphere"
ObjectBegin "o"
Shape "sphere" "float radius" [0.1]
ObjectEnd
)";
  for (int i = 0; i < 8; ++i)
    scene += "AttributeBegin\nScale 1 1e30 1\nRotate " + std::to_string(20 + i) +
             R"( 1 1 1
ObjectInstance "o"
AttributeEnd
)";
  write("long.pbrt", scene);
  succeed({"render", "long.pbrt", "-i", "reversephotonmap", "-p", "1", "-n", "100", "-q", "-o", "a.exr", "--json",
           "a.json"});
  EXPECT_LT(json("a.json").value("peak_memory_bytes", 1e12), 700e6);
}

TEST_F(Bounds, MemoryDoesNotChangeThePicture) {
  for (const std::string method : {"auto", "probppm", "vcm", "reversephotonmap"}) {
    const Words words = render({"-i", method, "-p", "2", "--memory"});
    succeed(words + Words{"2M", "-o", "small.exr"});
    succeed(words + Words{"2G", "-o", "large.exr"});
    expect_equal_files("small.exr", "large.exr");
  }
}

TEST_F(Bounds, ImagesOfTooManyPixelsAreRefused) {
  write("bomb.png", test::png_header(65535, 65535));
  write("bomb.gif", test::gif_header(65535, 65535));
  write("textured.pbrt", textured("bomb.png"));
  refuse({"render", "textured.pbrt", "-o", "a.exr"}, R"(textured.pbrt:10:1: image "bomb.png" has 4294836225 pixels)");
  refuse({"render", "textured.pbrt", "-o", "a.exr", "--max-pixels", "5G"}, "announces 12 GiB of pixels, which its");
  refuse({"info", "textured.pbrt", "--max-pixels", "1M"}, "more than the 1000000 of --max-pixels");
  refuse({"compare", "bomb.gif", "bomb.png"}, "bomb.gif: the file has 4294836225 pixels");
  refuse({"converge", "tiny.pbrt", "--reference", "bomb.gif", "-p", "1", "--runs", "2"}, "bomb.gif: the file has");
  refuse({"info", "tiny.pbrt", "--max-pixels", "none"}, "--max-pixels");
}

TEST_F(Bounds, MalformedGifIsNoInternalError) {
  for (const unsigned side : {10u, 30000u, 65535u}) {
    write("a.gif", test::gif_header(side, side));
    refuse({"compare", "a.gif", "a.gif", "--max-pixels", "5G"}, "a.gif: the file ");
  }
}

// A chain once overflowed the stack; a doubling chain took years, during which only SIGKILL ended the render.
TEST_F(Bounds, TexturesThatNameEachOtherTooOftenAreRefused) {
  const auto scene = [](const std::string& kind, const Words& inputs, int last) {
    std::string text = tiny_scene + std::string(R"(Texture "t0" "spectrum" "checkerboard"
)");
    for (int i = 1; i <= last; ++i) {
      text += "Texture \"t" + std::to_string(i) + R"(" "spectrum" ")" + kind + "\"";
      for (const std::string& input : inputs) text += " \"texture " + input + R"(" "t)" + std::to_string(i - 1) + "\"";
      text += "\n";
    }
    return text + R"(Material "diffuse" "texture reflectance" "t)" + std::to_string(last) + R"("
Shape "sphere"
)";
  };
  for (const std::string kind : {"mix", "directionmix"}) {
    write("doubling.pbrt", scene(kind, {"tex1", "tex2"}, 60));
    for (const std::string command : {"render", "photons"})
      refuse({command, "doubling.pbrt", "-o", command == "render" ? "a.exr" : "a.ply"},
             "doubling.pbrt:27:1: a value of this texture takes more than 1000 lookups");
  }
  for (const std::string kind : {"mix", "checkerboard"}) {
    write("deep.pbrt.gz", test::gzip(scene(kind, {"tex1"}, 8200)));
    refuse({"info", "deep.pbrt.gz"}, "deep.pbrt.gz:7962:1: textures are nested more than 256 deep");
    refuse({"render", "deep.pbrt.gz", "--sandbox", "-o", "a.exr"}, "deep.pbrt.gz:7962:1: textures are nested");
  }
}

// 2 kB that request 15 million instances.
TEST_F(Bounds, InstancesThatDoNotFitAreRefused) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the sanitizer itself needs more addresses than the limit leaves";
#endif
  std::string nodes, roots;
  for (int i = 0; i < 15; ++i) {
    nodes += std::string(i > 0 ? "," : "") +
             R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":1}}}})";
    roots += (i > 0 ? "," : "") + std::to_string(i);
  }
  write("a.gltf", R"({"asset":{"version":"2.0"},"extensionsUsed":["EXT_mesh_gpu_instancing"],"accessors":[
    {"componentType":5126,"count":3,"type":"VEC3"},{"componentType":5126,"count":1048576,"type":"VEC3"}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[)" +
                      nodes + R"(],"scenes":[{"nodes":[)" + roots + "]}]}");
  const Ending ending = run_shell("ulimit -v 4000000\nL info a.gltf");
  EXPECT_EQ(ending.exit_code, 2);
  EXPECT_TRUE(contains(ending.err, "a.gltf#/nodes/1: the scene of 2097152 instances takes 4.0 GiB of memory, but"))
      << ending.err;
}

TEST_F(Bounds, SpecialFilesAreRefusedEverywhere) {
  ASSERT_EQ(::mkfifo(path("pipe.pbrt").c_str(), 0600), 0);
  fs::create_symlink("pipe.pbrt", path("pipe.exr"));
  const std::string expected = "not a regular file";
  refuse({"render", "pipe.pbrt", "-o", "a.exr"}, "pipe.pbrt");
  refuse({"info", "pipe.pbrt"}, expected);
  refuse({"compare", "pipe.exr", "pipe.exr"}, expected);
  refuse({"merge", "pipe.exr", "pipe.exr", "-o", "a.exr"}, expected);
  refuse({"render", "tiny.pbrt", "--resume", "pipe.exr", "-o", "a.exr"}, expected);
  refuse({"converge", "tiny.pbrt", "--reference", "pipe.exr"}, expected);
  write("textured.pbrt", textured("pipe.exr"));
  refuse({"info", "textured.pbrt"}, expected);
  for (const std::string directive : {R"(Include "/dev/zero")", R"(Shape "plymesh" "string filename" "/dev/zero")",
                                      R"(Material "measured" "string filename" "/dev/tty")",
                                      R"(LightSource "infinite" "string filename" "/dev/zero")",
                                      R"(MakeNamedMedium "m" "string type" "nanovdb" "string filename" "/dev/zero")"}) {
    write("special.pbrt", tiny_scene + std::string(directive) + "\n");
    refuse({"info", "special.pbrt"}, expected);
  }
}

// No process reads the pipes: writing must not wait for one.
TEST_F(Bounds, PipesWithoutAReaderAreErrors) {
  for (const char* name : {"pipe.exr", "pipe.png", "pipe.state", "pipe.json", "pipe.svg", "pipe.ply", "pipe.pbrt"})
    ASSERT_EQ(::mkfifo(path(name).c_str(), 0600), 0);
  const Words few = render({"-p", "1", "-r", "8x8"});
  succeed(few + Words{"-o", "a.exr", "-o", "a.state"});
  write("v3.pbrt", R"(Camera "perspective"
WorldBegin
Shape "sphere"
WorldEnd
)");
  const std::vector<Words> commands{few + Words{"-o", "pipe.exr"},
                                    few + Words{"-o", "pipe.png"},
                                    few + Words{"-o", "pipe.state"},
                                    few + Words{"-o", "b.exr", "--json", "pipe.json"},
                                    {"merge", "a.state", "-o", "pipe.exr"},
                                    {"develop", "a.exr", "pipe.png"},
                                    {"compare", "a.exr", "a.exr", "--json", "pipe.json"},
                                    {"compare", "a.exr", "a.exr", "--diff", "pipe.png"},
                                    {"converge", "tiny.pbrt", "-i", "path", "-r", "8x8", "-p", "2", "--runs", "2",
                                     "--json", "pipe.json", "--plot", "pipe.svg", "-q"},
                                    {"photons", "tiny.pbrt", "-n", "300", "-o", "pipe.ply"},
                                    {"convert", "v3.pbrt", "pipe.pbrt"}};
  for (const Words& words : commands) {
    const Ending ending = run(words);
    EXPECT_EQ(ending.exit_code, 2) << testing::PrintToString(words) << " signal " << ending.signal;
    EXPECT_TRUE(contains(ending.err, ": cannot write: ")) << ending.err;
    EXPECT_TRUE(contains(ending.err, "if it is a pipe, start its reader first")) << ending.err;
  }
  // The picture that could not be written is saved as a state.
  const std::string said = run(commands.front()).err;
  EXPECT_TRUE(contains(said, "The render is saved in ") && contains(said, "pipe.rescue-")) << said;
}

TEST_F(Bounds, PipesThatAreReadAndDevicesAreWritten) {
  const Words few = render({"-p", "1", "-r", "8x8", "-o"});
  succeed(few + Words{"a.exr"});
  ASSERT_EQ(::mkfifo(path("pipe.exr").c_str(), 0600), 0);
  EXPECT_EQ(run_shell("cat pipe.exr > read.exr & (L render tiny.pbrt --photons 300 --quiet --reproducible -p 1 -r 8x8 "
                      "-o pipe.exr); code=$?; wait; exit $code")
                .exit_code,
            0);
  expect_equal_files("a.exr", "read.exr");
  const Ending ending = run_shell("L compare a.exr a.exr --json /dev/stdout | grep mse");
  EXPECT_TRUE(contains(ending.out, R"("mse": 0.0)")) << ending.out << ending.err;
  succeed({"compare", "a.exr", "a.exr", "--json", "/dev/null"});
}

// Messages of the libraries that decode images become part of our message.
TEST_F(Bounds, BrokenImagesSayOneLine) {
  write("headless.png", test::png_header(10, 10));
  std::string damaged = test::png_header(10, 10);
  damaged[20] = '\x7f';  // invalidates its checksum
  write("damaged.png", damaged);
  refuse({"info", "headless.png"}, "headless.png: the file cannot be read: ");
  refuse({"info", "damaged.png"}, "damaged.png: the file cannot be read: ");
  refuse({"compare", "headless.png", "damaged.png"}, "the file cannot be read: ");
  const std::vector<std::string> broken{std::string("II*\0\x08\0\0\0\xff\xff", 10),
                                        "\xff\xd8\xff\xe0",
                                        "GIF89a",
                                        "RIFF\x10\0\0\0WEBPVP8 ",
                                        "DDS " + std::string(124, '\x7f'),
                                        "BM" + std::string(60, '\x11'),
                                        "8BPS" + std::string(30, '\xff'),
                                        std::string("\x76\x2f\x31\x01\x02\0\0\0", 8),
                                        "P6 10 10 255\n"};
  for (const std::string& bytes : broken) {
    write("broken.png", bytes);
    refuse({"info", "broken.png"}, "broken.png: the file ");
  }
}

// A uniform image is small as a file: 3000 x 3000 colours take 26 MiB as bytes, and their sampling table 69 MiB. As
// floats, with a copy for sampling, they took 206 MiB.
TEST_F(Bounds, EnvironmentsOfBytesStayBytes) {
  Image flat(3000, 3000, {"R", "G", "B"});
  std::fill(flat.pixels.begin(), flat.pixels.end(), 0.5f);
  write_png(path("flat.png"), flat, {});
  const auto memory_with = [&](const std::string& light) {
    write("sky.pbrt", tiny_scene + (R"(LightSource "infinite" )" + light + "\n"));
    succeed({"render", "sky.pbrt", "-i", "path", "-p", "1", "-r", "8x8", "-q", "-o", "a.exr", "--json", "a.json"});
    return json("a.json").value("peak_memory_bytes", 1e12);
  };
  Image small(8, 8, {"R", "G", "B"});
  write_png(path("small.png"), small, {});
  const double others = memory_with(R"("string filename" "small.png")");
  EXPECT_LT(memory_with(R"("string filename" "flat.png")") - others, 130e6);
}

TEST_F(Bounds, SandboxReadsOnlyWhatIsInTheScenesFolder) {
  fs::create_directory(path("uploads"));
  write("secret.pbrt", "secret-word\n");
  write("uploads/a.pbrt", tiny_scene + std::string(R"(Include "../secret.pbrt"
)"));
  write("uploads/b.pbrt", textured("link.exr"));
  write("uploads/c.pbrt",
        tiny_scene + std::string(R"(MakeNamedMedium "m" "string type" "nanovdb" "string filename" "link.exr"
)"));
  write("uploads/d.pbrt", tiny_scene + std::string(R"(LightSource "infinite" "string filename" "link.exr"
)"));
  write("uploads/good.pbrt", tiny_scene);
  succeed({"render", "tiny.pbrt", "-q", "-p", "1", "-r", "8x8", "-o", "picture.exr"});
  fs::create_symlink("../picture.exr", path("uploads/link.exr"));
  const std::string expected = "no such file in the scene's folder";
  for (const std::string scene : {"uploads/a.pbrt", "uploads/b.pbrt", "uploads/c.pbrt", "uploads/d.pbrt"}) {
    EXPECT_FALSE(contains(refuse({"info", scene, "--sandbox"}, expected), "secret-word"));
    refuse({"render", scene, "--sandbox", "-o", "a.exr"}, expected);
    refuse({"photons", scene, "--sandbox", "-o", "a.ply"}, expected);
    refuse({"converge", scene, "--sandbox"}, expected);
  }
  succeed({"info", "uploads/b.pbrt"});
  succeed({"info", "uploads/good.pbrt", "--sandbox"});
}

// The header tells the size. The mesh's contents, which are invalid, are not read.
TEST_F(Bounds, MeshesThatDoNotFitAreRefusedByTheirHeader) {
  write("mesh.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 40000000\nproperty list uchar int vertex_indices\nend_header\n");
  fs::resize_file(path("mesh.ply"), fs::file_size(path("mesh.ply")) + 36 + 40000000);
  write("huge.pbrt", tiny_scene + std::string(R"(Shape "plymesh" "string filename" "mesh.ply"
)"));
  for (const std::string command : {"info huge.pbrt", "render huge.pbrt -q -o a.exr"}) {
    const Ending ending = run_shell("ulimit -v 4000000; L " + command);
    EXPECT_EQ(ending.exit_code, 2) << ending.err;
    EXPECT_TRUE(contains(ending.err, "the mesh (40000000 faces) with its search tree takes 6.9 GiB of memory"))
        << ending.err;
  }
}

// Each mesh alone would fit. The shell's limit applies to the address space, of which the program itself takes a fifth.
TEST_F(Bounds, MeshesThatDoNotFitTogetherAreRefusedBeforeAnyIsRead) {
  write("mesh.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 10000000\nproperty list uchar int vertex_indices\nend_header\n");
  fs::resize_file(path("mesh.ply"), fs::file_size(path("mesh.ply")) + 36 + 10000000);
  const std::string mesh = R"(Shape "plymesh" "string filename" "mesh.ply"
)";
  write("huge.pbrt", tiny_scene + mesh + mesh + mesh);
  for (const std::string command : {"info huge.pbrt", "render huge.pbrt -q -o a.exr"}) {
    const Ending ending = run_shell("ulimit -v 4000000; L " + command);
    EXPECT_EQ(ending.exit_code, 2) << ending.err;
    EXPECT_TRUE(contains(ending.err, "the geometry of 3 meshes (30000000 faces) with its search trees takes 5.2 GiB"))
        << ending.err;
    EXPECT_EQ(contains(ending.err, "huge.pbrt: 3 meshes with 30000000 faces will take 5.2 GiB of memory"),
              command.starts_with("info"))
        << ending.err;
  }
}

TEST_F(Bounds, InfoSaysWhatTheMachineLeaves) {
  const auto machine = nlohmann::json::parse(succeed({"info", "--machine", "--json"}).out);
  EXPECT_GE(machine.at("hardware_threads"), machine.at("allowed_threads"));
  EXPECT_GE(machine.at("allowed_threads"), machine.at("default_threads"));
  EXPECT_GT(machine.at("memory_bytes").at("machine"), machine.at("memory_bytes").at("available"));
  for (const std::string library : {"Lanthorn", "Embree", "oneTBB", "OpenImageIO"})
    EXPECT_TRUE(contains(machine.at("libraries").at(library), ".")) << library;
  const std::string text = succeed({"info", "--machine"}).out;
  for (const std::string line :
       {"processor ", "sets ", "compiled ", "cores ", "threads ", "memory ", "gpu ", "version    Embree 3."})
    EXPECT_TRUE(contains(text, line)) << text;
  refuse({"info"}, "expected a file, or --machine");
  refuse({"info", "tiny.pbrt", "--machine"}, "takes no file");
}

// Restores the CPU affinity of this process, which child processes inherit.
class AffinityScope {
 public:
  AffinityScope() { sched_getaffinity(0, sizeof before_, &before_); }
  ~AffinityScope() { sched_setaffinity(0, sizeof before_, &before_); }
  AffinityScope(const AffinityScope&) = delete;
  AffinityScope& operator=(const AffinityScope&) = delete;

  void allow_first_only() const {
    int first = 0;
    while (!CPU_ISSET(first, &before_)) ++first;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(first, &one);
    sched_setaffinity(0, sizeof one, &one);
  }

 private:
  cpu_set_t before_{};
};

TEST_F(Bounds, ThreadsKeepToTheAffinity) {
  const AffinityScope scope;
  scope.allow_first_only();
  const auto machine = nlohmann::json::parse(succeed({"info", "--machine", "--json"}).out);
  EXPECT_EQ(machine.at("allowed_threads"), 1);
  EXPECT_EQ(machine.at("default_threads"), 1);
  succeed(render({"-p", "1", "-o", "a.exr", "-T", "7", "--json", "a.json"}));
  EXPECT_EQ(json("a.json").at("threads"), 1);
}

// A version 1 control group created by hand; skipped if the user may not create one.
TEST_F(Bounds, ThreadsAndMemoryKeepToTheControlGroup) {
  const Ending made = run_shell(
      "g=/sys/fs/cgroup/cpu/lanthorn-test-$$ m=/sys/fs/cgroup/memory/lanthorn-test-$$\n"
      "trap 'echo $$ >/sys/fs/cgroup/cpu/cgroup.procs; echo $$ >/sys/fs/cgroup/memory/cgroup.procs; rmdir $g $m' EXIT\n"
      "mkdir $g $m && echo 20000 >$g/cpu.cfs_quota_us && echo 256M >$m/memory.limit_in_bytes || exit 77\n"
      "echo $$ >$g/cgroup.procs && echo $$ >$m/cgroup.procs || exit 77\n"
      "(L info --machine --json)");
  if (made.exit_code == 77) GTEST_SKIP() << "no control groups can be made here: " << made.err;
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto machine = nlohmann::json::parse(made.out);
  EXPECT_DOUBLE_EQ(machine.at("cpu_quota"), .2);
  EXPECT_EQ(machine.at("default_threads"), 1);
  EXPECT_EQ(machine.at("memory_bytes").at("limit"), 256 << 20);
  EXPECT_LT(machine.at("memory_bytes").at("available"), 256 << 20);
}

}  // namespace
}  // namespace lanthorn::bounds_test
