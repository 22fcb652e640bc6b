// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "output.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <string>

#include "lanthorn/version.h"
#include "quantities.h"

namespace lanthorn {

namespace fs = std::filesystem;

namespace {

nlohmann::json metadata_of(const StateSummary& state, bool reproducible, const nlohmann::json& statistics) {
  const nlohmann::json settings = nlohmann::json::parse(state.settings);
  nlohmann::json metadata = settings.value("identity", nlohmann::json::object());
  if (settings.contains("scene")) metadata["scene"] = settings["scene"];
  metadata["version"] = version;
  metadata["passes"] = state.pass_count;
  if (reproducible) return metadata;
  metadata["seconds"] = state.seconds;
  if (!statistics.is_null()) metadata["statistics"] = statistics;
  return metadata;
}

}  // namespace

void add_output_options(CLI::App& command, OutputSettings& settings) {
  add_number_option(command, "--exposure", "For .png: stops of exposure. Default: 0", {-64, 64},
                    into(settings.display.exposure));
  command.add_flag_callback(
      "--filmic", [&settings] { settings.display.curve = ToneCurve::filmic; },
      "For .png: a filmic tone curve instead of clipping");
  command.add_flag("--reproducible", settings.reproducible,
                   "Leave times out of the files, so that equal images are equal files");
  command.add_flag("--force", settings.force,
                   "Replace a .state that holds another render or more passes, and write-protected files");
}

void write_output(const fs::path& path, const RenderState& state, const OutputSettings& settings,
                  const nlohmann::json& statistics) {
  if (path.extension() == ".state") return save_state(state, path, {.times = !settings.reproducible});
  const nlohmann::json metadata = metadata_of(summarize(state), settings.reproducible, statistics);
  write_image(path, picture_of(state), settings.display, metadata.dump());
}

void report_film(const FilmReport& report) {
  if (const auto problem = describe_problems(report)) spdlog::warn("{}", *problem);
}

}  // namespace lanthorn
