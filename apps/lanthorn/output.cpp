// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "output.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/image.h"
#include "lanthorn/version.h"
#include "quantities.h"
#include "render/render.h"

namespace lanthorn {

namespace fs = std::filesystem;

ImageWindow window_of(const RenderState& state) {
  const nlohmann::json identity = state.settings.value("identity", nlohmann::json::object());
  const auto integers = [&](const char* name, std::size_t count) -> std::optional<std::vector<int>> {
    const auto found = identity.find(name);
    if (found == identity.end() || !found->is_array() || found->size() != count) return std::nullopt;
    std::vector<int> values;
    for (const auto& value : *found) {
      if (!value.is_number_unsigned() || value.get<std::uint64_t>() > 1u << 20) return std::nullopt;
      values.push_back(value.get<int>());
    }
    return values;
  };
  const auto resolution = integers("resolution", 2), crop = integers("crop", 4);
  if (!resolution || !crop) return {};
  return {(*crop)[0], (*crop)[1], (*resolution)[0], (*resolution)[1]};
}

namespace {

nlohmann::json metadata_of(const RenderState& state, bool reproducible, const nlohmann::json& statistics) {
  nlohmann::json metadata = state.settings.value("identity", nlohmann::json::object());
  if (state.settings.contains("scene")) metadata["scene"] = state.settings["scene"];
  metadata["version"] = version;
  metadata["passes"] = state.pass_count();
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
  if (path.extension() == ".state") {
    RenderState saved = state;
    if (settings.reproducible) saved.seconds = 0;
    return save_state(saved, path);
  }
  Image image = state.film.resolve(state.pass_count());
  image.window = window_of(state);
  write_image(path, image, settings.display, metadata_of(state, settings.reproducible, statistics));
}

void report_film(const FilmReport& report) {
  if (const auto problem = describe_problems(report)) spdlog::warn("{}", *problem);
}

}  // namespace lanthorn
