// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/state.h"
#include "output.h"
#include "output_check.h"

namespace lanthorn::program {
namespace {

namespace fs = std::filesystem;

struct MergeOptions {
  std::vector<std::string> inputs;
  std::string output;
  OutputSettings settings;
};

void run(const MergeOptions& o) {
  std::vector<InputFile> read;
  for (const std::string& input : o.inputs) read.push_back({input, "one of the states to merge"});
  check_outputs(read, {{o.output, "-o", output_extensions}}, o.settings.force);
  std::shared_ptr<RenderState> merged = open_state(o.inputs.front());
  for (std::size_t i = 1; i < o.inputs.size(); ++i) {
    const std::shared_ptr<RenderState> next = open_state(o.inputs[i]);
    try {
      merged = merge(*merged, *next);
    } catch (const Error& e) {
      throw Error({o.inputs[i]}, e.message);
    }
  }
  const StateSummary summary = summarize(*merged);
  if (fs::path(o.output).extension() == ".state" && !o.settings.force)
    check_replaced_state(o.output, *merged, summary.passes, "merge it, too");
  write_output(o.output, *merged, o.settings);
  announce("{}: {} passes of {} from {} files\n", o.output, summary.pass_count, summary.integrator, o.inputs.size());
  report_film(summary.report);
}

}  // namespace

void add_merge(CLI::App& app) {
  auto o = std::make_shared<MergeOptions>();
  CLI::App* command = app.add_subcommand("merge", "Merge shards of one render (files of --pass-range), exactly");
  command->add_option("STATES", o->inputs, "Saved states with disjoint passes of the same render; any order")
      ->required()
      ->type_name("FILE");
  command->add_option("-o,--output", o->output, "Output file: .state, .exr (all layers) or .png")
      ->required()
      ->type_name("FILE");
  add_output_options(*command, o->settings);
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

}  // namespace lanthorn::program
