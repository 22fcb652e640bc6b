// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// `render` under mpirun: several processes share the passes of one picture.
#pragma once

#include <functional>
#include <optional>

#include "lanthorn/team.h"
#include "render_command.h"

namespace lanthorn::program {

/// Runs `work` with the team that this process belongs to; null if it is alone. All processes but the one of rank 0 are
/// mute, obey no signals, and write nothing. If one fails, rank 0 says why, and all end with the same exit code.
void run_in_team(RenderCommand& arguments, const std::function<void(Team*)>& work);

/// False for processes of a team that leave files and messages to another.
inline bool is_first(const Team* team) { return !team || team->link.rank == 0; }

}  // namespace lanthorn::program
