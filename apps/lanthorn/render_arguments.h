// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The options of all commands that render: what decides the picture.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "lanthorn/render_options.h"
#include "lanthorn/scene.h"

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
}  // namespace CLI

namespace lanthorn::program {

/// What the command line says, as text where it needs more than CLI11's conversions.
struct RenderArguments {
  std::string scene;
  RenderOptions options;
  std::string color, resolution, crop;
  std::vector<std::string> set;
  unsigned threads = 0;
  ReadOptions reading;
};

/// How far a scene is trusted: --sandbox, --max-pixels.
void add_read_options(CLI::App& command, ReadOptions& options);
/// --max-pixels: of each picture that is read.
void add_max_pixels(CLI::App& command, std::uint64_t& max_pixels);

/// The scene and the options that go with it. `passes` is left to the command.
void add_render_arguments(CLI::App& command, RenderArguments& arguments);

/// What of the command line decides the picture, besides -i, -r, -n, -s, -d and --set: " --crop 0,0,8,8 --missing
/// skip", quoted for a shell, or nothing.
std::string text_of_other_options(const RenderArguments& arguments);

/// Throws Error for what is not of the form that the help describes.
RenderOptions parse_render_arguments(const RenderArguments& arguments);

/// Random numbers identify a pass by 32 bits: later passes would repeat earlier ones.
inline constexpr std::uint64_t most_passes = std::numeric_limits<std::uint32_t>::max();

}  // namespace lanthorn::program
