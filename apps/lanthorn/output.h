// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Writing a render to the files that the user asked for: the same for `render` and `merge`.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "film/display.h"
#include "render/state.h"

namespace lanthorn {

struct OutputSettings {
  DisplaySettings display;    ///< for .png
  bool reproducible = false;  ///< no times in the files
};

/// Adds --exposure, --filmic and --reproducible. `settings` must outlive the parsing.
void add_output_options(CLI::App& command, OutputSettings& settings);

/// Refuses (`lanthorn::Error`) names that end in none of .exr, .png and .state, and folders that cannot be written to.
void check_output(const std::filesystem::path& path);
/// The same for the folder alone; `option`: what the user said it with.
void check_folder_of(const char* option, const std::filesystem::path& path);

/// Writes the picture, or the state itself, by the extension of `path`. `statistics`: of the render, for an image's
/// metadata; may be null. Throws Error.
void write_output(const std::filesystem::path& path, const RenderState& state, const OutputSettings& settings,
                  const nlohmann::json& statistics = nullptr);

/// Warns of what the film could not add exactly.
void report_film(const FilmReport& report);

}  // namespace lanthorn
