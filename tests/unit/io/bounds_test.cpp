// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Untrusted input: how many resources it may use, which files it may name, and what messages reveal about them.
#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "base/memory.h"
#include "io/gzip.h"
#include "lanthorn/file.h"
#include "lanthorn/file_access.h"
#include "lanthorn/image_file.h"
#include "lanthorn/scene.h"
#include "lanthorn/text.h"
#include "support/error_text.h"
#include "support/gzip.h"
#include "support/images.h"
#include "support/temporary_dir.h"

namespace lanthorn::bounds_test {
namespace {

namespace fs = std::filesystem;
using test::error_text;

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(InQuotes, ShowsATokenThatDoesNothingToTerminals) {
  EXPECT_EQ(in_quotes("floor"), R"("floor")");
  EXPECT_EQ(in_quotes("M\xc3\xbcller \xe2\x82\xac"), "\"M\xc3\xbcller \xe2\x82\xac\"");
  EXPECT_EQ(in_quotes("\x1b[2J\a\n"), R"("\x1b[2J\x07\x0a")");
  EXPECT_EQ(in_quotes("\x7f\xc2\x9b"), R"("\x7f\xc2\x9b")");                    // DEL, and CSI in one character
  EXPECT_EQ(in_quotes("\xff\xc3(\xed\xa0\x80"), R"("\xff\xc3(\xed\xa0\x80")");  // no UTF-8
  EXPECT_EQ(in_quotes("\xe2\x80\xae"), R"("\xe2\x80\xae")");                    // reverses the writing direction
  EXPECT_EQ(in_quotes(R"(a"b\)"), R"("a\"b\\")");
  EXPECT_EQ(in_quotes(std::string(32, 'x')), '"' + std::string(32, 'x') + '"');
  EXPECT_EQ(in_quotes(std::string(33, 'x')), '"' + std::string(32, 'x') + "...\"");
}

TEST(InQuotes, CanBeTakenOutOfMessages) {
  EXPECT_EQ(without_quotations("expected a directive, found " + in_quotes(R"(root:"x":0)")),
            R"(expected a directive, found "...")");
  EXPECT_EQ(without_quotations("nothing"), "nothing");
  EXPECT_EQ(without_quotations(in_quotes("a\\") + " and " + in_quotes("b")), R"("..." and "...")");
}

TEST(Memory, MoreThanThereIsIsRefusedWithItsSize) {
  ASSERT_TRUE(available_memory().has_value());
  EXPECT_GT(*available_memory(), std::uint64_t{1} << 20);
  EXPECT_EQ(memory_text(100), "100 bytes");
  EXPECT_EQ(memory_text(1536), "1.5 KiB");
  EXPECT_EQ(memory_text(0x1p40 * 170), "170 TiB");
  EXPECT_NO_THROW(require_memory(1 << 20, {"a"}, "the mesh"));
  EXPECT_TRUE(error_text([] {
                require_memory(0x1p60, {"a"}, "the mesh");
              }).starts_with("a: the mesh takes 1.0 EiB of memory, but there are only "));
}

// A sparse file, which occupies no space on disk.
TEST(Files, ThoseLargerThanMemoryAreRefused) {
  const test::TemporaryDir dir;
  const fs::path path = dir.write("large", "");
  ASSERT_EQ(::truncate(path.c_str(), off_t{1} << 43), 0) << "the folder's disk takes no such file";
  EXPECT_TRUE(contains(error_text([&] { read_file(path); }), "large: the file takes 8.0 TiB of memory")) << path;
}

TEST(Files, WhatIsNoOrdinaryFileIsRefusedAtOnce) {
  const test::TemporaryDir dir;
  const fs::path pipe = dir.path() / "pipe", socket = dir.path() / "socket";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(socket.string().size(), sizeof(address.sun_path));
  socket.string().copy(address.sun_path, sizeof(address.sun_path) - 1);
  const int listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  for (const fs::path& path : {pipe, socket, fs::path("/dev/zero"), fs::path("/dev/tty"),
                               fs::path("/proc/self/environ"), fs::path("/proc/self/mem"), fs::path("/")}) {
    EXPECT_THROW(read_file(path), Error) << path;
    EXPECT_THROW(read_image(path), Error) << path;
  }
  ::close(listener);
}

TEST(Gzip, SmallFilesOfMuchAreRefused) {
  const std::string bomb = test::gzip(std::string(std::size_t{64} << 20, '\0'));
  EXPECT_TRUE(contains(error_text([&] { gunzip(bomb, "a.pbrt.gz", std::size_t{1} << 20); }),
                       "a.pbrt.gz: decompressed data is larger than 1.0 MiB"));
}

// The peak memory of this process in bytes since the last reset.
double largest_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return 1024 * std::stod(line.substr(6));
  return 0;
}
bool forget_largest_memory() {
  std::ofstream forget("/proc/self/clear_refs");
  return static_cast<bool>(forget << "5" << std::flush);
}

TEST(Gzip, TakesTheMemoryOfItsDataOnce) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the sanitizer's record of accesses takes several times the memory of the data";
#endif
  if (!forget_largest_memory()) GTEST_SKIP() << "SKIPPED, NOT TESTED: this system does not measure";
  constexpr std::size_t size = (std::size_t{160} << 20) + 5, piece = std::size_t{64} << 20;
  const std::string half = test::gzip(std::string(size / 2, 'x')),
                    file = half + test::gzip(std::string(size - size / 2, 'y'));
  const auto memory_of = [&](std::size_t limit) {
    forget_largest_memory();
    const double before = largest_memory();
    error_text([&] {
      const std::string text = gunzip(file, "a.gz", limit);
      EXPECT_EQ(text.size(), size);
      EXPECT_EQ(text.front(), 'x');
      EXPECT_EQ(text.back(), 'y');
      EXPECT_EQ(text.find('y'), size / 2);
    });
    return largest_memory() - before;
  };
  EXPECT_LT(memory_of(size), 1.2 * (size + piece));
  EXPECT_LT(memory_of(size - 1), 1.2 * size);
}

TEST(Images, AnnouncedSizesAreCheckedBeforeMemoryIsTaken) {
  const test::TemporaryDir dir;
  const auto problem = [&](const std::string& name, const std::string& bytes, std::uint64_t max_pixels) {
    const fs::path path = dir.write(name, bytes);
    return error_text([&] { read_image(path, ColorEncoding::automatic, max_pixels); });
  };
  constexpr std::uint64_t any = std::numeric_limits<std::uint64_t>::max();
  const std::string png = test::png_header(65535, 65535);
  EXPECT_TRUE(
      contains(problem("a.png", png, 1u << 30), "has 4294836225 pixels, more than the 1073741824 of --max-pixels"));
  EXPECT_TRUE(contains(problem("a.png", png, any), "announces 12 GiB of pixels, which its "))
      << problem("a.png", png, any);
  // OpenImageIO would allocate a GIF's canvas when it opens the file, and throws an exception other than Error if that
  // fails.
  const std::string gif = test::gif_header(65535, 65535);
  EXPECT_TRUE(contains(problem("a.gif", gif, 1u << 30), "more than the 1073741824 of --max-pixels"));
  EXPECT_TRUE(contains(problem("a.gif", gif, any), "announces 16 GiB of pixels")) << problem("a.gif", gif, any);
  for (const char* const chunk : {"VP8 ", "VP8L", "VP8X"}) {
    std::string webp = std::string("RIFF\x40\0\0\0WEBP", 12) + chunk + std::string(48, '\xff');
    EXPECT_TRUE(contains(problem("a.webp", webp, 1000), "more than the 1000 of --max-pixels")) << chunk;
  }
}

TEST(Images, LimitIsTheNumberOfPixels) {
  const test::TemporaryDir dir;
  const fs::path path = dir.path() / "a.exr";
  write_exr(path, Image(20, 10, {"R", "G", "B"}));
  EXPECT_EQ(read_image(path, ColorEncoding::automatic, 200).width, 20);
  EXPECT_TRUE(contains(error_text([&] { read_image(path, ColorEncoding::automatic, 199); }), "has 200 pixels"));
}

TEST(Images, BrokenOnesAreErrorsWithTheirName) {
  const test::TemporaryDir dir;
  const std::vector<std::string> broken{
      "", "GIF89a", "GIF89a" + std::string(200, '\xff'), test::gif_header(10, 10), test::png_header(10, 10), "RIFF\x10",
      std::string("II*\0\x08\0\0\0\xff\xff", 10), "P6 10 10 255\n", "PF\n-1 3\n-1\n", "#?RADIANCE\n\n-Y 5 +X 5\n",
      "8BPS" + std::string(30, '\xff'), "DDS " + std::string(124, '\x7f'), "\xff\xd8\xff\xe0",
      "BM" + std::string(60, '\x11'), std::string("\x76\x2f\x31\x01\x02\0\0\0", 8), "FOR4" + std::string(60, '\x22'),
      "SDPX" + std::string(3000, '\x33'),
      // A video file: OpenImageIO would open it, and the files that it names.
      "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nfile:///etc/passwd\n#EXT-X-ENDLIST\n"};
  for (const std::string& bytes : broken) {
    const fs::path path = dir.write("broken.gif", bytes);
    EXPECT_TRUE(error_text([&] { read_image(path); }).starts_with(path.string() + ": the file "))
        << bytes.substr(0, 12);
  }
}

// Kinds of images that are easily misread. The first four values of each are known.
TEST(Images, UnusualOnesAreReadOrRefused) {
  const test::TemporaryDir dir;
  // One bit per pixel: white, black, white, black.
  const fs::path bits = dir.write("bits.pbm", std::string("P4\n4 1\n\x50", 8));
  EXPECT_EQ(read_image(bits).pixels, (std::vector<float>{1, 0, 1, 0}));
  // 16 bits.
  const fs::path wide = dir.write("wide.pgm", std::string("P5\n2 1\n65535\n\xff\xff\0\0", 17));
  EXPECT_NEAR(read_image(wide, ColorEncoding::linear).pixels[0], 1, 1e-4f);
  OIIO::ImageSpec deep(2, 2, 1, OIIO::TypeDesc::FLOAT);
  deep.deep = true;
  OIIO::DeepData samples;
  samples.init(deep);
  const std::string name = (dir.path() / "deep.exr").string();
  const auto output = OIIO::ImageOutput::create(name);
  ASSERT_TRUE(output->open(name, deep) && output->write_deep_image(samples) && output->close());
  EXPECT_TRUE(contains(error_text([&] { read_image(name); }), "is a deep image"));
}

// A scene's folder, beside files that the scene may not read.
class Sandbox : public testing::Test {
 protected:
  Sandbox() {
    fs::create_directories(root() / "scene" / "below");
    fs::create_directories(root() / "scene-beside");
    dir_.write("secret.txt", "secret-word another\n");
    dir_.write("scene-beside/secret.txt", "secret-word another\n");
    dir_.write("scene/spectrum.txt", "400 1 700 1\n");
    dir_.write("scene/below/spectrum.txt", "400 1 700 1\n");
    fs::create_symlink(root() / "secret.txt", root() / "scene" / "link.txt");
    fs::create_symlink("../secret.txt", root() / "scene" / "relative-link.txt");
    fs::create_directory_symlink(root(), root() / "scene" / "folder");
    fs::create_symlink(root() / "none", root() / "scene" / "dangling.txt");
    fs::create_symlink("below/spectrum.txt", root() / "scene" / "inner-link.txt");
  }
  const fs::path& root() const { return dir_.path(); }

  std::string read(const std::string& name, const std::string& text) const {
    const fs::path path = dir_.write("scene/" + name, text);
    return error_text([&] { read_scene(path, {.sandbox = true}); });
  }
  // A complete scene with a directive after WorldBegin.
  std::string read(const std::string& directive) const {
    return read("a.pbrt", R"(Camera "perspective"
WorldBegin
)" + directive + "\n");
  }

  test::TemporaryDir dir_;
};

TEST_F(Sandbox, OnlyFilesInTheTreeAreReadWhateverNamesAndLinksSay) {
  const auto lamp = [](const std::string& file) { return R"(LightSource "point" "spectrum I" [ ")" + file + "\" ]"; };
  for (const std::string file : {"spectrum.txt", "below/spectrum.txt", "inner-link.txt", "below/../spectrum.txt"})
    EXPECT_EQ(read(lamp(file)), "no error") << file;
  EXPECT_EQ(read(lamp((fs::canonical(root()) / "scene/spectrum.txt").string())), "no error");
  const std::string expected = "no such file in the scene's folder";
  for (const std::string file : {"../secret.txt", "link.txt", "relative-link.txt", "folder/secret.txt", "dangling.txt",
                                 "../scene-beside/secret.txt", "below/../../secret.txt", "/etc/passwd", "/none",
                                 "../none", "/dev/zero", "/proc/self/environ"}) {
    const std::string problem = read(lamp(file));
    EXPECT_TRUE(contains(problem, expected)) << file << ": " << problem;
    EXPECT_FALSE(contains(problem, "secret-word")) << problem;
  }
}

TEST_F(Sandbox, HoldsForEveryKindOfFileThatASceneNames) {
  const std::string expected = "no such file in the scene's folder";
  for (const std::string directive :
       {R"(Include "../secret.txt")", R"(Import "link.txt")", R"(Shape "plymesh" "string filename" "link.txt")",
        R"(Material "measured" "string filename" "link.txt")"})
    EXPECT_TRUE(contains(read(directive), expected)) << read(directive);
  EXPECT_TRUE(contains(read("lens.pbrt", R"(Camera "realistic" "string lensfile" "link.txt"
WorldBegin
)"),
                       expected));
  EXPECT_TRUE(contains(read("a.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": "link.txt", "byteLength": 36}]})"),
                       expected));
  // The scene file itself.
  fs::create_symlink(root() / "secret.txt", root() / "scene" / "b.pbrt");
  EXPECT_TRUE(contains(error_text([&] { read_scene(root() / "scene" / "b.pbrt", {.sandbox = true}); }), expected));
  // Missing MTL files of OBJ files only give a warning.
  const fs::path obj = dir_.write("scene/a.obj", "mtllib ../secret.txt\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const SceneDescription scene = read_scene(obj, {.sandbox = true});
  ASSERT_FALSE(scene.warnings.empty());
  EXPECT_TRUE(contains(scene.warnings[0].message, expected)) << scene.warnings[0].message;
  for (const description::Warning& warning : scene.warnings) EXPECT_FALSE(contains(warning.message, "secret-word"));
  // Files that are not read have no hash, which would reveal whether they are some known file.
  for (const auto& [name, file] : scene.files) EXPECT_FALSE(file.hash.has_value()) << name;
}

