// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Saves what was rendered, whatever fails.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/state.h"

namespace lanthorn::program {

/// Some files could not be written; the message has one line for each.
struct OutputError : Error {
  using Error::Error;
};

enum class OutputKind { picture, state, report };

/// A file to be written; `write` throws on failure.
struct Output {
  std::filesystem::path path;
  OutputKind kind = OutputKind::picture;
  std::function<void()> write;
};

/// Writes all outputs, continuing after failures; then throws an `OutputError` that names all that failed.
void write_all(const std::vector<Output>& outputs);

/// As `write_all`, for a render that must not be lost. If a picture or the state cannot be written and no other output
/// is the state, saves the state under an unpredictable name, beside the failed output or else in the user's folder for
/// program states; the OutputError says where. If that fails too, reports it and retries everything every ten seconds
/// until it succeeds or a signal arrives.
void write_outputs(const std::vector<Output>& outputs, const RenderState& state);

}  // namespace lanthorn::program
