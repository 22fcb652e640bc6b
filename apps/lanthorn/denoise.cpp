// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/denoise.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/image_file.h"
#include "lanthorn/state.h"
#include "output.h"
#include "output_check.h"
#include "render_arguments.h"
#include "report_json.h"

namespace lanthorn::program {

namespace {

namespace fs = std::filesystem;

struct DenoiseCommand {
  std::string input, output;
  bool replace = false;
  std::uint64_t max_pixels = FileAccess::default_max_pixels;
  OutputSettings settings;
};

struct Input {
  Image picture;
  nlohmann::json metadata;
  bool measures_exposure = false;
  std::optional<Image> around{};  // with a crop's margin
};

Input read_input(const DenoiseCommand& a) {
  if (fs::path(a.input).extension() == ".state") {
    const std::shared_ptr<RenderState> state = open_state(a.input);
    const StateSummary summary = summarize(*state);
    const MeasuredPicture measured = measured_picture_of(*state);
    return {with_noise(*state, measured.picture),
            metadata_of(summary, measured.error, a.settings.reproducible, nullptr), summary.record.measures_exposure,
            with_margin(*state)};
  }
  const std::string metadata = read_image_metadata(a.input);
  return {read_image(a.input, ColorEncoding::automatic, a.max_pixels),
          metadata.empty() ? nlohmann::json::object() : nlohmann::json::parse(metadata)};
}

DenoisedPicture denoise_file(const std::string& name, const Input& input) {
  try {
    return denoise(input.picture, input.around);
  } catch (const Error& e) {
    throw Error({name}, e.message);
  }
}

void run(const DenoiseCommand& a) {
  check_outputs({{a.input, "the picture"}}, {{a.output, "-o", picture_extensions()}}, a.settings.force);
  Input input = read_input(a);
  DenoisedPicture denoised = denoise_file(a.input, input);
  input.metadata["denoised_error"] = estimate_json(denoised.error);
  const bool beside = fs::path(a.output).extension() == ".exr" && !a.replace;
  write_picture(a.output, beside ? denoised.picture : with_denoised_light(denoised.picture), a.settings,
                input.measures_exposure, input.metadata.dump());
  announce("{}: {} without noise, error {}\n", a.output, a.input, describe_error(denoised.error));
}

OptionTable denoise_options(DenoiseCommand& a) {
  OptionTable table{required_file("input", a.input, "Picture (.exr) or state of a render"),
                    required_file("-o,--output", a.output, "Output file: .exr, .png, .jpg or .tif"),
                    {.names = "--replace",
                     .value = flag(a.replace),
                     .brief = "Write the denoised layers of an .exr in place of the noisy ones"}};
  table = joined(std::move(table), display_options(a.settings, "0; the scene's if the input is a state"));
  table.push_back({.names = "--reproducible",
                   .value = flag(a.settings.reproducible),
                   .brief = "Omit times from the file, so that equal images are equal files"});
  table.push_back(force_option(a.settings.force, "a write-protected file"));
  table.push_back(max_pixels_option(a.max_pixels));
  return table;
}

}  // namespace

void add_denoise(CLI::App& app) {
  const auto a = std::make_shared<DenoiseCommand>();
  constexpr const char* footer =
      "Applies render's --denoise to a finished picture. Each light layer is denoised separately; the layer denoised "
      "is their\n"
      "sum. It needs at least two passes, whose difference is the noise.\n\n"
      "Examples:\n"
      "  lanthorn denoise picture.exr -o clean.exr\n"
      "  lanthorn denoise render.state -o clean.png";
  add_command(app,
              {"denoise", "Remove the noise of a rendered picture", denoise_options(*a), footer, [a] { run(*a); }});
}

}  // namespace lanthorn::program
