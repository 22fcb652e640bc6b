// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "io/image.h"
#include "lanthorn/error.h"
#include "lanthorn/version.h"
#include "render/state.h"

namespace lanthorn {
namespace {

namespace fs = std::filesystem;

struct MergeOptions {
  std::vector<std::string> inputs;
  std::string output;
  DisplaySettings display;
  bool filmic = false;
};

/// Where the film lies in the whole picture; a state without these settings is taken as whole.
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

void write_result(const MergeOptions& o, const RenderState& state) {
  const fs::path path = o.output;
  if (path.extension() == ".state") return save_state(state, path);
  Image image = state.film.resolve(state.pass_count());
  image.window = window_of(state);
  nlohmann::json metadata = state.settings.value("identity", nlohmann::json::object());
  if (state.settings.contains("scene")) metadata["scene"] = state.settings["scene"];
  metadata["version"] = version;
  metadata["passes"] = state.pass_count();
  metadata["seconds"] = state.seconds;
  DisplaySettings display = o.display;
  if (o.filmic) display.curve = ToneCurve::filmic;
  write_image(path, image, display, metadata);
}

void run(const MergeOptions& o) {
  const std::string extension = fs::path(o.output).extension().string();
  if (extension != ".state" && extension != ".exr" && extension != ".png")
    throw Error({o.output}, "its name must end in .state (to go on or to merge again), .exr (all layers) or .png");
  RenderState merged = load_state(o.inputs.front());
  for (std::size_t i = 1; i < o.inputs.size(); ++i) {
    const RenderState next = load_state(o.inputs[i]);
    try {
      merged = merge_states(merged, next);
    } catch (const Error& e) {
      throw Error({o.inputs[i]}, e.message);
    }
  }
  write_result(o, merged);
  fmt::print("{}: {} passes of {} from {} files\n", o.output, merged.pass_count(), merged.integrator, o.inputs.size());
  const FilmReport report = merged.film.report();
  if (!report.clean())
    fmt::print(stderr, "lanthorn: {} values were NaN or infinite, {} too large; {} sums are saturated\n",
               report.non_finite, report.too_large, report.saturated);
}

}  // namespace

void add_merge(CLI::App& app) {
  auto o = std::make_shared<MergeOptions>();
  CLI::App* command = app.add_subcommand("merge", "Put shards of one render (files of --pass-range) together, exactly");
  command->add_option("STATES", o->inputs, "Saved states with disjoint passes of the same render; any order")
      ->required();
  command->add_option("-o,--output", o->output, "What to write: .state, .exr (all layers) or .png")->required();
  command->add_option("--exposure", o->display.exposure, "For .png: stops by which to brighten")->capture_default_str();
  command->add_flag("--filmic", o->filmic, "For .png: film-like tone curve instead of clipping");
  command->footer(
      "The result has the same pixels as one render of all the passes. States must be of one scene, integrator, seed "
      "and\n"
      "settings; methods whose passes depend on earlier ones (ppm, sppm) can be resumed but not merged.\n\n"
      "Example:\n"
      "  lanthorn render a.pbrt --pass-range 0:32  -o one.state\n"
      "  lanthorn render a.pbrt --pass-range 32:64 -o two.state\n"
      "  lanthorn merge one.state two.state -o a.exr");
  command->callback([o] { run(*o); });
}

}  // namespace lanthorn
