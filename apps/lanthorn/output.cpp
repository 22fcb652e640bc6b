// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "console.h"
#include "lanthorn/file.h"
#include "lanthorn/version.h"
#include "report_json.h"

namespace lanthorn::program {

namespace fs = std::filesystem;

nlohmann::json metadata_of(const StateSummary& state, const ErrorEstimate& error, bool reproducible,
                           const nlohmann::json& statistics) {
  const nlohmann::json settings = settings_json(state.record);
  nlohmann::json metadata = settings.at("identity");
  if (settings.contains("scene")) metadata["scene"] = settings["scene"];
  if (const auto findings = settings.find("findings"); findings != settings.end()) {
    metadata["findings"] = *findings;
    metadata["findings"].erase("everywhere");
  }
  if (state.record.display_emission) metadata["display_emission"] = true;
  metadata["version"] = version;
  metadata["passes"] = state.pass_count;
  if (state.cut_share > 0) metadata["cut_share"] = state.cut_share;
  metadata["error"] = estimate_json(error);
  if (reproducible) return metadata;
  metadata["seconds"] = state.seconds;
  if (!statistics.is_null()) metadata["statistics"] = statistics;
  return metadata;
}

namespace {

bool has_layers(const fs::path& path) { return lower_extension(path) == ".exr"; }

std::vector<float> brightest_channels(const Image& color) {
  std::vector<float> brightest;
  for (std::size_t i = 0; i + 2 < color.pixels.size(); i += 3)
    brightest.push_back(std::max({color.pixels[i], color.pixels[i + 1], color.pixels[i + 2]}));
  return brightest;
}

double share_above(float level, const std::vector<float>& values) {
  const auto above = std::count_if(values.begin(), values.end(), [level](float x) { return x > level; });
  return static_cast<double>(above) / static_cast<double>(std::max<std::size_t>(1, values.size()));
}

// Up to 1 % of the pixels may be brighter than white, because visible lights are. If no more than that fraction of the
// pixels differs from black in eight bits, although there is light, the picture looks black.
void warn_of_exposure(const fs::path& path, const Image& image, const DisplaySettings& display) {
  constexpr double few = 0.01;
  constexpr float nearly_black = 1.0f / 256, most_stops_of_gloom = 6;
  const auto color = select_layer(image, "color");
  if (!color) return;
  std::vector<float> brightest = brightest_channels(*color);
  const float white = std::exp2(-display.exposure);
  if (share_above(nearly_black * white, brightest) <= few) {
    if (const float stops = measured_exposure(image); stops > display.exposure + most_stops_of_gloom)
      warn("{}: the picture is nearly black: --exposure {:.1f} shows it", path.string(), stops);
    return;
  }
  const double clipped = share_above(white, brightest);
  if (clipped <= few || display.curve != ToneCurve::none || display.ocio) return;
  const auto bright =
      brightest.begin() + static_cast<std::ptrdiff_t>((1 - few) * static_cast<double>(brightest.size()));
  std::nth_element(brightest.begin(), bright, brightest.end());
  warn(
      "{}: {:.0f} % of the pixels are brighter than white: --exposure {:.1f} or --view-transform highlights shows them",
      path.string(), 100 * clipped, std::floor(-10 * std::log2(static_cast<double>(*bright))) / 10);
}

}  // namespace

namespace {

// CONFIG, or CONFIG:DISPLAY/VIEW.
ValueType<OcioView> ocio_type() {
  const auto parse = [](std::string_view text) -> std::optional<OcioView> {
    if (text.empty()) return std::nullopt;
    const std::size_t colon = text.rfind(':');
    const std::string_view after = colon == text.npos ? std::string_view() : text.substr(colon + 1);
    const std::size_t slash = after.find('/');
    if (slash == after.npos || colon == 0) return OcioView{std::string(text), "", ""};
    return OcioView{std::string(text.substr(0, colon)), std::string(after.substr(0, slash)),
                    std::string(after.substr(slash + 1))};
  };
  return {"CONFIG[:DISPLAY/VIEW]", "the file of an OpenColorIO configuration, or CONFIG:DISPLAY/VIEW", parse,
          [](const OcioView& ocio) {
            return ocio.display.empty() ? ocio.config : fmt::format("{}:{}/{}", ocio.config, ocio.display, ocio.view);
          }};
}

}  // namespace

OptionTable display_options(OutputSettings& settings, const std::string& default_exposure) {
  using Stops = std::optional<float>;  // nullopt: measured
  const auto set = [&settings](Stops stops) {
    settings.measures_exposure = !stops;
    settings.display.exposure = stops.value_or(0);
  };
  const auto get = [&settings]() -> std::optional<Stops> {
    if (!settings.measures_exposure) return std::nullopt;
    return *settings.measures_exposure ? Stops() : Stops(settings.display.exposure);
  };
  constexpr double most = DisplaySettings::largest_exposure;
  return {{.names = "--exposure",
           .value = through<Stops>(number_or_word_type({-most, most}, "auto"), set, get),
           .brief = "Exposure in stops, or auto; .exr files do not change",
           .details = "auto makes a white surface in the picture's light white and prints the number.",
           .otherwise = default_exposure},
          {.names = "--view-transform",
           .value = into(settings.curve, view_transform_type()),
           .brief = "Tone curve for bright colours",
           .details = "none clips them; highlights compresses only what is bright, as far as the brightest part of the "
                      "picture needs; filmic rolls colours off; agx also desaturates them, as film does.",
           .otherwise = "highlights where the exposure is measured, else none"},
          {.names = "--ocio",
           .value = into(settings.display.ocio, ocio_type()),
           .brief = "Use a view of an OpenColorIO configuration instead",
           .details = "It replaces --view-transform. CONFIG is a file; without DISPLAY/VIEW, the configuration's "
                      "defaults apply. The exposure is applied before."}};
}

ValueType<ToneCurve> view_transform_type() {
  return choice_type<ToneCurve>({{"none", ToneCurve::none},
                                 {"highlights", ToneCurve::highlights},
                                 {"filmic", ToneCurve::filmic},
                                 {"agx", ToneCurve::agx}});
}

ToneCurve curve_of(const OutputSettings& settings, bool is_measured) {
  return settings.curve.value_or(is_measured ? ToneCurve::highlights : ToneCurve::none);
}

OutputSettings shown_as(const DisplaySettings& display, bool measures_exposure, bool film_measures) {
  OutputSettings settings;
  settings.display = display;
  const bool is_default = measures_exposure ? film_measures : !film_measures && display.exposure == 0;
  if (!is_default) settings.measures_exposure = measures_exposure;
  if (display.curve != curve_of({}, measures_exposure)) settings.curve = display.curve;
  return settings;
}

Option force_option(bool& force, const std::string& files) {
  return {.names = "--force", .value = flag(force), .brief = "Replace " + files};
}

Option denoise_option(bool& denoise, const std::string& brief) {
  return {.names = "--denoise",
          .value = flag(denoise),
          .brief = brief,
          .details =
              ".exr files get the layers denoised, denoised.direct and so on beside the noisy ones; .png, .jpg and "
              ".tif show the denoised picture."};
}

OptionTable output_options(OutputSettings& settings) {
  return joined(
      display_options(settings, exposure_of_scene),
      {{.names = "--reproducible",
        .value = flag(settings.reproducible),
        .brief = "Omit times from the files, so that equal pictures are equal files"},
       denoise_option(settings.denoise, "Remove the remaining noise, layer by layer"),
       force_option(settings.force, "a .state that holds another render or more passes, and write-protected files")});
}

Option outputs_option(std::vector<std::string>& outputs, const std::string& what, const std::string& otherwise) {
  return {
      .names = "-o,--output",
      .value = each_into(outputs, text_type("FILE")),
      .brief = what + " (.exr, .png, .jpg, .tif, .state; repeatable)",
      .details = ".exr holds all layers; .png, .jpg and .tif (16 bits) hold color; a .state can be resumed or merged.",
      .otherwise = otherwise};
}

namespace {

// Metadata of EXR files are read back as text.
bool displays_emission(const std::string& metadata) {
  const nlohmann::json members = metadata.empty() ? nlohmann::json::object() : nlohmann::json::parse(metadata);
  const auto found = members.find("display_emission");
  return found != members.end() && (*found == true || *found == "true");
}

// Returns the display settings that apply unless the file is an .exr.
DisplaySettings write(const fs::path& path, const Image& image, const OutputSettings& settings, bool measures_exposure,
                      const std::string& metadata) {
  DisplaySettings display = settings.display;
  display.display_emission = displays_emission(metadata);
  display.curve = curve_of(settings, measures_exposure);
  if (measures_exposure) display.exposure = measured_exposure(image);
  write_image(path, image, display, metadata);
  return display;
}

}  // namespace

StatePicture::StatePicture(const RenderState& state, const std::vector<fs::path>& files,
                           const RenderStatistics& statistics, bool is_denoised,
                           std::optional<DenoisedLooks::Found> found)
    : state_(state), summary_(summarize(state)), is_denoised_(is_denoised && summary_.pass_count > 1) {
  if (is_denoised && !is_denoised_)
    warn("a picture of a single pass is not denoised: the noise is measured from differences between passes");
  needs_all_layers_ = is_denoised_ || std::any_of(files.begin(), files.end(), has_layers);
  // While a picture is denoised, the statistics may have the error of the denoised one.
  if (!is_denoised_ && statistics.error_passes == summary_.pass_count) error_ = statistics.error;
  if (is_denoised_ && found && found->passes == summary_.pass_count) {
    error_ = std::move(found->error);
    take(std::move(found->denoised));
  }
}

void StatePicture::take(DenoisedPicture denoised) {
  denoised_error_ = std::move(denoised.error);
  all_layers_ = std::move(denoised.picture);
}

const Image& StatePicture::with_all_layers() {
  if (all_layers_) return *all_layers_;
  MeasuredPicture measured = measured_picture_of(state_);
  error_ = std::move(measured.error);
  all_layers_ = with_noise(state_, measured.picture);
  if (is_denoised_) take(denoise(*all_layers_, with_margin(state_)));
  return *all_layers_;
}

const Image& StatePicture::image_for(const fs::path& file) {
  if (has_layers(file)) return with_all_layers();
  if (!shown_) shown_ = needs_all_layers_ ? picture_for(file, with_all_layers()) : picture_without_error(state_);
  return *shown_;
}

const ErrorEstimate& StatePicture::error() {
  if (!error_) needs_all_layers_ ? void(with_all_layers()) : void(error_ = estimate_error(state_));
  return *error_;
}

const std::optional<ErrorEstimate>& StatePicture::denoised_error() {
  if (is_denoised_) with_all_layers();
  return denoised_error_;
}

Image picture_for(const fs::path& file, const Image& image) {
  return has_layers(file) ? image : with_denoised_light(image);
}

void write_preview(const fs::path& path, StatePicture& picture, const OutputSettings& settings) {
  const StateSummary& summary = picture.summary();
  write(path, picture.image_for(path), settings, settings.measures_exposure.value_or(summary.record.measures_exposure),
        metadata_of(summary, picture.error(), settings.reproducible, nullptr).dump());
}

void write_picture(const fs::path& path, const Image& image, const OutputSettings& settings, bool measures_exposure,
                   const std::string& metadata) {
  const bool is_measured = settings.measures_exposure.value_or(measures_exposure);
  const DisplaySettings display = write(path, image, settings, is_measured, metadata);
  if (!settings.hints || has_layers(path)) return;
  if (is_measured)
    announce("{}: --exposure {:.1f}{}, measured from the picture\n", path.string(), display.exposure,
             settings.curve || display.ocio ? "" : " --view-transform highlights");
  else
    warn_of_exposure(path, image, display);
}

void write_output(const fs::path& path, StatePicture& picture, const OutputSettings& settings,
                  const nlohmann::json& statistics) {
  if (path.extension() == ".state") return save_state(picture.state(), path, {.times = !settings.reproducible});
  const StateSummary& summary = picture.summary();
  nlohmann::json metadata = metadata_of(summary, picture.error(), settings.reproducible, statistics);
  if (picture.denoised_error()) metadata["denoised_error"] = estimate_json(*picture.denoised_error());
  write_picture(path, picture.image_for(path), settings, summary.record.measures_exposure, metadata.dump());
}

void report_film(const FilmReport& report) {
  if (const auto problem = describe_problems(report)) warn("{}", *problem);
}

}  // namespace lanthorn::program
