// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// `render` under mpirun: several processes share the passes of one picture.
#pragma once

#include <functional>
#include <optional>

#include "lanthorn/team.h"
#include "render_command.h"

namespace lanthorn::program {

/// Runs `work` with the team of this process; null if it is alone. Processes of ranks other than 0 are mute, ignore
/// signals, and write nothing. If one fails, rank 0 reports why, and all end with the same exit code.
void run_in_team(RenderCommand& arguments, const std::function<void(Team*)>& work);

/// False for processes of a team that leave files and messages to rank 0.
inline bool is_first(const Team* team) { return !team || team->link.rank == 0; }

}  // namespace lanthorn::program
