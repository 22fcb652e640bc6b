// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Writing a render to the files that the user asked for: the same for `render` and `merge`.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/image_file.h"
#include "lanthorn/state.h"
#include "lanthorn/statistics.h"
#include "options.h"

namespace lanthorn::program {

struct OutputSettings {
  DisplaySettings display;                ///< of all pictures but .exr
  std::optional<bool> measures_exposure;  ///< from each of them, instead of the display's; none: as the scene wants it
  bool reproducible = false;              ///< no times in the files
  bool denoise = false;                   ///< .exr files have the denoised layers, too, all others show them
  bool hints = true;                      ///< says the measured exposure, or a better one if it is too bright
  bool force = false;  ///< replace states that hold something else, and files that are write-protected
};

/// The default of --exposure, for the help, where it depends on the scene's file.
inline constexpr const char* exposure_of_scene =
    "auto for glTF and OBJ files with lights, since they have no exposure; else 0";
ValueType<ToneCurve> view_transform_type();
/// --view-transform.
Option view_transform_option(DisplaySettings& display);
/// --exposure, --view-transform and --ocio. `default_exposure`: for the help.
OptionTable display_options(OutputSettings& settings, const std::string& default_exposure);
/// The settings of a picture that is shown like this. `film_measures`: without --exposure, the exposure is measured.
OutputSettings shown_as(const DisplaySettings& display, bool measures_exposure, bool film_measures);
/// --force. `files`: what it replaces besides write-protected files.
Option force_option(bool& force, const std::string& files);
/// --denoise. `brief`: for the help.
Option denoise_option(bool& denoise, const std::string& brief);
/// These, --denoise and --reproducible.
OptionTable output_options(OutputSettings& settings);
/// -o, which may be given several times. `what`, `otherwise`: for the help.
Option outputs_option(std::vector<std::string>& outputs, const std::string& what, const std::string& otherwise);

/// What `write_output` writes, by extension.
inline const std::vector<std::string> output_extensions = [] {
  std::vector<std::string> extensions = picture_extensions();
  extensions.emplace_back(".state");
  return extensions;
}();

/// What an image file says of the render that it shows. `statistics` may be null. `reproducible`: without them and
/// times.
nlohmann::json metadata_of(const StateSummary& state, const ErrorEstimate& error, bool reproducible,
                           const nlohmann::json& statistics);

/// The picture of a state and its error, for the files of a command: each is made once, when a file needs it.
class StatePicture {
 public:
  /// `statistics`: of the render, which may have measured the error. An .exr among `files` has all layers, and those
  /// that a denoiser needs. `is_denoised`: .exr files have the denoised layers, too, all others show them.
  StatePicture(const RenderState& state, const std::vector<std::filesystem::path>& files,
               const RenderStatistics& statistics = {}, bool is_denoised = false);

  const RenderState& state() const { return state_; }
  const StateSummary& summary() const { return summary_; }
  const Image& image_for(const std::filesystem::path& file);
  /// Of the picture before it is denoised.
  const ErrorEstimate& error();
  /// Nothing if it is not denoised.
  const std::optional<ErrorEstimate>& denoised_error();

 private:
  const Image& with_all_layers();

  const RenderState& state_;
  StateSummary summary_;
  bool is_denoised_, needs_all_layers_;
  std::optional<Image> all_layers_, shown_;
  std::optional<ErrorEstimate> error_, denoised_error_;
};

/// The layers of a picture that are written to this file: all of them to an .exr; to others light, without its noise if
/// it was denoised.
Image picture_for(const std::filesystem::path& file, const Image& image);

/// Writes the picture of a running render. Throws Error.
void write_preview(const std::filesystem::path& path, StatePicture& picture, const OutputSettings& settings);

/// Writes a picture. Says the measured exposure unless it is an .exr, and warns if many of its pixels are brighter than
/// white or nearly all are black, if the settings say so. `measures_exposure`: unless the settings say whether. Throws
/// Error.
void write_picture(const std::filesystem::path& path, const Image& image, const OutputSettings& settings,
                   bool measures_exposure, const std::string& metadata);

/// Writes the picture as `write_picture`, or the state itself, by the extension of `path`. `statistics`: of the render,
/// for an image's metadata; may be null. Throws Error.
void write_output(const std::filesystem::path& path, StatePicture& picture, const OutputSettings& settings,
                  const nlohmann::json& statistics = nullptr);

/// Warns if the film could not add some values exactly.
void report_film(const FilmReport& report);

}  // namespace lanthorn::program
