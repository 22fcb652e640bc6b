// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Renders several pictures with one command: an animation or a turntable.
#pragma once

#include <cstdint>

#include "render_command.h"

namespace lanthorn::program {

/// Throws Error if the frames conflict with the rest of the command line.
void check_frames(const RenderCommand& arguments);
/// The frames to render; the end is excluded.
FrameRange frames_of(const RenderCommand& arguments);
/// The command for one frame: its number replaces "####" in file names, and the scene is evaluated at its time.
RenderCommand of_frame(const RenderCommand& arguments, std::uint64_t frame);

}  // namespace lanthorn::program
