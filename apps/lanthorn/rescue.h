// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Writes what was rendered, whatever fails.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/state.h"

namespace lanthorn::program {

/// Some files could not be written: a line for each.
struct OutputError : Error {
  using Error::Error;
};

enum class OutputKind { picture, state, report };

/// A file to be written: `write` throws if it cannot.
struct Output {
  std::filesystem::path path;
  OutputKind kind = OutputKind::picture;
  std::function<void()> write;
};

/// Writes all outputs, those after one that fails too; then `OutputError` names all that failed.
void write_all(const std::vector<Output>& outputs);

/// As `write_all`, for a render, which must not be lost. If a picture or the state cannot be written and no other
/// output is the state, saves the state under a name that nobody can guess, beside the failed output or else in the
/// user's folder for program states; the OutputError says where. If that fails too, says so and tries everything again
/// every ten seconds, until it succeeds or a signal comes.
void write_outputs(const std::vector<Output>& outputs, const RenderState& state);

}  // namespace lanthorn::program
