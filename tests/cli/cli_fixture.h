// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Runs the program in a separate folder, and checks exit codes, messages and files.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lanthorn/image_file.h"
#include "support/child_process.h"

namespace lanthorn {

namespace fs = std::filesystem;
using test::ChildProcess;
using test::Ending;
using test::file_bytes;
using Words = std::vector<std::string>;

// A glass ball on a floor under an area light, and a spot light: direct, indirect and caustic light, and a visible
// light.
inline const char* const tiny_scene = R"(LookAt 0 1 4.4  0 1 0  0 1 0
Camera "perspective" "float fov" [40]
Film "rgb" "string filename" "tiny.exr" "integer xresolution" [16] "integer yresolution" [16]
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [17 12 4]
  Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-0.4 1.9 -0.4 0.4 1.9 -0.4 0.4 1.9 0.4 -0.4 1.9 0.4]
AttributeEnd
LightSource "spot" "rgb I" [1 2 3] "point3 from" [0 1.8 0.9] "point3 to" [0 0 0]
Material "diffuse" "rgb reflectance" [0.7 0.6 0.5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 0 1 1 0 1 1 0 -1 -1 0 -1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 0 -1 1 0 -1 1 2 -1 -1 2 -1]
AttributeBegin
  Material "dielectric" "float eta" [1.5]
  Translate 0.2 0.4 0.2
  Shape "sphere" "float radius" [0.4]
AttributeEnd
)";

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A temporary folder that contains only `tiny.pbrt`, in which the program runs.
class Cli : public testing::Test {
 protected:
  Cli() { dir_.write("tiny.pbrt", tiny_scene); }

  Ending run(const Words& words) const {
    Ending ending = ChildProcess(LANTHORN_PROGRAM, words, dir_.path()).wait();
    // The warning means that a render lost light, which no test may cause.
    EXPECT_FALSE(contains(ending.err, "samples were not finite")) << testing::PrintToString(words) << '\n'
                                                                  << ending.err;
    return ending;
  }

  /// Runs the program in a shell, for redirections and limits. In `command`, L is the program; `exec L` lets signals
  /// reach it.
  static Words shell(const std::string& command) {
    return {"-c", "L() { exec '" LANTHORN_PROGRAM R"(' "$@"; }
)" + command};
  }
  Ending run_shell(const std::string& command) const {
    return ChildProcess("/bin/sh", shell(command), dir_.path()).wait();
  }

  Ending succeed(const Words& words) const {
    Ending ending = run(words);
    EXPECT_EQ(ending.exit_code, 0) << testing::PrintToString(words) << " signal " << ending.signal << '\n'
                                   << ending.err;
    return ending;
  }

  /// The program must exit with 2, print one clear line that contains `says`, and leave the folder unchanged.
  std::string refuse(const Words& words, const std::string& says) const {
    const Words before = files();
    const Ending ending = run(words);
    const std::string shown = testing::PrintToString(words) + " said: " + ending.err;
    EXPECT_EQ(ending.exit_code, 2) << shown << " signal " << ending.signal;
    EXPECT_TRUE(contains(ending.err, says)) << shown << "\ninstead of: " << says;
    std::string message = ending.err;
    const std::string hint = "Run with --help for more information.\n";
    if (message.ends_with(hint)) message.resize(message.size() - hint.size());
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << shown;
    EXPECT_LT(message.size(), 300u) << shown;
    EXPECT_EQ(ending.out, "") << shown;
    EXPECT_EQ(files(), before) << shown;
    return ending.err;
  }

  /// `render tiny.pbrt` with few photons, no progress and no times in the files.
  static Words render(const Words& more) {
    return Words{"render", "tiny.pbrt", "--photons", "300", "--quiet", "--reproducible"} + more;
  }

  Words files() const {
    Words names;
    for (const auto& entry : fs::recursive_directory_iterator(dir_.path()))
      names.push_back(entry.path().lexically_relative(dir_.path()).string());
    std::sort(names.begin(), names.end());
    return names;
  }
  fs::path path(const std::string& name) const { return dir_.path() / name; }
  std::string bytes(const std::string& name) const { return file_bytes(path(name)); }
  nlohmann::json json(const std::string& name) const {
    return nlohmann::json::parse(bytes(name), nullptr, /*allow_exceptions=*/false);
  }
  /// The settings in the picture `name`.
  nlohmann::json metadata_of(const std::string& name) const {
    return nlohmann::json::parse(read_image_metadata(path(name)));
  }
  void expect_equal_files(const std::string& a, const std::string& b) const {
    EXPECT_FALSE(bytes(a).empty()) << a;
    EXPECT_TRUE(bytes(a) == bytes(b)) << a << " and " << b << " differ";
  }

  test::TemporaryDir dir_;
};

}  // namespace lanthorn
