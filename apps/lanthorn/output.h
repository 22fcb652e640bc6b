// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Writes a render to the files that the user requested, for both `render` and `merge`.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/denoise.h"
#include "lanthorn/image_file.h"
#include "lanthorn/state.h"
#include "lanthorn/statistics.h"
#include "options.h"

namespace lanthorn::program {

struct OutputSettings {
  DisplaySettings display;                ///< for all pictures but .exr, apart from its curve
  std::optional<ToneCurve> curve;         ///< nullopt: highlights where the exposure is measured, else none
  std::optional<bool> measures_exposure;  ///< of each picture; false: use the display's; nullopt: the scene decides
  bool reproducible = false;              ///< omit times from the files
  bool denoise = false;                   ///< .exr files also get the denoised layers, all others show them
  bool hints = true;                      ///< report the measured exposure, or suggest a better one
  bool force = false;  ///< replace states that hold something else, and files that are write-protected
};

/// Default of --exposure, for the help, if it depends on the scene's file.
inline constexpr const char* exposure_of_scene =
    "auto for glTF and OBJ files with lights, since they have no exposure; else 0";
ValueType<ToneCurve> view_transform_type();
/// The curve that applies if the exposure is measured or not.
ToneCurve curve_of(const OutputSettings& settings, bool is_measured);
/// --exposure, --view-transform and --ocio. `default_exposure`: for the help.
OptionTable display_options(OutputSettings& settings, const std::string& default_exposure);
/// The settings that correspond to a displayed picture. `film_measures`: measure the exposure if --exposure is not
/// given.
OutputSettings shown_as(const DisplaySettings& display, bool measures_exposure, bool film_measures);
/// --force. `files`: what it replaces besides write-protected files.
Option force_option(bool& force, const std::string& files);
/// --denoise. `brief`: for the help.
Option denoise_option(bool& denoise, const std::string& brief);
/// `display_options`, --denoise, --reproducible and --force.
OptionTable output_options(OutputSettings& settings);
/// -o, which may be given several times. `what`, `otherwise`: for the help.
Option outputs_option(std::vector<std::string>& outputs, const std::string& what, const std::string& otherwise);

/// Extensions of the files that `write_output` writes.
inline const std::vector<std::string> output_extensions = [] {
  std::vector<std::string> extensions = picture_extensions();
  extensions.emplace_back(".state");
  return extensions;
}();

/// An image file's metadata about its render. `statistics` may be null. `reproducible`: omits statistics and times.
nlohmann::json metadata_of(const StateSummary& state, const ErrorEstimate& error, bool reproducible,
                           const nlohmann::json& statistics);

/// Picture and error of a state, for all output files of a command: each is computed once, when a file needs it.
class StatePicture {
 public:
  /// `statistics`: of the render, if it has measured the error already. If there is an .exr among `files`, the picture
  /// has all layers, including those that a denoiser needs. `is_denoised`: .exr files also get the denoised layers, all
  /// others show them. `found`: if the render has denoised its picture already; left out if it has gone on since.
  StatePicture(const RenderState& state, const std::vector<std::filesystem::path>& files,
               const RenderStatistics& statistics = {}, bool is_denoised = false,
               std::optional<DenoisedLooks::Found> found = {});

  const RenderState& state() const { return state_; }
  const StateSummary& summary() const { return summary_; }
  const Image& image_for(const std::filesystem::path& file);
  /// Error of the picture before denoising.
  const ErrorEstimate& error();
  /// nullopt if the picture is not denoised.
  const std::optional<ErrorEstimate>& denoised_error();

 private:
  const Image& with_all_layers();
  void take(DenoisedPicture denoised);

  const RenderState& state_;
  StateSummary summary_;
  bool is_denoised_, needs_all_layers_;
  std::optional<Image> all_layers_, shown_;
  std::optional<ErrorEstimate> error_, denoised_error_;
};

/// The layers of a picture that this file stores: all layers for an .exr; for others only light, denoised if the
/// picture was denoised.
Image picture_for(const std::filesystem::path& file, const Image& image);

/// Writes the picture of a render in progress. Throws Error.
void write_preview(const std::filesystem::path& path, StatePicture& picture, const OutputSettings& settings);

/// Writes a picture. If the settings ask for hints, reports the measured exposure unless the file is an .exr, and warns
/// if many pixels are brighter than white or nearly all are black. `measures_exposure` applies if the settings leave it
/// open. Throws Error.
void write_picture(const std::filesystem::path& path, const Image& image, const OutputSettings& settings,
                   bool measures_exposure, const std::string& metadata);

/// Writes the picture (as `write_picture`) or the state itself, depending on the extension of `path`. `statistics`: of
/// the render, for an image's metadata; may be null. Throws Error.
void write_output(const std::filesystem::path& path, StatePicture& picture, const OutputSettings& settings,
                  const nlohmann::json& statistics = nullptr);

/// Warns if the film could not add some values exactly.
void report_film(const FilmReport& report);

}  // namespace lanthorn::program
