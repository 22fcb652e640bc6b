// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

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

struct MergeCommand {
  std::vector<std::string> inputs;
  std::string output;
  OutputSettings settings;
};

void run(const MergeCommand& o) {
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
  StatePicture picture(*merged, {o.output}, {}, o.settings.denoise);
  const StateSummary& summary = picture.summary();
  if (fs::path(o.output).extension() == ".state" && !o.settings.force)
    check_replaced_state(o.output, *merged, summary.passes, "merge it, too");
  write_output(o.output, picture, o.settings);
  announce("{}: {} passes of {} from {} files\n", o.output, summary.pass_count, summary.integrator, o.inputs.size());
  report_film(summary.report);
}

OptionTable merge_options(MergeCommand& a) {
  const OptionTable own{{.names = "STATES",
                         .value = each_into(a.inputs, text_type("FILE"), Arity::several),
                         .brief = "Saved states with disjoint passes of the same render; any order",
                         .required = true},
                        {.names = "-o,--output",
                         .value = into(a.output, text_type("FILE")),
                         .brief = "Output file: .state, .exr (all layers) or .png",
                         .required = true}};
  return joined(own, output_options(a.settings));
}

}  // namespace

void add_merge(CLI::App& app) {
  const auto a = std::make_shared<MergeCommand>();
  constexpr const char* footer =
      "The result has the same pixels as one render of all the passes. States must be of one scene, integrator, seed "
      "and\n"
      "settings; methods whose passes depend on earlier ones (ppm, sppm) can be resumed but not merged.\n\n"
      "Example:\n"
      "  lanthorn render a.pbrt --pass-range 0:32  -o one.state\n"
      "  lanthorn render a.pbrt --pass-range 32:64 -o two.state\n"
      "  lanthorn merge one.state two.state -o a.exr";
  add_command(app, {"merge", "Merge shards of one render (files of --pass-range), exactly", merge_options(*a), footer,
                    [a] { run(*a); }});
}

}  // namespace lanthorn::program