TEST_F(Sandbox, MessagesShowNothingOfWhatIsInFiles) {
  dir_.write("scene/mistyped", R"(root:x:0:0 "root bash"
)");
  dir_.write("scene/mistyped.gltf", R"({"key": secretive})");
  dir_.write("scene/mistyped.ply", "ply\nformat root:x:0:0 1.0\n");
  dir_.write("scene/mistyped.mtl", "newmtl a\nKd root:x:0:0\n");
  const auto refused = [](const std::string& problem, const std::string& place) {
    EXPECT_TRUE(contains(problem, place)) << problem;
    EXPECT_FALSE(contains(problem, "root") || contains(problem, "secretive")) << problem;
  };
  refused(read(R"(Include "mistyped")"), R"(mistyped:1:1: unknown directive "...")");
  refused(read(R"(LightSource "point" "spectrum I" [ "mistyped" ])"),
          R"(mistyped:1:1: expected a number, found "...")");
  refused(read(R"(Shape "plymesh" "string filename" "mistyped.ply")"), "mistyped.ply:2:1: unknown encoding");
  refused(read("a.obj", "mtllib mistyped.mtl\n"), "mistyped.mtl:2:4: expected a number");
  refused(error_text([&] { read_scene(root() / "scene/mistyped.gltf", {.sandbox = true}); }), "mistyped.gltf:1:");
  // Without the sandbox, the same error shows the token.
  EXPECT_TRUE(contains(error_text([&] { read_scene(root() / "scene/mistyped.gltf"); }), "last read: \""));
}

