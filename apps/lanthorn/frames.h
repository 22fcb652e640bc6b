// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Several pictures by one command: of an animation, or from all around a model.
#pragma once

#include <cstdint>

#include "render_command.h"

namespace lanthorn::program {

/// Throws Error for frames that do not go with the rest of the command line.
void check_frames(const RenderCommand& arguments);
/// The frames to render, whose end is excluded.
FrameRange frames_of(const RenderCommand& arguments);
/// The command for one frame: its number stands in the names of its files, and its time is that of the scene.
RenderCommand of_frame(const RenderCommand& arguments, std::uint64_t frame);

}  // namespace lanthorn::program
