// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Writing what was rendered, whatever fails.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "lanthorn/state.h"

namespace lanthorn {

enum class OutputKind { picture, state, report };

/// A file to be written: `write` throws if it cannot.
struct Output {
  std::filesystem::path path;
  OutputKind kind = OutputKind::picture;
  std::function<void()> write;
};

/// Writes all outputs, those after one that fails too; then `lanthorn::Error` names all that failed.
void write_all(const std::vector<Output>& outputs);

/// The same for a render, which is not lost. If a picture or the state is among what failed and no other output is the
/// state, the state is saved under a name that nobody can guess: beside the output that failed, else in the user's
/// folder for states of programs; the Error says where. If not even that can be written, it says so and tries
/// everything again every ten seconds, until it succeeds or a signal comes.
void write_outputs(const std::vector<Output>& outputs, const RenderState& state);

}  // namespace lanthorn