TEST(Messages, ShowATokenOfAFileAtMost) {
  const test::TemporaryDir dir;
  const std::string run(1000, 'x');
  const auto problem = [&](const std::string& name, const std::string& text) {
    const fs::path path = dir.write(name, text);
    return error_text([&] { read_scene(path); });
  };
  for (const std::string& message :
       {problem("a.pbrt", run), problem("a.pbrt", "Camera \"" + run + "\""), problem("a.gltf", R"({"a": ")" + run),
        problem("a.gltf", R"({"a": )" + run + "}"), problem("a.obj", "v 1 2 " + run), problem("a.obj", "f " + run)}) {
    EXPECT_NE(message, "no error");
    EXPECT_FALSE(contains(message, run.substr(0, 33))) << message;
  }
  EXPECT_EQ(problem("a.pbrt", "\x1b[2J").find('\x1b'), std::string::npos);
  EXPECT_EQ(problem("a.pbrt", "Include \"\x1b[2J\"").find('\x1b'), std::string::npos);
  EXPECT_EQ(problem("a.gltf", "{\"a\": \x1b[2J}").find('\x1b'), std::string::npos);
}

TEST(Gltf, UrisThatLeaveTheFolderAreRefused) {
  const test::TemporaryDir dir;
  fs::create_directory(dir.path() / "models");
  dir.write("outside.bin", std::string(36, '\0'));
  dir.write("models/inside.bin", std::string(36, '\0'));
  const auto problem = [&](const std::string& uri) {
    const fs::path path =
        dir.write("models/a.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": ")" +
                                       uri + R"(", "byteLength": 36}]})");
    return error_text([&] { read_scene(path); });
  };
  EXPECT_EQ(problem("inside.bin"), "no error");
  EXPECT_EQ(problem("below/../inside.bin"), "no error");
  const std::string outside = (dir.path() / "outside.bin").string();
  for (const std::string& uri :
       {std::string("../outside.bin"), std::string("%2e%2e/outside.bin"), std::string("..%2Foutside.bin"),
        std::string("a/../../outside.bin"), std::string("..\\\\outside.bin"), outside, "file://" + outside,
        "%2F" + outside.substr(1)})
    EXPECT_TRUE(contains(problem(uri), "relative URIs that stay in the file's folder")) << uri << ": " << problem(uri);
  EXPECT_TRUE(contains(problem("inside.bin%00"), "no such file")) << problem("inside.bin%00");
}

}  // namespace
}  // namespace lanthorn::bounds_test
