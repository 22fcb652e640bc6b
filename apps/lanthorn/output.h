// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Writing a render to the files that the user asked for: the same for `render` and `merge`.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/image_file.h"
#include "lanthorn/state.h"

namespace lanthorn::program {

struct OutputSettings {
  DisplaySettings display;                ///< for .png
  std::optional<bool> measures_exposure;  ///< from each .png, instead of the display's; none: as the scene wants it
  bool reproducible = false;              ///< no times in the files
  bool hints = true;                      ///< says the measured exposure of a .png, or a better one if it is too bright
  bool force = false;  ///< replace states that hold something else, and files that are write-protected
};

/// Adds --exposure and --filmic. `default_exposure`: for the help. `settings` must outlive the parsing.
void add_display_options(CLI::App& command, OutputSettings& settings, const std::string& default_exposure);

/// Adds these, --reproducible and --force.
void add_output_options(CLI::App& command, OutputSettings& settings);

/// What `write_output` writes, by extension.
inline const std::vector<std::string> output_extensions{".exr", ".png", ".state"};

/// Writes the picture of a running render. Throws Error.
void write_preview(const std::filesystem::path& path, const RenderState& state, const OutputSettings& settings);

/// Writes a picture. Says the measured exposure of a .png, and warns if many of its pixels are brighter than white or
/// nearly all are black, if the settings say so. `measures_exposure`: unless the settings say whether. Throws Error.
void write_picture(const std::filesystem::path& path, const Image& image, const OutputSettings& settings,
                   bool measures_exposure, const std::string& metadata);

/// Writes the picture as `write_picture`, or the state itself, by the extension of `path`. `statistics`: of the render,
/// for an image's metadata; may be null. Throws Error.
void write_output(const std::filesystem::path& path, const RenderState& state, const OutputSettings& settings,
                  const nlohmann::json& statistics = nullptr);

/// Warns if the film could not add some values exactly.
void report_film(const FilmReport& report);

}  // namespace lanthorn::program
