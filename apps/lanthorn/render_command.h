// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The command line of `render`, which `serve` and `view` also print for the picture that they show.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "options.h"
#include "render_arguments.h"
#include "render_output.h"
#include "scene_changes.h"
#include "value_types.h"

namespace lanthorn::program {

struct RenderCommand : RenderArguments, RenderFiles {
  SceneChanges changes;
  std::string tev;
  std::optional<double> preview_seconds;
  bool no_checkpoint = false, no_preview = false;
  std::optional<FrameRange> frames;
  std::optional<std::uint64_t> turntable;  ///< number of pictures around the model
};

OptionTable render_command_options(RenderCommand& arguments);

/// "lanthorn render room.pbrt -i vcm -o room.png", quoted for a shell.
std::string render_command_line(const RenderCommand& arguments);

// Several pictures with one command: an animation or a turntable.

/// Throws Error if the frames conflict with the rest of the command line.
void check_frames(const RenderCommand& arguments);
/// The frames to render; the end is excluded.
FrameRange frames_of(const RenderCommand& arguments);
/// The command for one frame: its number replaces "####" in file names, and the scene is evaluated at its time.
RenderCommand of_frame(const RenderCommand& arguments, std::uint64_t frame);

}  // namespace lanthorn::program
